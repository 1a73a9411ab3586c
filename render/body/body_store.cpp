#include "render/body/body_store.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/body/skinning.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector3f;

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

// As skinning.glsl reads them.
std::vector<float> jointTexels(std::span<const Mat4> joint_matrices) {
  const std::vector<DualQuaternion> motions = rigidMotions(joint_matrices);
  std::vector<float> texels{motions.empty() ? 3.0f : 2.0f, 0, 0, 0};
  for (const DualQuaternion& motion : motions) {
    texels.insert(texels.end(), motion.real.begin(), motion.real.end());
    texels.insert(texels.end(), motion.dual.begin(), motion.dual.end());
  }
  for (const Mat4& m : motions.empty() ? joint_matrices : std::span<const Mat4>()) {
    for (int row = 0; row < 3; ++row) texels.insert(texels.end(), {m[row], m[4 + row], m[8 + row], m[12 + row]});
  }
  return texels;
}

// Whether a body can stand in a light's view or between it and the light. The fifth plane, the light's side, is left
// out.
bool lightMayMeet(const Frustum& light, const Bounds& around) {
  Frustum open = light;
  open.planes[4] = Eigen::Vector4f(0, 0, 0, 1);
  return open.maySee(around);
}

}  // namespace

void addMoved(const Mat4& matrix, const Bounds& box, Bounds& sum) {
  for (int corner = 0; corner < 8 && !box.empty(); ++corner) {
    sum.add(transformed(matrix,
                        Vector3f((corner & 1) ? box.high.x() : box.low.x(), (corner & 2) ? box.high.y() : box.low.y(),
                                 (corner & 4) ? box.high.z() : box.low.z())));
  }
}

Bounds Body::around() const {
  Bounds box = bounds;
  const float margin = 0.1f * box.diagonal();
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
}

const BodyMesh& BodyStore::meshOf(const BodyInput& input, long& uploaded) {
  auto found = std::find_if(meshes_.begin(), meshes_.end(), [&](const BodyMesh& m) { return m.id == input.mesh_id; });
  // An unsound mesh is kept as an empty one, so that it is looked at once.
  if (found == meshes_.end()) found = meshes_.insert(found, makeBodyMesh(input, uploaded));
  found->seen = true;
  return *found;
}

