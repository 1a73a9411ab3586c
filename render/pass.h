// A pass of a frame, and a list of passes. The list of all passes is passes.h.
//
// A pass is a plain class; without one of these parts it does not compile:
//   kName        its name in the Timings panel and in reports
//   Input        all that its picture depends on besides the stage, as values that compare
//   inputOf      takes the Input out of the frame
//   constructor  compiles its shaders, from a folder
//   draw         sees its Input and the stage, never the frame: what it does not declare it cannot use
//   reload       compiles its shaders anew
#pragma once

#include <array>
#include <concepts>
#include <string>
#include <tuple>

#include "render/frame_input.h"
#include "render/gpu_timer.h"
#include "render/reload.h"
#include "render/renderer.h"
#include "render/shader.h"

namespace render {

struct Stage;

template <class P>
concept Pass = std::constructible_from<P, const std::string&> && std::equality_comparable<typename P::Input> &&
    requires(P pass, const FrameInput& frame, const typename P::Input& input, Stage& stage, FrameReport& report) {
  { P::kName } -> std::convertible_to<const char*>;
  { P::inputOf(frame) } -> std::same_as<typename P::Input>;
  pass.draw(input, stage, report);
  { pass.reload(Reload::kAll) } -> std::same_as<ReloadReport>;
};

template <Pass... P>
class PassList {
 public:
  explicit PassList(const std::string& shader_dir) : entries_{Entry<P>{P(shader_dir), {}}...} {}

  static constexpr std::array<const char*, sizeof...(P)> kNames{P::kName...};

  // Takes each pass's Input out of the frame. Returns whether any differs from the last frame's.
  bool update(const FrameInput& frame) {
    bool changed = false;
    each([&]<class Q>(Entry<Q>& entry) {
      typename Q::Input input = Q::inputOf(frame);
      changed = changed || !(input == entry.input);
      entry.input = input;
    });
    return changed;
  }

  // Draws all passes, each after a call of `begin`, and marks their times.
  template <class Begin>
  void draw(Begin&& begin, Stage& stage, GpuTimer& timer, FrameReport& report) {
    each([&]<class Q>(Entry<Q>& entry) {
      begin();
      entry.pass.draw(entry.input, stage, report);
      timer.mark(Q::kName);
    });
  }

  ReloadReport reload(Reload which) {
    ReloadReport report;
    each([&](auto& entry) { report += entry.pass.reload(which); });
    return report;
  }

 private:
  template <class Q>
  struct Entry {
    Q pass;
    typename Q::Input input;
  };

  template <class Do>
  void each(Do&& act) {
    std::apply([&](auto&... entry) { (act(entry), ...); }, entries_);
  }

  std::tuple<Entry<P>...> entries_;
};

}  // namespace render
