// How long the window waits before its next frame while nothing in it moves.
#pragma once

namespace app {

enum class Wait {
  kNone,   // the next frame follows at once
  kShort,  // kShortWait, then a frame all the same
  kEvent   // no frame until somebody does something
};
inline constexpr double kShortWait = 0.1;  // s: within what the clock catches up with

// Panels take a few frames to settle after each event (a hovered button, a folded section), and for about a second some
// tell more by themselves (a tip that opens late). So frames become rare first and end only then.
class RedrawThrottle {
 public:
  // `still`: the next frame would show what the last one showed. `alive`: the panels change by themselves (a caret that
  // blinks, a message that is to go).
  Wait next(bool still, bool alive) {
    constexpr int kSettlingFrames = 12, kRareFrames = 10;
    still_frames_ = still ? still_frames_ + 1 : 0;
    wait_ = still_frames_ <= kSettlingFrames ? Wait::kNone : Wait::kShort;
    if (still_frames_ > kSettlingFrames + kRareFrames && !alive) wait_ = Wait::kEvent;
    return wait_;
  }
  // Somebody did something while it waited.
  void disturb() { still_frames_ = 0; }
  // Whether it did before the present frame.
  bool waited() const { return wait_ != Wait::kNone; }

 private:
  int still_frames_ = 0;
  Wait wait_ = Wait::kNone;
};

}  // namespace app
