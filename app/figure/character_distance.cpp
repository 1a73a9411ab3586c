// Signed distance to the rest-pose body, sampled on a grid around head and trunk.
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "app/figure/character.h"
#include "app/figure/kept.h"
#include "app/figure/signed_grid.h"

namespace app {

namespace {

SignedGrid layOut(double head_height) {
  const double scale = std::clamp(head_height / 0.23, 0.3, 4.0);
  return layOutGrid(scale * Vec3(-0.364, -0.72, -0.32), scale * Vec3(0.364, 0.30, 0.32), 0.007 * scale);
}

SignedGrid restGrid(const Character& character) {
  const Rigid to_scalp = (character.skeleton.joints[character.head_joint].rest_world * character.head_frame).inverse();
  SignedGrid grid = layOut(character.scalp.head_height);
  const Vec3 high = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  const double band = 2.0 * grid.h;

  std::vector<Vec3> points;
  for (const auto& p : character.mesh.positions) points.push_back(to_scalp * p.cast<double>());
  std::vector<Triangle> near;  // those that touch the grid's box or its shadows along the axes
  const auto& index = character.mesh.triangles;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
    const Triangle corners{points[index[t]], points[index[t + 1]], points[index[t + 2]]};
    const Vec3 least = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 most = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    int outside = 0;
    for (int a = 0; a < 3; ++a) outside += most[a] < grid.low[a] - band || least[a] > high[a] + band;
    if (outside < 2) near.push_back(corners);
  }
  fillGrid(near, band, Pieces::kAll, grid);
  return grid;
}

}  // namespace

std::string restSurfaceBytes(const Character& character) {
  std::string bytes;
  addBytes(character.mesh.positions, bytes);
  addBytes(character.mesh.triangles, bytes);
  const Rigid frame = character.skeleton.joints[character.head_joint].rest_world * character.head_frame;
  const std::vector<double> scalp{character.scalp.head_height, character.scalp.center.x(), character.scalp.center.y(),
                                  character.scalp.center.z()};
  addBytes(scalp, bytes);
  addBytes(std::vector<double>(frame.data(), frame.data() + 16), bytes);
  return bytes;
}

BodyDistance restBodyDistance(const Character& character) {
  static Kept<SignedGrid> kept;
  SignedGrid grid = kept.get(restSurfaceBytes(character), [&] { return restGrid(character); });
  return [grid = std::move(grid)](const Vec3& p) { return grid.interpolate(p); };
}

}  // namespace app
