#include "render/body/body_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace render {
namespace {

using Eigen::Vector3f;

struct BodyVertex {
  float position[3], normal[3];
  std::uint16_t joints[4];
  float weights[4];
  float cloth;
};

bool isSound(const BodyInput& input) {
  const std::size_t vertices = input.positions.size() / 3;
  if (vertices == 0 || input.normals.size() != 3 * vertices || input.joints.size() != 4 * vertices ||
      input.weights.size() != 4 * vertices || (!input.cloth.empty() && input.cloth.size() != vertices) ||
      input.triangles.size() % 3 != 0 || input.joint_matrices.empty()) {
    return false;
  }
  const auto joint_count = input.joint_matrices.size();
  return std::all_of(input.triangles.begin(), input.triangles.end(), [&](std::uint32_t i) { return i < vertices; }) &&
         std::all_of(input.joints.begin(), input.joints.end(), [&](std::uint16_t j) { return j < joint_count; }) &&
         std::all_of(input.positions.begin(), input.positions.end(), [](float v) { return std::isfinite(v); });
}

// Triangles in the order of the joint that their first corner hangs on; within a joint as they come.
std::vector<std::uint32_t> trianglesByJoint(const BodyInput& input) {
  std::vector<std::uint32_t> order(input.triangles.size() / 3);
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = static_cast<std::uint32_t>(t);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return mainJoint(input, input.triangles[3 * a]) < mainJoint(input, input.triangles[3 * b]);
  });
  std::vector<std::uint32_t> sorted;
  sorted.reserve(input.triangles.size());
  for (const std::uint32_t t : order) {
    for (std::size_t k = 0; k < 3; ++k) sorted.push_back(input.triangles[3 * t + k]);
  }
  return sorted;
}

void attribute(GLuint array, GLuint index, GLint size, GLenum type, GLuint offset) {
  glEnableVertexArrayAttrib(array, index);
  if (type == GL_FLOAT) {
    glVertexArrayAttribFormat(array, index, size, type, GL_FALSE, offset);
  } else {
    glVertexArrayAttribIFormat(array, index, size, type, offset);
  }
  glVertexArrayAttribBinding(array, index, 0);
}

Vector3f restPosition(const BodyInput& input, std::size_t v) {
  return {input.positions[3 * v], input.positions[3 * v + 1], input.positions[3 * v + 2]};
}

std::vector<BodyVertex> verticesOf(const BodyInput& input) {
  std::vector<BodyVertex> vertices(input.positions.size() / 3);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      vertices[v].position[k] = input.positions[3 * v + k];
      vertices[v].normal[k] = input.normals[3 * v + k];
    }
    vertices[v].cloth = input.cloth.empty() ? 1 : input.cloth[v];
    for (std::size_t k = 0; k < 4; ++k) {
      vertices[v].joints[k] = input.joints[4 * v + k];
      vertices[v].weights[k] = input.weights[4 * v + k];
    }
  }
  return vertices;
}

// Boxes around the vertices that each joint moves by a share worth counting.
std::vector<Bounds> jointBoxes(const BodyInput& input) {
  constexpr float kCounts = 0.2f;
  std::vector<Bounds> boxes(input.joint_matrices.size());
  for (std::size_t w = 0; w < input.weights.size(); ++w) {
    if (input.weights[w] > kCounts) boxes[input.joints[w]].add(restPosition(input, w / 4));
  }
  return boxes;
}

void addVertex(const BodyInput& input, std::size_t v, JointTriangles& triangles) {
  for (std::size_t w = 4 * v; w < 4 * v + 4; ++w) {
    if (input.weights[w] <= 0) continue;
    const int joint = input.joints[w];
    auto at = std::find(triangles.joints.begin(), triangles.joints.end(), joint) - triangles.joints.begin();
    if (at == static_cast<long>(triangles.joints.size())) {
      triangles.joints.push_back(joint);
      triangles.boxes.emplace_back();
    }
    triangles.boxes[static_cast<std::size_t>(at)].add(restPosition(input, v));
  }
}

// Groups triangles that are sorted by joint.
std::vector<JointTriangles> groupByJoint(const BodyInput& input, const std::vector<std::uint32_t>& triangles) {
  std::vector<JointTriangles> groups;
  int joint = -1;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    if (mainJoint(input, triangles[t]) != joint) {
      joint = mainJoint(input, triangles[t]);
      groups.emplace_back().first_index = static_cast<int>(t);
    }
    groups.back().index_count += 3;
    for (std::size_t k = 0; k < 3; ++k) addVertex(input, triangles[t + k], groups.back());
  }
  return groups;
}

