// What is wrong with a groom as a file has it, and what mends it: unit, axes, direction, widths, place on the head, and
// strands that no program can use.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/groom/groom.h"
#include "app/groom/groom_hints.h"

namespace app {

// A head to hold the groom against. Metres, y up, z forward.
struct HeadModel {
  std::function<float(const Eigen::Vector3f&)> distance;  // m from the body, negative inside
  Eigen::Vector3f center = Eigen::Vector3f::Zero();       // of the skull
  std::optional<Eigen::Vector3f> standing;                // the same where the figure stands in its world
};

enum class Reverse { kNone, kFound, kAll };

// Done in this order; lengths after `unit` are metres in y up, z forward.
struct GroomMends {
  bool drop_bad = false;                               // strands not finite, without length, of fewer than two points
  bool drop_astray = false;                            // strands that lie apart from all others
  double unit = 1;                                     // m that a unit of the file stands for
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  // file's to ours
  Reverse reverse = Reverse::kNone;                    // strands that run from tip to root
  float width_scale = 1;                               // of widths, beside the unit
  int points = 0;                                      // a strand, evenly along its length; 0: as they are
  float scale = 1;                                     // of points, not of widths
  Eigen::Vector3f move = Eigen::Vector3f::Zero();      // m
  float drop_far = 0;     // m from the body beyond which a root's strand goes; 0: none does
  float width = 0;        // m, in place of widths that are 0, negative or no number; 0: none
  bool push_out = false;  // points inside the body, to its surface
  bool operator==(const GroomMends&) const = default;
};

struct GroomFinding {
  std::string what;  // unit, up, facing, reversed, astray, widths, size, roots, points, body, zero-length, non-finite
  std::string text;  // what was found, with numbers
  std::string mend;  // the option that mends it
  bool certain = false;
  bool fault = true;  // else it is so by right, as hair that lies on the figure's head in the world
};

struct GroomInspection {
  std::string summary;  // strands, points, extent
  std::vector<GroomFinding> findings;
  GroomMends mends;      // of what is certain
  bool on_head = false;  // whether the roots lie on the head after these, in the median

  const GroomFinding* find(std::string_view what) const;
};

// Says what is wrong, in the order in which it is to be mended; nothing for a groom that fits the head, or, without
// one, a head of usual size. Of some 2,000 strands where there are more.
GroomInspection inspectGroom(const Groom& groom, const GroomHints& hints, const HeadModel* head);

// `head` is needed to push out. Arrays stay whole.
void mendGroom(const GroomMends& mends, const HeadModel* head, Groom& groom);

// The matrix that turns a file with this axis up ("y", "z", "-y", "-z", "x", "-x") into y up, z forward; nothing for
// another name. With z up, hair faces -y, as in Blender.
std::optional<Eigen::Matrix3f> axesOfUp(std::string_view up);
// The same by the axis that the file tells; y where it tells none.
Eigen::Matrix3f toldAxes(const GroomHints& hints);
// Turns about y, degrees.
Eigen::Matrix3f turnedAbout(double degrees);

}  // namespace app
