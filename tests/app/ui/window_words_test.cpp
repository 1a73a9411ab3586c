// What the window shows of messages that are also the command line's.
#include "app/ui/window_words.h"

#include <gtest/gtest.h>

namespace window_words_test {

TEST(WindowWords, NameNoOptionOfTheCommandLine) {
  const auto shown = [](const char* said, const char* expected) { EXPECT_EQ(app::windowWords(said), expected); };
  shown("hair with beanie", "hair with beanie");
  shown("bob.obj: all faces are wound the other way; reverse the faces, or give --reverse-faces",
        "bob.obj: all faces are wound the other way; reverse the faces");
  shown("its roots are 2 m from the scalp; it is read so: now they are 3 mm off (--fit off leaves it as it is)",
        "its roots are 2 m from the scalp; it is read so: now they are 3 mm off");
  shown("walk.bvh: is a motion, no hair; give it to --motion", "walk.bvh: is a motion, no hair");
  shown("it looks like inches: --fit on reads it so", "it looks like inches");
  shown("a.abc: mended: up (--up z), unit (--unit cm); read\nb: fine (as it is)",
        "a.abc: mended: up, unit; read\nb: fine (as it is)");
  shown("--start 9 lies beyond the clip's end; it begins anew", "--start 9 lies beyond the clip's end; it begins anew");
  shown("hat.obj: encloses 3 roots; make it larger, or move it in its file (or by \"at\": [0, 0.03, 0], m, y up)",
        "hat.obj: encloses 3 roots; make it larger, or move it in its file");
  shown("lies inside the head; make it 1.2 times as large (\"size\") or move it (\"at\")",
        "lies inside the head; make it 1.2 times as large or move it");
  shown("s.json: is bad (see \"hair\")", "s.json: is bad (see \"hair\")");
  shown("a--b.obj: is open; close it", "a--b.obj: is open; close it");
}

}  // namespace window_words_test