// Attribute locations as in skinning.glsl.
void describeVertices(BodyMesh& mesh) {
  mesh.attributes = makeVertexArray();
  const GLuint array = mesh.attributes.id();
  glVertexArrayVertexBuffer(array, 0, mesh.vertices.id(), 0, sizeof(BodyVertex));
  glVertexArrayElementBuffer(array, mesh.indices.id());
  attribute(array, 0, 3, GL_FLOAT, offsetof(BodyVertex, position));
  attribute(array, 1, 3, GL_FLOAT, offsetof(BodyVertex, normal));
  attribute(array, 2, 4, GL_UNSIGNED_SHORT, offsetof(BodyVertex, joints));
  attribute(array, 3, 4, GL_FLOAT, offsetof(BodyVertex, weights));
  attribute(array, 5, 1, GL_FLOAT, offsetof(BodyVertex, cloth));
  glVertexArrayAttribFormat(array, kCoverAttribute, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, kCoverAttribute, 1);
  glVertexArrayAttribFormat(array, kPlaceAttribute, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, kPlaceAttribute, 2);
}

float edgeLength(const BodyInput& input) {
  double sum = 0;
  for (std::size_t t = 0; t < input.triangles.size(); ++t) {
    const std::size_t next = t % 3 == 2 ? t - 2 : t + 1;
    sum += (restPosition(input, input.triangles[t]) - restPosition(input, input.triangles[next])).squaredNorm();
  }
  return static_cast<float>(std::sqrt(sum / static_cast<double>(std::max<std::size_t>(input.triangles.size(), 1))));
}

long upload(const void* data, std::size_t bytes, Buffer& buffer) {
  buffer = makeBuffer();
  glNamedBufferStorage(buffer.id(), static_cast<GLsizeiptr>(bytes), data, 0);
  return static_cast<long>(bytes);
}

bool hasSoundMaterials(const BodyInput& input) {
  if (input.materials.empty() || input.material_places.size() != input.positions.size()) return false;
  const std::size_t texels = input.materials[0].size();
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(texels))));
  return texels > 0 && side * side == texels &&
         std::all_of(input.materials.begin(), input.materials.end(),
                     [&](const auto& m) { return m.size() == texels; }) &&
         std::all_of(input.material_places.begin(), input.material_places.end(),
                     [](float v) { return std::isfinite(v); });
}

// The pictures as an array texture with all its levels of detail.
long uploadMaterials(const BodyInput& input, BodyMesh& mesh) {
  if (!hasSoundMaterials(input)) return 0;
  const auto side = static_cast<GLsizei>(std::lround(std::sqrt(static_cast<double>(input.materials[0].size()))));
  const auto count = static_cast<GLsizei>(input.materials.size());
  mesh.materials = makeTexture(GL_TEXTURE_2D_ARRAY);
  const GLuint texture = mesh.materials.id();
  glTextureStorage3D(texture, 1 + static_cast<GLsizei>(std::log2(side)), GL_SRGB8_ALPHA8, side, side, count);
  for (GLsizei k = 0; k < count; ++k) {
    glTextureSubImage3D(texture, 0, 0, 0, k, side, side, 1, GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV,
                        input.materials[static_cast<std::size_t>(k)].data());
  }
  glGenerateTextureMipmap(texture);
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  long bytes = upload(input.material_places.data(), input.material_places.size_bytes(), mesh.material_places);
  glVertexArrayVertexBuffer(mesh.attributes.id(), 2, mesh.material_places.id(), 0, 3 * sizeof(float));
  glEnableVertexArrayAttrib(mesh.attributes.id(), kPlaceAttribute);
  return bytes + 4L * side * side * count;
}

}  // namespace

BodyMesh makeBodyMesh(const BodyInput& input, long& uploaded) {
  BodyMesh mesh;
  mesh.id = input.mesh_id;
  if (!isSound(input)) return mesh;
  mesh.index_count = static_cast<int>(input.triangles.size());
  mesh.joint_count = static_cast<int>(input.joint_matrices.size());
  mesh.joint_boxes = jointBoxes(input);
  mesh.spacing = edgeLength(input);
  const std::vector<BodyVertex> vertices = verticesOf(input);
  std::vector<std::uint32_t> triangles = trianglesByJoint(input);
  mesh.by_joint = groupByJoint(input, triangles);
  mesh.levels[0] = {0, mesh.index_count};
  for (std::size_t i = 0; i < kBodyCells.size(); ++i) {
    const std::vector<std::uint32_t> coarser = mergedTriangles(input, kBodyCells[i]);
    mesh.levels[i + 1] = {static_cast<int>(triangles.size()), static_cast<int>(coarser.size())};
    triangles.insert(triangles.end(), coarser.begin(), coarser.end());
  }
  uploaded += upload(vertices.data(), vertices.size() * sizeof(BodyVertex), mesh.vertices);
  uploaded += upload(triangles.data(), triangles.size() * sizeof(std::uint32_t), mesh.indices);
  describeVertices(mesh);
  uploaded += uploadMaterials(input, mesh);
  return mesh;
}

}  // namespace render
