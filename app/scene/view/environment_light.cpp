#include "app/scene/view/environment_light.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "app/files/errors.h"

namespace app {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

constexpr int kMaxRows = 32;  // that a panorama is averaged to, twice as many columns: a cell is 5.6 degrees wide
constexpr double kSphere = 4 * std::numbers::pi;
constexpr double kConeCosine = 0.906;  // of 25 degrees: what counts as one light

struct Cell {
  Vector3d direction;  // unit
  double angle = 0;    // sr
  Array3d radiance = Array3d::Zero();
};

// Mean radiance of each cell; what a sphere gets is the picture's.
std::vector<Cell> cellsOf(const RadiancePicture& panorama) {
  const int rows = std::min(kMaxRows, panorama.height), columns = 2 * rows;
  std::vector<Cell> cells(static_cast<std::size_t>(rows) * columns);
  const auto slice = [](int row, int of) {  // share of a sphere's height
    const double pi = std::numbers::pi;
    return 0.5 * (std::cos(pi * row / of) - std::cos(pi * (row + 1) / of));
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * (i + 0.5) / rows;
      const double turn = 2 * std::numbers::pi * ((j + 0.5) / columns - 0.5);
      Cell& cell = cells[static_cast<std::size_t>(i) * columns + j];
      cell.direction = {-std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn)};
      cell.angle = kSphere * slice(i, rows) / columns;
    }
  }
  for (int y = 0; y < panorama.height; ++y) {
    const double angle = kSphere * slice(y, panorama.height) / panorama.width;
    for (int x = 0; x < panorama.width; ++x) {
      const int at = y * rows / panorama.height * columns + x * columns / panorama.width;
      const float* rgb = &panorama.rgb[3 * (static_cast<std::size_t>(y) * panorama.width + x)];
      cells[at].radiance += angle * Array3d(rgb[0], rgb[1], rgb[2]);
    }
  }
  for (Cell& cell : cells) cell.radiance /= cell.angle;
  return cells;
}

Array3d meanOf(const std::vector<Cell>& cells) {
  Array3d sum = Array3d::Zero();
  for (const Cell& cell : cells) sum += cell.angle / kSphere * cell.radiance;
  return sum;
}

struct FarLight {
  Vector3d towards = Vector3d::UnitY();  // unit
  Array3d irradiance = Array3d::Zero();
};

// Takes the brightest light out of the cells.
FarLight takeBrightest(std::vector<Cell>& cells) {
  const Array3d mean = meanOf(cells);
  std::vector<Array3d> excess;
  for (const Cell& cell : cells) excess.push_back(cell.angle * (cell.radiance - mean).max(0.0));
  const auto inCone = [&](const Vector3d& middle, std::size_t i) {
    return middle.dot(cells[i].direction) > kConeCosine;
  };
  Vector3d brightest = Vector3d::UnitY();
  double most = 0;
  for (const Cell& middle : cells) {
    double sum = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) sum += inCone(middle.direction, i) ? excess[i].sum() : 0;
    if (sum > most) most = sum, brightest = middle.direction;
  }
  FarLight light{brightest, Array3d::Zero()};
  Vector3d towards = Vector3d::Zero();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!inCone(brightest, i)) continue;
    light.irradiance += excess[i];
    towards += excess[i].sum() * cells[i].direction;
    cells[i].radiance -= excess[i] / cells[i].angle;
  }
  if (towards.norm() > 0) light.towards = towards.normalized();
  return light;
}

render::Float3 floats(const Array3d& a) {
  return {static_cast<float>(a.x()), static_cast<float>(a.y()), static_cast<float>(a.z())};
}

Array3d arrayOf(const render::Float3& a) {
  return {a[0], a[1], a[2]};
}

// Mean radiance over all directions and channels.
double brightness(const render::LightInput& light) {
  const Array3d far = arrayOf(light.key) + arrayOf(light.fill) + arrayOf(light.rim);
  return (far / kSphere + 0.5 * (arrayOf(light.ambient_sky) + arrayOf(light.ambient_ground))).mean();
}

// The rows that a panorama sets.
void copyLights(const render::LightInput& from, render::LightInput& to) {
  to.to_light = from.to_light, to.key = from.key;
  to.to_fill = from.to_fill, to.fill = from.fill;
  to.to_rim = from.to_rim, to.rim = from.rim;
  to.ambient_sky = from.ambient_sky, to.ambient_ground = from.ambient_ground;
}

}  // namespace

render::LightInput environmentLight(const std::string& file, const RadiancePicture& panorama,
                                    render::LightInput light) {
  if (panorama.width != 2 * panorama.height) {
    throw InputError(file, "size", "is no panorama of all directions", "give one twice as wide as high");
  }
  std::vector<Cell> cells = cellsOf(panorama);
  const double given = meanOf(cells).mean();
  if (!(given > 0)) throw InputError(file, "light", "is black everywhere", "give a panorama with a light in it");
  const double scale = brightness(render::LightInput{}) / given;
  for (Cell& cell : cells) cell.radiance *= scale;

  const FarLight key = takeBrightest(cells), fill = takeBrightest(cells), rim = takeBrightest(cells);
  const Array3d mean = meanOf(cells);
  Array3d slope = Array3d::Zero();
  for (const Cell& cell : cells) slope += 2 * cell.angle / kSphere * cell.direction.y() * cell.radiance;
  slope = slope.max(-mean).min(mean);
  light.to_light = floats(key.towards.array());
  light.key = floats(key.irradiance);
  light.to_fill = floats(fill.towards.array());
  light.fill = floats(fill.irradiance);
  light.to_rim = floats(rim.towards.array());
  light.rim = floats(rim.irradiance);
  light.ambient_sky = floats(mean + slope);
  light.ambient_ground = floats(mean - slope);
  return light;
}

render::LightInput environmentLight(const std::string& file, const render::LightInput& light) {
  return environmentLight(file, readRadiance(file), light);
}

void setEnvironment(const std::string& file, Scene& scene) {
  render::LightInput& light = scene.look.light;
  const render::LightInput wanted = file.empty() ? scene.own_light : environmentLight(file, light);
  if (file.empty() && scene.environment.empty()) return;
  if (scene.environment.empty()) scene.own_light = light;
  copyLights(wanted, light);
  scene.environment = file;
}

}  // namespace app
