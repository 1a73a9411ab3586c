#include "render/body_pass.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector3f;

struct BodyVertex {
  float position[3], normal[3];
  std::uint16_t joints[4];
  float weights[4];
};

bool isSound(const BodyInput& input) {
  const std::size_t vertices = input.positions.size() / 3;
  if (vertices == 0 || input.normals.size() != 3 * vertices || input.joints.size() != 4 * vertices ||
      input.weights.size() != 4 * vertices || input.triangles.size() % 3 != 0 || input.joint_matrices.empty()) {
    return false;
  }
  const auto joint_count = input.joint_matrices.size();
  return std::all_of(input.triangles.begin(), input.triangles.end(), [&](std::uint32_t i) { return i < vertices; }) &&
         std::all_of(input.joints.begin(), input.joints.end(), [&](std::uint16_t j) { return j < joint_count; }) &&
         std::all_of(input.positions.begin(), input.positions.end(), [](float v) { return std::isfinite(v); });
}

bool isFinite(std::span<const Mat4> matrices) {
  return std::all_of(matrices.begin(), matrices.end(), [](const Mat4& m) {
    return std::all_of(m.begin(), m.end(), [](float v) { return std::isfinite(v); });
  });
}

Vector3f transformed(const Mat4& m, const Vector3f& p) {
  Vector3f out;
  for (int row = 0; row < 3; ++row) out[row] = m[row] * p.x() + m[4 + row] * p.y() + m[8 + row] * p.z() + m[12 + row];
  return out;
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

}  // namespace

BodyPass::BodyPass(const std::string& shader_dir)
    : lit_(shader_dir, {{"body.vert", "body.frag"}, {}, {}}),
      depth_(shader_dir, {{"body.vert", "depth_only.frag"}, {}, {}}) {}

BodyPass::Mesh* BodyPass::meshOf(const BodyInput& input, long& uploaded) {
  for (Mesh& mesh : meshes_) {
    if (mesh.id == input.mesh_id) return mesh.index_count > 0 ? &mesh : nullptr;
  }
  Mesh& mesh = meshes_.emplace_back();
  mesh.id = input.mesh_id;
  mesh.seen = true;
  if (!isSound(input)) return nullptr;  // remembered as empty, so a broken mesh is looked at once
  mesh.joint_count = static_cast<int>(input.joint_matrices.size());
  mesh.joint_boxes.resize(input.joint_matrices.size());
  std::vector<BodyVertex> vertices(input.positions.size() / 3);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    for (int k = 0; k < 3; ++k) {
      vertices[v].position[k] = input.positions[3 * v + k];
      vertices[v].normal[k] = input.normals[3 * v + k];
    }
    for (int k = 0; k < 4; ++k) {
      vertices[v].joints[k] = input.joints[4 * v + k];
      vertices[v].weights[k] = input.weights[4 * v + k];
      if (vertices[v].weights[k] > 0.2f) {
        const float* p = vertices[v].position;
        mesh.joint_boxes[vertices[v].joints[k]].add(Vector3f(p[0], p[1], p[2]));
      }
    }
  }
  const auto vertex_bytes = static_cast<GLsizeiptr>(vertices.size() * sizeof(BodyVertex));
  const auto index_bytes = static_cast<GLsizeiptr>(input.triangles.size_bytes());
  mesh.vertices = makeBuffer();
  mesh.indices = makeBuffer();
  glNamedBufferStorage(mesh.vertices.id(), vertex_bytes, vertices.data(), 0);
  glNamedBufferStorage(mesh.indices.id(), index_bytes, input.triangles.data(), 0);
  uploaded += static_cast<long>(vertex_bytes + index_bytes);
  mesh.attributes = makeVertexArray();
  const GLuint array = mesh.attributes.id();
  glVertexArrayVertexBuffer(array, 0, mesh.vertices.id(), 0, sizeof(BodyVertex));
  glVertexArrayElementBuffer(array, mesh.indices.id());
  attribute(array, 0, 3, GL_FLOAT, offsetof(BodyVertex, position));
  attribute(array, 1, 3, GL_FLOAT, offsetof(BodyVertex, normal));
  attribute(array, 2, 4, GL_UNSIGNED_SHORT, offsetof(BodyVertex, joints));
  attribute(array, 3, 4, GL_FLOAT, offsetof(BodyVertex, weights));
  mesh.index_count = static_cast<int>(input.triangles.size());
  return &mesh;
}

