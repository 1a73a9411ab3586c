// A groom: strands as polylines, as the curve formats of other programs have them and as this program exports its own.
//
// Read by app/groom's readers, grown by render/strands, fitted to a hair mesh by app/groom's conversion.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace app {

// Strand s has points strand_first[s] to strand_first[s + 1] - 1. As exported, and after the inspector's mends: metres,
// y up, z forward, x to the character's left, root first. As read, whatever the file says: see each reader.
// Optional arrays are empty or whole.
struct Groom {
  std::vector<std::uint32_t> strand_first{0};  // strands + 1 entries, never falling
  std::vector<Eigen::Vector3f> points;
  std::vector<float> widths;              // diameter, in the points' unit, one per point
  std::vector<Eigen::Vector3f> colors;    // linear RGB, one per point
  std::vector<Eigen::Vector2f> root_uvs;  // one per strand
  std::vector<std::int32_t> ids;          // one per strand
  std::vector<std::int32_t> groups;       // one per strand: Unreal's group, a file's object or card
  std::vector<std::uint8_t> guides;       // one per strand: 1 for a guide that stands for many

  std::size_t strandCount() const { return strand_first.size() - 1; }
  std::size_t pointCount(std::size_t strand) const { return strand_first[strand + 1] - strand_first[strand]; }
  std::span<const Eigen::Vector3f> strand(std::size_t s) const {
    return std::span(points).subspan(strand_first[s], pointCount(s));
  }
};

}  // namespace app
