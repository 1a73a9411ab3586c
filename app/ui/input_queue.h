// Keys, characters and mouse buttons on their way to Dear ImGui, whose version 1.86 sees only what is held down when a
// frame begins: a key tapped between two frames would be lost. What comes too fast for one frame waits for the next.
#pragma once

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

namespace app {

struct InputEvent {
  int key = 0;             // of GLFW; 0: a character; below: mouseKey(button)
  unsigned character = 0;  // code point
  int scancode = 0, action = 0, modifiers = 0;
  double x = 0, y = 0;  // px, where the pointer was as a mouse button changed
};

inline constexpr int kHeld = 2;  // action of a mouse button that stays down, at another place

// The key that stands for a mouse button, 0 to 4, and back.
constexpr int mouseKey(int button) {
  return -1 - button;
}

class InputQueue {
 public:
  void add(const InputEvent& event) { events_.push_back(event); }
  bool empty() const { return events_.empty(); }

  // Hands the next frame's events to `give`, in order: each key changes at most once, and one mouse button in all, for
  // the pointer is at one place in a frame. A button that is let go elsewhere than it was pressed is first held there
  // for a frame (kHeld), so that a quick drag is one. A key other than the one that a character comes from does not
  // share a frame with characters after it, so that typing and editing keep their order. What comes after a shortcut
  // (Ctrl and a key) waits for the frame after the next: by then what it opens takes what is typed.
  template <class Give>
  void feed(Give&& give) {
    std::vector<int> changed;
    bool edited = false, clicked = false;
    if (waiting_) {
      waiting_ = false;
      return;
    }
    while (!events_.empty()) {
      const InputEvent event = events_.front();
      const bool again = event.key != 0 && std::find(changed.begin(), changed.end(), event.key) != changed.end();
      if (again || (event.key == 0 && edited) || (event.key < 0 && clicked)) return;
      if (event.key < 0 && event.action == 0 && (event.x != x_ || event.y != y_)) {
        x_ = event.x, y_ = event.y;
        return give(InputEvent{event.key, 0, 0, kHeld, 0, event.x, event.y});
      }
      events_.pop_front();
      if (event.key < 0) x_ = event.x, y_ = event.y;
      if (event.key != 0) changed.push_back(event.key);
      clicked = clicked || event.key < 0;
      edited = edited || (event.key >= kFirstEditing && event.key <= kLastEditing && event.action != 0);
      give(event);
      waiting_ = event.key > 0 && event.key < kFirstModifier && event.action == 1 && (event.modifiers & kControlHeld);
      if (waiting_) return;
    }
  }

 private:
  static constexpr int kFirstEditing = 256, kLastEditing = 319;  // Escape, Enter, arrows: keys that make no character
  static constexpr int kFirstModifier = 340, kControlHeld = 2;   // Shift, Ctrl, Alt as keys; a bit of `modifiers`
  std::deque<InputEvent> events_;
  bool waiting_ = false;  // a shortcut came in the frame before
  double x_ = 0, y_ = 0;  // px, of the last button
};

}  // namespace app
