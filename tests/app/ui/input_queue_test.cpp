// Keys, characters and buttons reach the panels in order, however few frames there are.
#include "app/ui/input_queue.h"

#include <gtest/gtest.h>

#include <vector>

namespace input_queue_test {

// What a person types between two frames, one after another as it comes.
TEST(InputQueue, ATapBetweenTwoFramesIsSeenAndTypingKeepsItsOrder) {
  app::InputQueue queue;
  constexpr int kBackspace = 259;
  for (const int action : {1, 0, 1, 0}) queue.add({kBackspace, 0, 0, action});
  queue.add({0, 'a'});
  queue.add({0, 'b'});
  std::vector<std::vector<app::InputEvent>> frames;
  while (!queue.empty()) {
    frames.emplace_back();
    queue.feed([&](const app::InputEvent& event) { frames.back().push_back(event); });
  }
  ASSERT_EQ(frames.size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(frames[static_cast<std::size_t>(k)][0].action, 1 - k % 2) << k;
  ASSERT_EQ(frames[3].size(), 3u);
  EXPECT_EQ(frames[3][1].character, unsigned('a'));
  EXPECT_EQ(frames[3][2].character, unsigned('b'));
}

// Pressed, moved and let go within one frame: whoever takes the drag sees where it began and where it led to.
TEST(InputQueue, AButtonLetGoElsewhereIsHeldThereFirst) {
  app::InputQueue queue;
  queue.add({app::mouseKey(0), 0, 0, 1, 0, 640, 400});
  queue.add({app::mouseKey(0), 0, 0, 0, 0, 400, 410});
  std::vector<app::InputEvent> frames;
  while (!queue.empty()) {
    const std::size_t before = frames.size();
    queue.feed([&](const app::InputEvent& event) { frames.push_back(event); });
    ASSERT_EQ(frames.size(), before + 1);
  }
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0].x, 640);
  EXPECT_EQ(frames[1].action, app::kHeld);
  EXPECT_EQ(frames[1].x, 400);
  EXPECT_EQ(frames[2].action, 0);
  EXPECT_EQ(frames[2].x, 400);
}

TEST(InputQueue, AClickBetweenTwoFramesIsSeenWhereItWas) {
  app::InputQueue queue;
  queue.add({app::mouseKey(0), 0, 0, 1, 0, 10, 20});
  queue.add({app::mouseKey(0), 0, 0, 0, 0, 10, 20});
  queue.add({app::mouseKey(1), 0, 0, 1, 0, 11, 21});
  std::vector<std::vector<app::InputEvent>> frames;
  while (!queue.empty()) {
    frames.emplace_back();
    queue.feed([&](const app::InputEvent& event) { frames.back().push_back(event); });
  }
  ASSERT_EQ(frames.size(), 3u) << "one place of the pointer a frame";
  EXPECT_EQ(frames[0][0].action, 1);
  EXPECT_EQ(frames[0][0].x, 10);
  EXPECT_EQ(frames[1][0].action, 0);
  EXPECT_EQ(frames[1][0].y, 20);
  EXPECT_EQ(app::mouseKey(frames[2][0].key), 1);
  EXPECT_EQ(frames[2][0].y, 21);
}

TEST(InputQueue, ShiftGoesWithTheCharacterThatItMakes) {
  app::InputQueue queue;
  constexpr int kLeftShift = 340;
  queue.add({kLeftShift, 0, 0, 1});
  queue.add({'A', 0, 0, 1});
  queue.add({0, 'A'});
  int given = 0;
  queue.feed([&](const app::InputEvent&) { ++given; });
  EXPECT_EQ(given, 3);
}

// What Ctrl and a key open takes what is typed after it, from its second frame on.
TEST(InputQueue, WhatIsTypedAfterAShortcutWaitsForWhatItOpens) {
  app::InputQueue queue;
  constexpr int kLeftControl = 341, kHeldControl = 2;
  queue.add({kLeftControl, 0, 0, 1, kHeldControl});
  queue.add({'O', 0, 0, 1, kHeldControl});
  queue.add({'O', 0, 0, 0, kHeldControl});
  queue.add({'/', 0, 0, 1});
  queue.add({0, '/'});
  std::vector<std::size_t> given;
  for (int frame = 0; frame < 3; ++frame) {
    given.push_back(0);
    queue.feed([&](const app::InputEvent&) { ++given.back(); });
  }
  EXPECT_EQ(given, (std::vector<std::size_t>{2, 0, 3}));
}

}  // namespace input_queue_test
