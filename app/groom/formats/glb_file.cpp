#include "app/groom/formats/glb_file.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "app/groom/formats/groom_bytes.h"

namespace app {

namespace {

using Json = nlohmann::json;

constexpr int kFloat = 5126, kUnsigned = 5125;               // component types
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;  // targets of buffer views

// The file's bytes and what tells of them.
struct Buffer {
  std::string bytes;
  Json views = Json::array(), accessors = Json::array();

  // Returns the number of the accessor.
  std::size_t add(std::string_view piece, std::size_t count, const char* type, int component, int target) {
    Json view{{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", piece.size()}};
    if (target != 0) view["target"] = target;
    views.push_back(view);
    accessors.push_back(
        {{"bufferView", views.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    bytes += piece;
    return accessors.size() - 1;
  }
  std::size_t addVectors(const std::vector<Eigen::Vector3f>& vectors) {
    return add(bytesOf(vectors), vectors.size(), "VEC3", kFloat, kArrayBuffer);
  }
  std::size_t addPoints(const std::vector<Eigen::Vector3f>& points) {
    const std::size_t accessor = addVectors(points);
    Eigen::Vector3f low = points[0], high = points[0];
    for (const Eigen::Vector3f& point : points) low = low.cwiseMin(point), high = high.cwiseMax(point);
    accessors[accessor]["min"] = {low.x(), low.y(), low.z()};
    accessors[accessor]["max"] = {high.x(), high.y(), high.z()};
    return accessor;
  }
};

// Moment n has weight 1 for target n - 1 alone.
Json animationOf(const ClipSettings& settings, std::size_t moments, Buffer& buffer) {
  std::vector<float> times, weights((moments - 1) * moments, 0.0f);
  for (std::size_t n = 0; n < moments; ++n) {
    times.push_back(static_cast<float>(settings.timeOf(n)));
    if (n > 0) weights[n * (moments - 1) + n - 1] = 1;
  }
  const std::size_t input = buffer.add(bytesOf(times), times.size(), "SCALAR", kFloat, 0);
  buffer.accessors[input]["min"] = {times.front()};
  buffer.accessors[input]["max"] = {times.back()};
  const std::size_t output = buffer.add(bytesOf(weights), weights.size(), "SCALAR", kFloat, 0);
  return {{"name", "hair"},
          {"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
          {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}};
}

// Unit normals of vertices, the mean of the triangles around by their areas; upwards where there are none.
std::vector<Eigen::Vector3f> normalsOf(const std::vector<std::uint32_t>& triangles,
                                       const std::vector<Eigen::Vector3f>& vertices) {
  std::vector<Eigen::Vector3f> normals(vertices.size(), Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Eigen::Vector3f& a = vertices[triangles[t]];
    const Eigen::Vector3f normal = (vertices[triangles[t + 1]] - a).cross(vertices[triangles[t + 2]] - a);
    for (std::size_t k = 0; k < 3; ++k) normals[triangles[t + k]] += normal;
  }
  for (Eigen::Vector3f& normal : normals) {
    const float length = normal.norm();
    normal = length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::UnitY();
  }
  return normals;
}

std::vector<Eigen::Vector3f> difference(std::vector<Eigen::Vector3f> of, const std::vector<Eigen::Vector3f>& from) {
  for (std::size_t v = 0; v < of.size(); ++v) of[v] -= from[v];
  return of;
}

void padTo4(std::string& bytes, char with) {
  bytes.append((4 - bytes.size() % 4) % 4, with);
}

}  // namespace

GlbWriter::GlbWriter(std::string file, ClipSettings settings, GlbMesh mesh)
    : file_(std::move(file)), settings_(std::move(settings)), mesh_(std::move(mesh)) {}

void GlbWriter::add(const std::vector<Eigen::Vector3f>& vertices) {
  if (moments_.size() == kMaxGlbMoments)
    throw OutputError(file_, "a .glb file is given at most 1000 moments", "export fewer frames, --export-every N");
  if (vertices.empty() || (!moments_.empty() && vertices.size() != moments_[0].size()))
    throw OutputError(file_, "the mesh has no vertices, or not as many as at first",
                      "export without changing the hair");
  moments_.push_back(vertices);
}

void GlbWriter::finish() {
  if (moments_.empty()) throw OutputError(file_, "no frame was exported", "export at least one");
  Buffer buffer;
  const std::vector<Eigen::Vector3f> normals = normalsOf(mesh_.triangles, moments_[0]);
  Json primitive{{"attributes", {{"POSITION", buffer.addPoints(moments_[0])}, {"NORMAL", buffer.addVectors(normals)}}},
                 {"mode", 4},
                 {"material", 0}};
  if (!mesh_.coordinates.empty())
    primitive["attributes"]["TEXCOORD_0"] =
        buffer.add(bytesOf(mesh_.coordinates), mesh_.coordinates.size(), "VEC2", kFloat, kArrayBuffer);
  primitive["indices"] =
      buffer.add(bytesOf(mesh_.triangles), mesh_.triangles.size(), "SCALAR", kUnsigned, kElementBuffer);
  for (std::size_t n = 1; n < moments_.size(); ++n) {
    const std::size_t moved = buffer.addPoints(difference(moments_[n], moments_[0])),
                      turned = buffer.addVectors(difference(normalsOf(mesh_.triangles, moments_[n]), normals));
    primitive["targets"].push_back({{"POSITION", moved}, {"NORMAL", turned}});
  }
  Json mesh{{"name", mesh_.name}, {"primitives", {primitive}}};
  Json scene{{"asset", {{"version", "2.0"}, {"generator", "hairmesh"}}},
             {"scene", 0},
             {"scenes", {{{"nodes", {0}}}}},
             {"nodes", {{{"mesh", 0}, {"name", "hair"}}}}};
  if (moments_.size() > 1) {
    mesh["weights"] = std::vector<float>(moments_.size() - 1, 0.0f);
    scene["animations"] = Json::array({animationOf(settings_, moments_.size(), buffer)});
  }
  Json material{{"name", mesh_.name},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {mesh_.color.x(), mesh_.color.y(), mesh_.color.z(), 1.0f}},
                  {"metallicFactor", 0.0f},
                  {"roughnessFactor", 0.5f}}}};
  if (mesh_.both_sides) material["doubleSided"] = true;
  scene["materials"] = Json::array({material});
  scene["meshes"] = Json::array({mesh});
  padTo4(buffer.bytes, '\0');
  scene["bufferViews"] = buffer.views;
  scene["accessors"] = buffer.accessors;
  scene["buffers"] = Json::array({{{"byteLength", buffer.bytes.size()}}});
  std::string text = scene.dump();
  padTo4(text, ' ');
  const auto chunk = [](const std::string& bytes) { return static_cast<std::uint32_t>(bytes.size()); };
  OutputFile output(file_);
  output.write("glTF");
  output.write(bytesOf(std::uint32_t{2}));
  output.write(bytesOf(12 + 8 + chunk(text) + 8 + chunk(buffer.bytes)));
  output.write(bytesOf(chunk(text)));
  output.write("JSON");
  output.write(text);
  output.write(bytesOf(chunk(buffer.bytes)));
  output.write(std::string_view("BIN\0", 4));
  output.write(buffer.bytes);
  output.commit();
}

}  // namespace app
