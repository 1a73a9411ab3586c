// What the renderer knows of a pass: its entry, made by makePass of any class that pass.h calls a pass.
#pragma once

#include <memory>
#include <string>

#include "render/reload.h"

namespace render {

struct FrameInput;
struct FrameReport;
struct Stage;

// What a pass draws into.
enum class Target {
  kRadiance,  // the picture before exposure; kept while nothing changes that one of its passes depends on
  kScreen,    // what is shown, in every frame
};

struct PassEntry {
  const char* name;
  Target target;
  std::unique_ptr<void, void (*)(void*)> pass;
  // Takes what the pass depends on out of the frame. Returns whether it differs from the last frame's.
  bool (*update)(void* pass, const FrameInput& frame);
  void (*draw)(void* pass, Stage& stage, FrameReport& report);
  ReloadReport (*reload)(void* pass, Reload which);
};

// Compiles the pass's shaders, from a folder. A pass's file ends with `template PassEntry makePass<P>(...)`.
template <class P>
PassEntry makePass(const std::string& shader_dir);
using PassMaker = PassEntry (*)(const std::string& shader_dir);

}  // namespace render
