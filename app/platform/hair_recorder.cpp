#include "app/platform/hair_recorder.h"

#include <cmath>
#include <limits>

#include "app/platform/capture.h"

namespace app {

namespace {

// Changes where the strands are others than before.
std::string strandsOf(const Demo& demo) {
  std::string text;
  for (const Actor& actor : demo.actors) {
    for (const auto number :
         {static_cast<long long>(actor.id), static_cast<long long>(actor.haircut->id),
          static_cast<long long>(actor.spec.look.strands), static_cast<long long>(actor.spec.look.segments_per_layer)})
      text += std::to_string(number) + " ";
  }
  return text;
}

}  // namespace

// As headless runs number theirs: the number over fps is what was simulated before the frame, s.
int HairRecorder::numberOf(const Demo& demo) const {
  const bool comes = demo.stats.steps == 0;  // it stands still: what is recorded is the next one
  return static_cast<int>(std::lround(demo.shown_time * fps_)) + comes;
}

void HairRecorder::begin(Demo& demo) {
  const std::string asked = demo.capture.hair_file;
  const std::string file = asked.empty()     ? freeName("hair", ".hairmesh")
                           : asked[0] == '.' ? freeName("hair", asked)
                                             : asked;
  frames_ = 0;
  first_ = numberOf(demo);
  strands_ = strandsOf(demo);
  if (file.ends_with(".hairmesh")) {
    cache_.emplace(file, demo);
  } else {
    ExportSpec spec;
    spec.file = file;
    if (file.ends_with(".glb")) spec.what = ExportWhat::kMesh;
    export_.emplace(spec, demo, fps_, first_, std::numeric_limits<int>::max());
  }
  demo.message = "recording the hair into " + file;
  demo.message_is_fault = false;
}

void HairRecorder::finish(Demo& demo) {
  std::string text;
  if (frames_ == 0) {
    text = "no hair was recorded: it stood still";
    cache_.reset();
    export_.reset();
  } else if (cache_) {
    text = cache_->finish(demo);
    const std::string file = cache_->file();
    cache_.reset();
    if (strandsOf(demo) == strands_) openCache(file, demo);
  } else {
    text = export_->finish(demo);
    export_.reset();
  }
  demo.message = text.substr(0, text.find('\n'));
  demo.message_is_fault = false;
}

void HairRecorder::frame(Demo& demo) {
  try {
    if (demo.capture.hair && !on()) begin(demo);
    const bool others = on() && strandsOf(demo) != strands_;
    if (others) demo.capture.hair = false;
    if (!demo.capture.hair && on()) {
      finish(demo);
      if (others) demo.message += "; it ends where the strands become others";
      return;
    }
    if (!on() || demo.stats.steps == 0) return;
    if (cache_) cache_->add(demo);
    if (export_) export_->add(demo, first_ + frames_);
    ++frames_;
  } catch (const std::exception& fault) {
    demo.message = fault.what();
    demo.message_is_fault = true;
    demo.capture.hair = false;
    export_.reset();
    cache_.reset();
  }
}

void HairRecorder::close(Demo& demo) {
  demo.capture.hair = false;
  if (on() && frames_ > 0) finish(demo);
}

}  // namespace app
