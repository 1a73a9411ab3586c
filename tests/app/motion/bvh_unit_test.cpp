// The unit of a BVH figure that is not whole.
#include <gtest/gtest.h>

#include <string>

#include "app/motion/motion.h"

namespace bvh_unit_test {

using app::BvhMotion;

// Without legs a chain of 80 units is a body from the hips up in centimetres, no person in inches; one of 170 units
// stands on the ground.
TEST(Bvh, AFigureWithoutLegsIsMeasuredFromTheHipsUp) {
  const auto chain = [](double scale) {
    const auto offset = [&](double y) { return "OFFSET 0 " + std::to_string(y * scale) + " 0\n"; };
    const std::string turns = "CHANNELS 3 Zrotation Xrotation Yrotation\n";
    return "HIERARCHY\nROOT hips {\n" + offset(95) +
           "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\nJOINT spine {\n" + offset(25) +
           turns + "JOINT neck {\n" + offset(25) + turns + "JOINT head {\n" + offset(10) + turns + "End Site {\n" +
           offset(20) + "}\n}\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.02\n" +
           "0 95 0 0 0 0 0 0 0 0 0 0 0 0 0\n0 95 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
  };
  const BvhMotion torso = app::readBvh(chain(1), "clip"), whole = app::readBvh(chain(170.0 / 80), "clip");
  EXPECT_NE(torso.notes.at(0).find("unit: cm (figure 80 units"), std::string::npos) << torso.notes[0];
  EXPECT_NE(torso.notes.at(0).find("not certain: without legs"), std::string::npos) << torso.notes[0];
  EXPECT_NEAR(torso.skeleton.joints.back().rest_world.translation().y(), 0.95 + 0.6, 0.01);
  EXPECT_NE(whole.notes.at(0).find("unit: cm (figure 170 units"), std::string::npos) << whole.notes[0];
  EXPECT_EQ(whole.notes.at(0).find("not certain"), std::string::npos);
}

}  // namespace bvh_unit_test
