#include "render/body_pass.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/body_detail.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector3f;

struct BodyVertex {
  float position[3], normal[3];
  std::uint16_t joints[4];
  float weights[4];
};

constexpr GLuint kCoverAttribute = 4;  // as in skinning.glsl; from a buffer of its own

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

// Corners of a box moved by a matrix.
void addMoved(const Mat4& m, const Bounds& box, Bounds& sum) {
  for (int corner = 0; corner < 8 && !box.empty(); ++corner) {
    sum.add(
        transformed(m, Vector3f((corner & 1) ? box.high.x() : box.low.x(), (corner & 2) ? box.high.y() : box.low.y(),
                                (corner & 4) ? box.high.z() : box.low.z())));
  }
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

// Whether a body can stand in a light's view or between it and the light. The fifth plane, the light's side, is left
// out.
bool lightMayMeet(const Frustum& light, const Bounds& bounds) {
  Bounds around = bounds;
  const float margin = 0.1f * around.diagonal();
  around.low.array() -= margin;
  around.high.array() += margin;
  Frustum open = light;
  open.planes[4] = Eigen::Vector4f(0, 0, 0, 1);
  return open.maySee(around);
}

}  // namespace

BodyPass::BodyPass(const std::string& shader_dir)
    : lit_(shader_dir, {{"body.vert", "body.frag"}, {}, {}}),
      lit_small_(shader_dir, {{"body_small.vert", "body_small.frag"}, {}, {}}),
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
  std::vector<std::uint32_t> triangles = trianglesByJoint(input);
  int part_joint = -1;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    if (mainJoint(input, triangles[t]) != part_joint) {
      part_joint = mainJoint(input, triangles[t]);
      mesh.parts.emplace_back().first_index = static_cast<int>(t);
    }
    Part& part = mesh.parts.back();
    part.index_count += 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = triangles[t + k];
      for (std::size_t w = 4 * v; w < 4 * v + 4; ++w) {
        if (input.weights[w] <= 0) continue;
        const int joint = input.joints[w];
        auto at = std::find(part.joints.begin(), part.joints.end(), joint) - part.joints.begin();
        if (at == static_cast<long>(part.joints.size())) {
          part.joints.push_back(joint);
          part.boxes.emplace_back();
        }
        part.boxes[static_cast<std::size_t>(at)].add(
            Vector3f(input.positions[3 * v], input.positions[3 * v + 1], input.positions[3 * v + 2]));
      }
    }
  }
  mesh.levels[0] = {0, static_cast<int>(triangles.size())};
  for (std::size_t i = 0; i < kBodyCells.size(); ++i) {
    const std::vector<std::uint32_t> coarser = mergedTriangles(input, kBodyCells[i]);
    mesh.levels[i + 1] = {static_cast<int>(triangles.size()), static_cast<int>(coarser.size())};
    triangles.insert(triangles.end(), coarser.begin(), coarser.end());
  }
  const auto vertex_bytes = static_cast<GLsizeiptr>(vertices.size() * sizeof(BodyVertex));
  const auto index_bytes = static_cast<GLsizeiptr>(triangles.size() * sizeof(std::uint32_t));
  mesh.vertices = makeBuffer();
  mesh.indices = makeBuffer();
  glNamedBufferStorage(mesh.vertices.id(), vertex_bytes, vertices.data(), 0);
  glNamedBufferStorage(mesh.indices.id(), index_bytes, triangles.data(), 0);
  uploaded += static_cast<long>(vertex_bytes + index_bytes);
  mesh.attributes = makeVertexArray();
  const GLuint array = mesh.attributes.id();
  glVertexArrayVertexBuffer(array, 0, mesh.vertices.id(), 0, sizeof(BodyVertex));
  glVertexArrayElementBuffer(array, mesh.indices.id());
  attribute(array, 0, 3, GL_FLOAT, offsetof(BodyVertex, position));
  attribute(array, 1, 3, GL_FLOAT, offsetof(BodyVertex, normal));
  attribute(array, 2, 4, GL_UNSIGNED_SHORT, offsetof(BodyVertex, joints));
  attribute(array, 3, 4, GL_FLOAT, offsetof(BodyVertex, weights));
  glVertexArrayAttribFormat(array, kCoverAttribute, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, kCoverAttribute, 1);
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
  for (std::size_t j = 0; j < mesh.joint_boxes.size(); ++j)
    addMoved(input.joint_matrices[j], mesh.joint_boxes[j], body.bounds);
  body.joint_matrices.assign(input.joint_matrices.begin(), input.joint_matrices.end());
  body.joint_count = joint_count;
  body.pose_revision = input.pose_revision;
  body.change = ++changes_;
  return true;
}

