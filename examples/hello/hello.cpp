// Hello, hair: reads a hair mesh from an OBJ file, turns the head under it to and fro, and prints where the tip of one
// column goes. hello HAIR.obj [SECONDS]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "sim/step.h"

namespace {

// The convention of assets/hair/README.md at its simplest: every layer has the vertices of layer_0 in the same order,
// and the faces of layer_0 are the root faces. What is wrong with the mesh is found by sim::buildHairMesh.
sim::HairMeshShape readObj(const std::string& file) {
  std::vector<std::vector<sim::Vec3>> layers;
  sim::HairMeshShape shape;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "g") {
      layers.emplace_back();
    } else if (keyword == "v" && !layers.empty()) {
      sim::Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      layers.back().push_back(p);
    } else if (keyword == "f" && layers.size() == 1) {
      sim::RootFace face;
      for (int vertex; face.corner_count < 4 && words >> vertex; words.ignore(64, ' ')) {
        face.columns[face.corner_count++] = vertex - 1;
      }
      shape.root_faces.push_back(face);
    }
  }
  for (std::size_t c = 0; !layers.empty() && c < layers[0].size(); ++c) {
    for (const auto& layer : layers) shape.positions.push_back(layer.at(c));
    shape.column_first.push_back(static_cast<int>(shape.positions.size()));
  }
  return shape;
}

// The head turns 60 degrees to either side, twice a second.
constexpr double kSwing = std::numbers::pi / 3, kRate = 2 * std::numbers::pi * 2;

// A skull around the head joint, moving with the head.
sim::Ellipsoid skullAt(double time) {
  const double angle = kSwing * std::sin(kRate * time), speed = kSwing * kRate * std::cos(kRate * time);
  sim::Ellipsoid skull;
  skull.center = sim::Vec3(0.005 * std::sin(angle), 0.085, 0.005 * std::cos(angle));
  skull.rotation = Eigen::Quaterniond(std::cos(angle / 2), 0, std::sin(angle / 2), 0);
  skull.radii = sim::Vec3(0.072, 0.1, 0.09);
  skull.velocity = sim::Vec3(speed * skull.center.z(), 0, -speed * skull.center.x());
  skull.angular_velocity = sim::Vec3(0, speed, 0);
  return skull;
}

// FNV-1a of the positions' bytes.
unsigned long long hashOf(const std::vector<sim::Vec3>& positions) {
  unsigned long long value = 14695981039346656037ull;
  const auto* bytes = reinterpret_cast<const unsigned char*>(positions.data());
  for (std::size_t i = 0; i < positions.size() * sizeof(sim::Vec3); ++i) value = (value ^ bytes[i]) * 1099511628211ull;
  return value;
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 2) {
    std::fprintf(stderr, "hello HAIR.obj [SECONDS]\n");
    return 2;
  }
  const sim::HairMesh mesh = sim::buildHairMesh(readObj(arguments[1]));
  const double seconds = count > 2 ? std::atof(arguments[2]) : 2;
  const sim::SimParams params;
  sim::StepContext context(mesh);
  sim::HairState hair = sim::restState(mesh, Eigen::Isometry3d::Identity());
  const int tip = mesh.shape.column_first[1] - 1;

  std::printf("%d columns, %d vertices\n  time s     x m     y m     z m\n", mesh.columnCount(), mesh.vertexCount());
  for (double step = 1, time; (time = step / 60) <= seconds; ++step) {
    const std::vector<sim::Ellipsoid> body{skullAt(time)};
    const Eigen::Isometry3d head(body[0].rotation.normalized());
    std::vector<sim::Vec3> roots;
    for (int c = 0; c < mesh.columnCount(); ++c) {
      roots.push_back(head * mesh.shape.positions[mesh.shape.column_first[c]]);
    }
    sim::advance(mesh, params, {roots, body, time}, params.time_step, context, hair);
    const sim::Vec3& p = hair.positions[tip];
    std::printf("%8.3f %7.4f %7.4f %7.4f\n", time, p.x(), p.y(), p.z());
  }
  std::printf("end state: %016llx\n", hashOf(hair.positions));
} catch (const sim::MeshError& error) {
  std::fprintf(stderr, "%s: %s\n", arguments[1], error.what());
  return 1;
}
