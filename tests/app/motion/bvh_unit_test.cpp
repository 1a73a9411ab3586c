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

// A standing figure of `height` metres from toes to crown.
std::string standing(double height, double units_per_metre) {
  const auto offset = [&](double y) { return "OFFSET 0 " + std::to_string(y * height * units_per_metre) + " 0\n"; };
  const std::string turns = "CHANNELS 3 Zrotation Xrotation Yrotation\n";
  const std::string row = "0 " + std::to_string(0.55 * height * units_per_metre) + " 0 0 0 0 0 0 0 0 0 0\n";
  return "HIERARCHY\nROOT Hips {\n" + offset(0.55) +
         "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\nJOINT Head {\n" + offset(0.3) +
         turns + "End Site {\n" + offset(0.15) + "}\n}\nJOINT Foot {\n" + offset(-0.55) + turns +
         "End Site {\nOFFSET 0 0 " + std::to_string(0.1 * height * units_per_metre) +
         "\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.02\n" + row + row;
}

// A child keeps its size where its unit is certain; what is as tall as a grown person in another unit is one.
TEST(Bvh, AChildKeepsItsSize) {
  const auto heightOf = [](const BvhMotion& motion) {
    return motion.skeleton.joints[1].rest_world.translation().y() -
           motion.skeleton.joints[2].rest_world.translation().y();
  };
  for (const auto& [units, name] : {std::pair(100.0, "cm"), {1.0, "m"}, {1000.0, "mm"}}) {
    for (const double height : {1.09, 1.0, units == 100 ? 0.96 : 0.8}) {
      const BvhMotion child = app::readBvh(standing(height, units), "child");
      EXPECT_NEAR(heightOf(child), 0.85 * height, 0.001) << name << " " << child.notes.at(0);
      EXPECT_NE(child.notes.at(0).find(std::string("unit: ") + name + " ("), std::string::npos) << child.notes[0];
      EXPECT_NE(child.notes.at(0).find("; a child's size"), std::string::npos) << child.notes[0];
    }
  }
  EXPECT_NE(app::readBvh(standing(1.7, 39.37), "grown").notes.at(0).find("unit: inch ("), std::string::npos);
  EXPECT_NE(app::readBvh(standing(0.6, 1), "doll").notes.at(0).find("unknown, scaled to 1.70 m"), std::string::npos);
}

}  // namespace bvh_unit_test