std::uint64_t BodyPass::scalpOf(const BodyInput& input, long& uploaded) {
  if (input.scalp_id == 0 || input.root_cover.size() != input.positions.size() / 3 * 2) return 0;
  auto found = std::find_if(scalps_.begin(), scalps_.end(), [&](const Scalp& scalp) {
    return scalp.mesh_id == input.mesh_id && scalp.id == input.scalp_id;
  });
  if (found == scalps_.end()) {
    const auto bytes = static_cast<GLsizeiptr>(input.root_cover.size_bytes());
    found = scalps_.insert(found, Scalp{input.mesh_id, input.scalp_id, false, makeBuffer()});
    glNamedBufferStorage(found->cover.id(), bytes, input.root_cover.data(), 0);
    uploaded += static_cast<long>(bytes);
  }
  found->seen = true;
  return found->id;
}

void BodyPass::refreshLook(Body& body, const BodyInput& input, long& uploaded) {
  const std::uint64_t scalp_id = scalpOf(input, uploaded);
  if (scalp_id != body.scalp_id) body.change = ++changes_;  // its shape is another as well
  body.scalp_id = scalp_id;
  const Finish finish{input.color, input.root_color, input.roughness, input.scalp_tint};
  if (body.block && body.finish == finish) return;
  ++look_changes_;
  body.finish = finish;
  const shared::BodyBlock block{asVec4(finish.color, std::clamp(finish.roughness, 0.05f, 1.0f)),
                                asVec4(finish.root_color, std::clamp(finish.scalp_tint, 0.0f, 1.0f))};
  body.block = makeBuffer();
  glNamedBufferStorage(body.block.id(), sizeof(block), &block, 0);
  uploaded += sizeof(block);
}

long BodyPass::update(std::span<const BodyInput> inputs) {
  long uploaded = 0;
  for (Mesh& mesh : meshes_) mesh.seen = false;
  for (Scalp& scalp : scalps_) scalp.seen = false;
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
      found->change = ++changes_;
    }
    Body& body = *found;
    if (!refreshPose(body, *mesh, input, uploaded)) continue;
    body.seen = true;
    body.mesh_id = input.mesh_id;
    refreshLook(body, input, uploaded);
    bounds_.add(body.bounds);
  }
  if (std::erase_if(bodies_, [](const Body& body) { return !body.seen; }) > 0) ++changes_;
  std::erase_if(meshes_, [](const Mesh& mesh) { return !mesh.seen; });
  std::erase_if(scalps_, [](const Scalp& scalp) { return !scalp.seen; });
  pose_signature_ = changes_;
  return uploaded;
}

void BodyPass::chooseDetail(const FrameInput& input) {
  const Vector3f eye = asVector(input.camera.eye);
  const float a_metre = static_cast<float>(input.height) / (2 * std::tan(0.5f * input.camera.fov_y));
  for (Body& body : bodies_) {
    const float distance = (body.bounds.center() - eye).norm() - 0.5f * body.bounds.diagonal();
    const int level = input.skips.body_detail && !body.bounds.empty()
                          ? bodyLevel(a_metre / std::max(distance, 1e-3f), body.level)
                          : 0;
    if (level != body.level) body.change = ++changes_;
    body.level = level;
  }
  pose_signature_ = changes_;
}

const BodyPass::Mesh& BodyPass::meshOf(const Body& body) const {
  return *std::find_if(meshes_.begin(), meshes_.end(), [&](const Mesh& m) { return m.id == body.mesh_id; });
}

void BodyPass::bind(const Body& body, const Mesh& mesh) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, body.block.id());
  glBindTextureUnit(shared::kUnitJoints, body.joint_texture.id());
  const GLuint array = mesh.attributes.id();
  const auto scalp = std::find_if(scalps_.begin(), scalps_.end(), [&](const Scalp& s) {
    return s.mesh_id == body.mesh_id && s.id == body.scalp_id;
  });
  if (scalp != scalps_.end()) {
    glVertexArrayVertexBuffer(array, 1, scalp->cover.id(), 0, 2 * sizeof(float));
    glEnableVertexArrayAttrib(array, kCoverAttribute);
  } else {
    glDisableVertexArrayAttrib(array, kCoverAttribute);  // reads as 0
  }
  glBindVertexArray(array);
}

