// A BVH file as it is written: the hierarchy and the motion rows, in the file's own units, axes and channel order.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace app {

enum class BvhChannel : std::uint8_t { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };
inline bool isPosition(BvhChannel channel) {
  return channel <= BvhChannel::z_position;
}
inline int axisOf(BvhChannel channel) {
  return static_cast<int>(channel) % 3;
}

struct BvhTextJoint {
  std::string name;
  int parent = -1;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // file's unit, parent frame
  Eigen::Vector3d end_site =
      Eigen::Vector3d::Zero();  // file's unit, joint frame; the first one where a joint has several
  bool has_end_site = false;
  std::vector<BvhChannel> channels;  // as listed; rotations apply left to right: R = R_first R_second R_third
  int first_channel = 0;             // column of the first one in a motion row
};

struct BvhText {
  std::vector<BvhTextJoint> joints;  // parents before children
  int hierarchy_line = 1;            // where faults of the whole skeleton are reported
  int channel_count = 0;
  int frame_count = 0;
  double frame_time = 0;         // s
  bool has_surplus_row = false;  // one row more than declared was left out
  std::vector<double> values;    // frames x channels: file's unit, degrees
};

// Reads the text; memory stays below a small multiple of its length. Throws InputError naming the line.
BvhText readBvhText(std::string_view text, const std::string& file);

}  // namespace app