bool BodyPass::refreshPose(Body& body, const Mesh& mesh, const BodyInput& input, long& uploaded) {
  const auto joint_count = static_cast<int>(input.joint_matrices.size());
  if (joint_count < mesh.joint_count || !isFinite(input.joint_matrices)) return body.joint_count >= mesh.joint_count;
  if (body.pose_revision == input.pose_revision && body.mesh_id == input.mesh_id && body.joint_count == joint_count) {
    return true;
  }
  std::vector<float> rows;
  rows.reserve(static_cast<std::size_t>(joint_count) * 12);
  for (const Mat4& m : input.joint_matrices) {
    for (int row = 0; row < 3; ++row) rows.insert(rows.end(), {m[row], m[4 + row], m[8 + row], m[12 + row]});
  }
  const auto bytes = static_cast<GLsizeiptr>(rows.size() * sizeof(float));
  if (body.joint_count != joint_count) {
    body.joints = makeBuffer();
    body.joint_texture = makeTexture(GL_TEXTURE_BUFFER);
    glNamedBufferStorage(body.joints.id(), bytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
    glTextureBuffer(body.joint_texture.id(), GL_RGBA32F, body.joints.id());
  }
  glNamedBufferSubData(body.joints.id(), 0, bytes, rows.data());
  uploaded += static_cast<long>(bytes);
  body.bounds = Bounds{};
  for (std::size_t j = 0; j < mesh.joint_boxes.size(); ++j) {
    const Bounds& box = mesh.joint_boxes[j];
    for (int corner = 0; corner < 8 && !box.empty(); ++corner) {
      const Vector3f p((corner & 1) ? box.high.x() : box.low.x(), (corner & 2) ? box.high.y() : box.low.y(),
                       (corner & 4) ? box.high.z() : box.low.z());
      body.bounds.add(transformed(input.joint_matrices[j], p));
    }
  }
  body.joint_count = joint_count;
  body.pose_revision = input.pose_revision;
  ++changes_;
  return true;
}

long BodyPass::update(std::span<const BodyInput> inputs) {
  long uploaded = 0;
  for (Mesh& mesh : meshes_) mesh.seen = false;
  for (Body& body : bodies_) body.seen = false;
  bounds_ = Bounds{};
  for (const BodyInput& input : inputs) {
    Mesh* mesh = meshOf(input, uploaded);
    for (Mesh& kept : meshes_) kept.seen = kept.seen || kept.id == input.mesh_id;
    if (mesh == nullptr) continue;
    auto found =
        std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& b) { return b.id == input.id && !b.seen; });
    if (found == bodies_.end()) {
      bodies_.emplace_back().id = input.id;
      found = bodies_.end() - 1;
      ++changes_;
    }
    Body& body = *found;
    if (!refreshPose(body, *mesh, input, uploaded)) continue;
    body.seen = true;
    body.mesh_id = input.mesh_id;
    if (!body.block || body.color != input.color || body.roughness != input.roughness) {
      body.color = input.color;
      body.roughness = input.roughness;
      shared::BodyBlock block{asVec4(input.color, std::clamp(input.roughness, 0.05f, 1.0f))};
      body.block = makeBuffer();
      glNamedBufferStorage(body.block.id(), sizeof(block), &block, 0);
      uploaded += sizeof(block);
    }
    bounds_.add(body.bounds);
  }
  if (std::erase_if(bodies_, [](const Body& body) { return !body.seen; }) > 0) ++changes_;
  std::erase_if(meshes_, [](const Mesh& mesh) { return !mesh.seen; });
  pose_signature_ = changes_;
  return uploaded;
}

int BodyPass::issue(const Eigen::Matrix4f& clip_from_world) {
  glUniformMatrix4fv(0, 1, GL_FALSE, clip_from_world.data());
  int calls = 0;
  for (const Body& body : bodies_) {
    const auto mesh = std::find_if(meshes_.begin(), meshes_.end(), [&](const Mesh& m) { return m.id == body.mesh_id; });
    glBindBufferBase(GL_UNIFORM_BUFFER, 2, body.block.id());
    glBindTextureUnit(shared::kUnitJoints, body.joint_texture.id());
    glBindVertexArray(mesh->attributes.id());
    glDrawElements(GL_TRIANGLES, mesh->index_count, GL_UNSIGNED_INT, nullptr);
    ++calls;
  }
  return calls;
}

int BodyPass::draw(const Eigen::Matrix4f& clip_from_world) {
  lit_.use();
  return issue(clip_from_world);
}

int BodyPass::drawDepth(const Eigen::Matrix4f& clip_from_world) {
  depth_.use();
  return issue(clip_from_world);
}

std::string BodyPass::reload() {
  const std::string first = lit_.reloadIfChanged(), second = depth_.reloadIfChanged();
  return first.empty() ? second : first;
}

}  // namespace render