std::uint64_t BodyPass::poseSignature(const Eigen::Matrix4f* clip_from_world) const {
  if (clip_from_world == nullptr) return pose_signature_;
  const Frustum light(*clip_from_world, 0);
  std::uint64_t signature = 1;
  for (const Body& body : bodies_) {
    if (lightMayMeet(light, body.bounds)) signature = (signature ^ body.change) * 1099511628211ull;
  }
  return signature;
}

Bounds BodyPass::boundsNear(const Eigen::Vector3f& eye) const {
  constexpr float kFarther = 2.5f, kAlwaysNear = 3;  // times as far; m
  const auto distance = [&](const Body& body) { return (body.bounds.center() - eye).norm(); };
  float nearest = std::numeric_limits<float>::infinity();
  for (const Body& body : bodies_) nearest = std::min(nearest, distance(body));
  Bounds near;
  for (const Body& body : bodies_) {
    if (distance(body) <= std::max(kFarther * nearest, kAlwaysNear)) near.add(body.bounds);
  }
  return near;
}

void BodyPass::drawLevel(const Body& body, const Mesh& mesh) {
  const IndexRange& range = mesh.levels[static_cast<std::size_t>(body.level)];
  glDrawElements(GL_TRIANGLES, range.count, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(static_cast<std::uintptr_t>(range.first) * 4));
}

int BodyPass::draw(const Eigen::Matrix4f& clip_from_world, const DrawSkips& skips, DrawLeftOut& left_out) {
  for (ShaderProgram* program : {&lit_small_, &lit_}) {
    program->use();
    glUniformMatrix4fv(0, 1, GL_FALSE, clip_from_world.data());
  }
  auto choose = [&, small = false](bool wanted) mutable {
    if (wanted != small) (wanted ? lit_small_ : lit_).use();
    small = wanted;
  };
  const Frustum frustum(clip_from_world, 0.01f);
  int calls = 0;
  for (const Body& body : bodies_) {
    const Mesh& mesh = meshOf(body);
    left_out.body_parts.of += mesh.index_count / 3;
    // The bounds are of what hangs mostly on each joint: a share more holds the rest.
    Bounds around = body.bounds;
    const float margin = 0.1f * around.diagonal();
    around.low.array() -= margin;
    around.high.array() += margin;
    if (skips.view && !frustum.maySee(around)) {
      left_out.body_parts.skipped += mesh.index_count / 3;
      continue;
    }
    left_out.body_detail.of += mesh.index_count / 3;
    if (body.level > 0) {
      left_out.body_detail.skipped += (mesh.index_count - mesh.levels[static_cast<std::size_t>(body.level)].count) / 3;
      choose(true);
      bind(body, mesh);
      drawLevel(body, mesh);
      ++calls;
      continue;
    }
    counts_.clear();
    offsets_.clear();
    int end = -1;
    for (const Part& part : mesh.parts) {
      Bounds box;
      for (std::size_t k = 0; k < part.joints.size(); ++k)
        addMoved(body.joint_matrices[static_cast<std::size_t>(part.joints[k])], part.boxes[k], box);
      if (skips.body_parts && !frustum.maySee(box)) {
        left_out.body_parts.skipped += part.index_count / 3;
        continue;
      }
      if (part.first_index == end) {
        counts_.back() += part.index_count;
      } else {
        counts_.push_back(part.index_count);
        offsets_.push_back(reinterpret_cast<const void*>(static_cast<std::uintptr_t>(part.first_index) * 4));
      }
      end = part.first_index + part.index_count;
    }
    if (counts_.empty()) continue;
    choose(false);
    bind(body, mesh);
    glMultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                        static_cast<GLsizei>(counts_.size()));
    ++calls;
  }
  return calls;
}

int BodyPass::drawDepth(const Eigen::Matrix4f& clip_from_world, bool cull) {
  depth_.use();
  glUniformMatrix4fv(0, 1, GL_FALSE, clip_from_world.data());
  const Frustum light(clip_from_world, 0);
  int calls = 0;
  for (const Body& body : bodies_) {
    if (cull && !lightMayMeet(light, body.bounds)) continue;
    const Mesh& mesh = meshOf(body);
    bind(body, mesh);
    drawLevel(body, mesh);
    ++calls;
  }
  return calls;
}

std::string BodyPass::reload() {
  std::string message;
  for (ShaderProgram* program : {&lit_, &lit_small_, &depth_}) {
    const std::string fault = program->reloadIfChanged();
    if (message.empty()) message = fault;
  }
  return message;
}

}  // namespace render