bool BodyStore::refreshPose(Body& body, const BodyMesh& mesh, const BodyInput& input, long& uploaded) {
  const auto joint_count = static_cast<int>(input.joint_matrices.size());
  if (joint_count < mesh.joint_count || !isFinite(input.joint_matrices)) return body.joint_count >= mesh.joint_count;
  if (body.pose_revision == input.pose_revision && body.mesh_id == input.mesh_id && body.joint_count == joint_count) {
    return true;
  }
  const std::vector<float> texels = jointTexels(input.joint_matrices);
  const auto bytes = static_cast<GLsizeiptr>(texels.size() * sizeof(float));
  if (body.joint_bytes != bytes) {
    body.joint_bytes = bytes;
    body.joints = makeBuffer();
    body.joint_texture = makeTexture(GL_TEXTURE_BUFFER);
    glNamedBufferStorage(body.joints.id(), bytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
    glTextureBuffer(body.joint_texture.id(), GL_RGBA32F, body.joints.id());
  }
  glNamedBufferSubData(body.joints.id(), 0, bytes, texels.data());
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

std::uint64_t BodyStore::scalpOf(const BodyInput& input, long& uploaded) {
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

void BodyStore::refreshLook(Body& body, const BodyMesh& mesh, const BodyInput& input, long& uploaded) {
  const std::uint64_t scalp_id = scalpOf(input, uploaded);
  if (scalp_id != body.scalp_id) body.change = ++changes_;  // its shape is another as well
  body.scalp_id = scalp_id;
  if (input.hair_id != body.hair_id) ++look_changes_;
  body.hair_id = input.hair_id;
  const bool own_materials = input.own_materials && mesh.materials;
  const BodyFinish finish{input.color,       input.root_color, input.roughness,   input.scalp_tint, input.face_origin,
                          input.face_height, input.face_paint, input.cloth_color, input.dressed,    own_materials};
  if (body.block && body.finish == finish) return;
  ++look_changes_;
  body.finish = finish;
  const bool painted = finish.face_height > 0;
  const shared::BodyBlock block{asVec4(finish.color, std::clamp(finish.roughness, 0.05f, 1.0f)),
                                asVec4(finish.root_color, std::clamp(finish.scalp_tint, 0.0f, 1.0f)),
                                asVec4(finish.face_origin, painted ? 1 / finish.face_height : 0),
                                asVec4(finish.cloth_color, finish.dressed ? 1 : 0),
                                {painted ? std::clamp(finish.face_paint, 0.0f, 1.0f) : 0, 0, 0, 0}};
  body.block = makeBuffer();
  glNamedBufferStorage(body.block.id(), sizeof(block), &block, 0);
  uploaded += sizeof(block);
}

long BodyStore::update(std::span<const BodyInput> inputs) {
  long uploaded = 0;
  for (BodyMesh& mesh : meshes_) mesh.seen = false;
  for (Scalp& scalp : scalps_) scalp.seen = false;
  for (Body& body : bodies_) body.seen = false;
  bounds_ = Bounds{};
  for (const BodyInput& input : inputs) {
    const BodyMesh& mesh = meshOf(input, uploaded);
    if (mesh.index_count == 0) continue;
    auto found =
        std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& b) { return b.id == input.id && !b.seen; });
    if (found == bodies_.end()) {
      bodies_.emplace_back().id = input.id;
      found = bodies_.end() - 1;
      found->change = ++changes_;
    }
    Body& body = *found;
    if (!refreshPose(body, mesh, input, uploaded)) continue;
    body.seen = true;
    body.mesh_id = input.mesh_id;
    refreshLook(body, mesh, input, uploaded);
    bounds_.add(body.bounds);
  }
  if (std::erase_if(bodies_, [](const Body& body) { return !body.seen; }) > 0) ++changes_;
  std::erase_if(meshes_, [](const BodyMesh& mesh) { return !mesh.seen; });
  std::erase_if(scalps_, [](const Scalp& scalp) { return !scalp.seen; });
  return uploaded;
}

void BodyStore::chooseDetail(const CameraInput& camera, int height, bool follow_size) {
  const Vector3f eye = asVector(camera.eye);
  const float a_metre = static_cast<float>(height) / (2 * std::tan(0.5f * camera.fov_y));
  for (Body& body : bodies_) {
    const float distance = (body.bounds.center() - eye).norm() - 0.5f * body.bounds.diagonal();
    const int level =
        follow_size && !body.bounds.empty() ? bodyLevel(a_metre / std::max(distance, 1e-3f), body.level) : 0;
    if (level != body.level) body.change = ++changes_;
    body.level = level;
  }
}

const BodyMesh& BodyStore::meshOf(const Body& body) const {
  return *std::find_if(meshes_.begin(), meshes_.end(), [&](const BodyMesh& m) { return m.id == body.mesh_id; });
}

void BodyStore::bind(const Body& body, const BodyMesh& mesh) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, body.block.id());
  glBindTextureUnit(shared::kUnitJoints, body.joint_texture.id());
  if (mesh.materials) glBindTextureUnit(shared::kUnitMaterials, mesh.materials.id());
  const GLuint array = mesh.attributes.id();
  const auto scalp = std::find_if(scalps_.begin(), scalps_.end(),
                                  [&](const Scalp& s) { return s.mesh_id == body.mesh_id && s.id == body.scalp_id; });
  if (scalp != scalps_.end()) {
    glVertexArrayVertexBuffer(array, 1, scalp->cover.id(), 0, 2 * sizeof(float));
    glEnableVertexArrayAttrib(array, kCoverAttribute);
  } else {
    glDisableVertexArrayAttrib(array, kCoverAttribute);  // reads as 0
  }
  glBindVertexArray(array);
}

std::uint64_t BodyStore::poseSignature(const Eigen::Matrix4f* clip_from_world) const {
  if (clip_from_world == nullptr) return changes_;
  const Frustum light(*clip_from_world, 0);
  std::uint64_t signature = 1;
  for (const Body& body : bodies_) {
    if (lightMayMeet(light, body.around())) signature = (signature ^ body.change) * 1099511628211ull;
  }
  return signature;
}

Bounds BodyStore::boundsNear(const Eigen::Vector3f& eye) const {
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

void BodyStore::drawLevel(const Body& body, const BodyMesh& mesh) {
  const IndexRange& range = mesh.levels[static_cast<std::size_t>(body.level)];
  glDrawElements(GL_TRIANGLES, range.count, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(static_cast<std::uintptr_t>(range.first) * 4));
}

int BodyStore::drawAll(const Eigen::Matrix4f& clip_from_world, bool cull) const {
  glUniformMatrix4fv(0, 1, GL_FALSE, clip_from_world.data());
  const Frustum light(clip_from_world, 0);
  int calls = 0;
  for (const Body& body : bodies_) {
    if (cull && !lightMayMeet(light, body.around())) continue;
    const BodyMesh& mesh = meshOf(body);
    bind(body, mesh);
    drawLevel(body, mesh);
    ++calls;
  }
  return calls;
}

}  // namespace render
