// A pass of a frame: one file NAME_pass.cpp, and one entry in the list of passes.h.
//
// A pass is a plain class; without one of these parts it does not compile:
//   kName        its name in the Timings panel and in reports
//   kTarget      what it draws into
//   Input        all that its picture depends on besides the stage (stage.h), as values that compare
//   inputOf      takes the Input out of the frame
//   constructor  compiles its shaders, from a folder
//   draw         sees its Input and the stage, never the frame: what it does not declare it cannot use
//   reload       compiles its shaders anew
// Its file ends with `template PassEntry makePass<P>(const std::string& shader_dir);`. Without it it does not link.
#pragma once

#include <concepts>
#include <string>

#include "render/frame_input.h"
#include "render/frame_report.h"
#include "render/gl/shader.h"
#include "render/pass_entry.h"

namespace render {

template <class P>
concept Pass = std::constructible_from<P, const std::string&> && std::equality_comparable<typename P::Input> &&
    requires(P pass, const FrameInput& frame, const typename P::Input& input, Stage& stage, FrameReport& report) {
  { P::kName } -> std::convertible_to<const char*>;
  { P::kTarget } -> std::convertible_to<Target>;
  { P::inputOf(frame) } -> std::same_as<typename P::Input>;
  pass.draw(input, stage, report);
  { pass.reload(Reload::kAll) } -> std::same_as<ReloadReport>;
};

template <class P>
PassEntry makePass(const std::string& shader_dir) {
  static_assert(Pass<P>, "a part is missing");
  struct Kept {
    P pass;
    typename P::Input input;
  };
  PassEntry entry{P::kName, P::kTarget, {new Kept{P(shader_dir), {}}, [](void* of) { delete static_cast<Kept*>(of); }},
                  nullptr,  nullptr,    nullptr};
  entry.update = [](void* of, const FrameInput& frame) {
    typename P::Input& kept = static_cast<Kept*>(of)->input;
    typename P::Input input = P::inputOf(frame);
    const bool changed = !(input == kept);
    kept = input;
    return changed;
  };
  entry.draw = [](void* of, Stage& stage, FrameReport& report) {
    Kept& kept = *static_cast<Kept*>(of);
    kept.pass.draw(kept.input, stage, report);
  };
  entry.reload = [](void* of, Reload which) { return static_cast<Kept*>(of)->pass.reload(which); };
  return entry;
}

}  // namespace render
