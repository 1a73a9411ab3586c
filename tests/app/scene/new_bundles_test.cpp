// Bundles grown over bare scalp at the border of the hair.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/app/scene/mesh_in_hand.h"

namespace new_bundles_test {

using test::ask;
using test::Ask;
using test::Demo;
using test::demoOf;
using test::expectValid;
using test::meshOf;

// Columns of the border of bare scalp, in order, as far as `count` edges that can be grown over; empty: there are none.
std::vector<int> borderOf(std::size_t count, Demo& demo) {
  const sim::HairMeshShape shape = meshOf(demo).shape;
  std::map<std::pair<int, int>, int> faces;
  for (const sim::RootFace& face : shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) {
      const int a = face.columns[static_cast<std::size_t>(k)],
                b = face.columns[static_cast<std::size_t>((k + 1) % face.corner_count)];
      ++faces[{a, b}], --faces[{b, a}];
    }
  }
  std::map<int, int> next;
  for (const auto& [edge, balance] : faces) {
    if (balance > 0) next[edge.first] = edge.second;
  }
  for (const auto& [start, ignored] : next) {
    std::vector<int> chain{start};
    std::string text;
    for (std::size_t k = 0; k < count && next.contains(chain.back()); ++k) {
      text += std::to_string(chain.back()) + " " + std::to_string(next[chain.back()]) + " ";
      chain.push_back(next[chain.back()]);
    }
    text.pop_back();
    if (chain.size() == count + 1 && ask({Ask::kMesh, "extrude", text}, demo).empty()) return chain;
  }
  return {};
}

// Neither a square on the temple nor a step in the hairline: a chain of edges runs out to a point at both ends.
TEST(NewBundles, EndInPoints) {
  for (const std::size_t count : {1, 2, 3}) {
    Demo demo = demoOf(app::Style::kShort);
    const int columns = meshOf(demo).columnCount();
    const std::size_t faces = meshOf(demo).shape.root_faces.size();
    ASSERT_FALSE(borderOf(count, demo).empty()) << count;
    expectValid(demo);
    EXPECT_EQ(meshOf(demo).columnCount(), columns + std::max(1, static_cast<int>(count) - 1)) << count;
    const std::vector<sim::RootFace>& now = meshOf(demo).shape.root_faces;
    ASSERT_EQ(now.size(), faces + count);
    for (std::size_t f = faces; f < now.size(); ++f)
      EXPECT_EQ(now[f].corner_count, f == faces || f + 1 == now.size() ? 3 : 4) << count;
  }
}

}  // namespace new_bundles_test
