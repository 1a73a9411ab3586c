// The middle of a plait is the mean of the tail's columns at equal shares of their length. Along it goes a frame that
// turns no more than it must (Wang et al. 2008, Computation of Rotation Minimizing Frames, by double reflection). It
// begins with the head's own turn, which the roots and the ring tell. A bun turns with the head.
#include "app/scene/braid/braid_draw.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "app/motion/least_rotation.h"
#include "render/strands/layer_curve.h"

namespace app {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kNoLength = 1e-9;  // m

struct Frame {
  Vector3d at, along, across, outward;
};

Vector3f vertexAt(std::span<const float> positions, int vertex) {
  return Eigen::Map<const Vector3f>(&positions[3 * static_cast<std::size_t>(vertex)]);
}

std::vector<Vector3d> middleOf(const Braid& braid, std::span<const float> positions) {
  std::vector<Vector3d> middle(braid.steps.size(), Vector3d::Zero());
  std::size_t columns = 0;
  for (const BraidLayers& equal : braid.tail) {
    std::vector<Vector3d> sum(static_cast<std::size_t>(equal.layers), Vector3d::Zero());
    for (const int first : equal.first_vertex)
      for (int l = 0; l < equal.layers; ++l)
        sum[static_cast<std::size_t>(l)] += vertexAt(positions, first + l).cast<double>();
    columns += equal.first_vertex.size();
    const auto layer = [&](int l) { return sum[static_cast<std::size_t>(l)]; };
    for (std::size_t k = 0; k < middle.size(); ++k) {
      const double place = braid.ring_layer + braid.steps[k].share * double(equal.layers - 1 - braid.ring_layer);
      middle[k] += render::onLayers<Vector3d>(layer, equal.layers, place);
    }
  }
  for (Vector3d& p : middle) p /= static_cast<double>(columns);
  return middle;
}

// Direction from a to b; `otherwise` where they are one point.
Vector3d way(const Vector3d& a, const Vector3d& b, const Vector3d& otherwise) {
  const double length = (b - a).norm();
  return length > kNoLength ? Vector3d((b - a) / length) : otherwise;
}

Vector3d reflected(const Vector3d& v, const Vector3d& normal) {
  const double squared = normal.squaredNorm();
  return squared > kNoLength * kNoLength ? Vector3d(v - 2 / squared * normal.dot(v) * normal) : v;
}

std::vector<Frame> framesOf(const Braid& braid, std::span<const float> positions) {
  std::vector<Vector3d> middle = middleOf(braid, positions);
  Matrix3d turn = Matrix3d::Zero();
  Vector3d held = Vector3d::Zero();
  for (const BraidAnchor& anchor : braid.anchors) {
    const Vector3d at = vertexAt(positions, anchor.vertex).cast<double>();
    turn += at * anchor.weight.transpose();
    held += at / static_cast<double>(braid.anchors.size());
  }
  for (std::size_t k = 1; k < braid.coil.size(); ++k) middle[k] = held + turn * (braid.coil[k].at - braid.held);
  const Vector3d axis = way(Vector3d::Zero(), turn * braid.axis, braid.axis);
  Vector3d across = turn * braid.across;
  across = way(Vector3d::Zero(), across - axis * axis.dot(across), axis.unitOrthogonal());
  std::vector<Frame> frames(middle.size());
  Vector3d along = axis;
  for (std::size_t k = 0; k < middle.size(); ++k) {
    const Vector3d next = way(middle[k > 0 ? k - 1 : 0], middle[std::min(k + 1, middle.size() - 1)], along);
    if (k == 0) {
      across = leastRotation(axis, next) * across;
    } else {
      const Vector3d step = middle[k] - middle[k - 1];
      across = reflected(reflected(across, step), next - reflected(along, step));
    }
    if (k < braid.coil.size()) across = (turn * braid.coil[k].out).cross(next);
    across = way(Vector3d::Zero(), across - next * next.dot(across), next.unitOrthogonal());
    along = next;
    frames[k] = {middle[k], along, across, along.cross(across)};
  }
  if (braid.mirrored)
    for (Frame& frame : frames) frame.across = -frame.across;
  return frames;
}

// In a frame's plane, from the plait's middle.
Vector2f inSection(const BraidStep& step, const DrawnColumn& column) {
  const Vector2f& p = column.place;
  const Vector2f turned(step.twist.x() * p.x() - step.twist.y() * p.y(),
                        step.twist.y() * p.x() + step.twist.x() * p.y());
  return step.middle[static_cast<std::size_t>(column.strand)] + step.half.cwiseProduct(turned);
}

}  // namespace

void drawBraids(const BraidPlan& plan, std::span<const float> positions, std::vector<float>& drawn) {
  std::vector<std::vector<Frame>> frames;
  for (const Braid& braid : plan.braids) frames.push_back(framesOf(braid, positions));
  drawn.clear();
  for (const DrawnColumn& column : plan.columns) {
    const auto point = [&](int l) { return vertexAt(positions, column.first_vertex + l); };
    const auto add = [&](const Vector3f& p) { drawn.insert(drawn.end(), p.data(), p.data() + 3); };
    const Braid* braid = column.braid < 0 ? nullptr : &plan.braids[static_cast<std::size_t>(column.braid)];
    const int plain = braid ? braid->ring_layer : column.layers - 1;
    for (int l = 0; l <= plain * plan.finer; ++l) {
      const int whole = l / plan.finer;
      add(l % plan.finer == 0 ? point(whole) : render::onLayers<Vector3f>(point, column.layers, float(l) / plan.finer));
    }
    if (!braid) continue;
    for (std::size_t k = 1; k < braid->steps.size(); ++k) {
      const BraidStep& step = braid->steps[k];
      const Frame& frame = frames[static_cast<std::size_t>(column.braid)][k];
      const Vector2f off = inSection(step, column);
      Vector3f p = (frame.at + off.x() * frame.across + off.y() * frame.outward).cast<float>();
      if (step.hold < 1) {
        const double place = plain + step.share * double(column.layers - 1 - plain);
        const Vector3f own = render::onLayers<Vector3f>(point, column.layers, static_cast<float>(place));
        p = own + step.hold * (p - own);
      }
      add(p);
    }
  }
}

std::vector<render::Mat4> braidBands(const BraidPlan& plan, std::span<const float> positions) {
  std::vector<render::Mat4> bands;
  for (const Braid& braid : plan.braids) {
    if (!braid.coil.empty()) continue;
    const Frame frame = framesOf(braid, positions)[static_cast<std::size_t>(braid.band_step)];
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.block<3, 1>(0, 0) = braid.band_radius * frame.across;
    matrix.block<3, 1>(0, 1) = braid.band_radius * frame.along.cross(frame.across);
    matrix.block<3, 1>(0, 2) = braid.band_radius * frame.along;
    matrix.block<3, 1>(0, 3) = frame.at;
    Eigen::Map<Eigen::Matrix4f>(bands.emplace_back().data()) = matrix.cast<float>();
  }
  return bands;
}

}  // namespace app
