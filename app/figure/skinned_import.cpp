// Characters with their own mesh: glTF, FBX, Collada and OBJ through assimp.
//
// assimp's node tree becomes joints one for one; joints here are rigid, so scales are baked: a joint's place is the
// node's scaled place, its orientation the node's without scale, in the rest pose as in every frame.
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <unordered_map>

#include "app/figure/character_build.h"
#include "app/figure/figure_file.h"
#include "app/figure/mesh_materials.h"
#include "app/figure/still_body.h"
#include "app/files/errors.h"
#include "app/files/file_ending.h"
#include "app/motion/motion.h"
#include "sim/mesh/rigid_motion.h"

namespace app {

namespace {

using Mat4 = Eigen::Matrix4d;

constexpr std::size_t kMaxJoints = 2048, kMaxVertices = 4'000'000, kMaxKeys = 6'000'000;
constexpr double kSampleRate = 60;  // frames a second at which curves are sampled

Mat4 toEigen(const aiMatrix4x4& m) {
  Mat4 e;
  e << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return e;
}

Rigid rigidOf(const Mat4& m) {
  Rigid r = Rigid::Identity();
  r.linear() = sim::nearestRotation(m.topLeftCorner<3, 3>());
  r.translation() = m.topRightCorner<3, 1>();
  return r;
}

struct Node {
  const aiNode* source;
  int parent;
  Mat4 rest_local, rest_world;
};

struct Import {
  const std::string& file;
  const aiScene* scene = nullptr;
  std::vector<Node> nodes;
  std::unordered_map<std::string, int> by_name;
  Mat4 to_metres = Mat4::Identity();  // the file's world to metres, y up
  std::vector<std::string> notes;

  explicit Import(const std::string& name) : file(name) {}

  [[noreturn]] void fail(const std::string& place, const std::string& fault, const std::string& mend) const {
    throw InputError(file, place, fault, mend);
  }

  void flatten() {
    std::vector<std::pair<const aiNode*, int>> open{{scene->mRootNode, -1}};
    while (!open.empty()) {
      const auto [node, parent] = open.back();
      open.pop_back();
      if (nodes.size() >= kMaxJoints)
        fail("node hierarchy", "has over " + std::to_string(kMaxJoints) + " nodes", "export the character alone");
      const Mat4 local = toEigen(node->mTransformation);
      if (!local.allFinite())
        fail("node '" + std::string(node->mName.C_Str()) + "'", "has a transform that is not finite",
             "export it again");
      const Mat4 world = parent < 0 ? local : Mat4(nodes[parent].rest_world * local);
      const int index = static_cast<int>(nodes.size());
      nodes.push_back({node, parent, local, world});
      // Mesh objects are often called like the bones they hang on ('Head'); bones and curves mean the bone.
      const auto [named, is_new] = by_name.emplace(node->mName.C_Str(), index);
      if (!is_new && nodes[named->second].source->mNumMeshes > 0) named->second = index;
      for (unsigned c = node->mNumChildren; c-- > 0;) open.emplace_back(node->mChildren[c], index);
    }
  }

  int find(const aiString& name) const {
    const auto it = by_name.find(name.C_Str());
    return it == by_name.end() ? -1 : it->second;
  }
};

std::string meshName(const aiMesh& mesh) {
  return "mesh '" + std::string(mesh.mName.C_Str()) + "'";
}

// A joint and its weight, of one vertex.
using Influences = std::vector<std::pair<int, double>>;

// The bones that move a mesh: what each vertex follows, and each joint's matrix from the mesh to the joint.
struct Skin {
  std::vector<Influences> influences;
  std::vector<Mat4> offset;
};

Skin readSkin(const Import& import, const aiMesh& source, const std::string& place) {
  Skin skin{std::vector<Influences>(source.mNumVertices), std::vector<Mat4>(import.nodes.size(), Mat4::Identity())};
  for (unsigned b = 0; b < source.mNumBones; ++b) {
    const aiBone& bone = *source.mBones[b];
    const int joint = import.find(bone.mName);
    if (joint < 0)
      import.fail(place, "bone '" + std::string(bone.mName.C_Str()) + "' is no node",
                  "export skeleton and mesh together");
    skin.offset[joint] = toEigen(bone.mOffsetMatrix);
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      if (weight.mVertexId < source.mNumVertices && weight.mWeight > 0 && std::isfinite(weight.mWeight))
        skin.influences[weight.mVertexId].emplace_back(joint, weight.mWeight);
    }
  }
  // The four strongest, weights normalized: what the shaders blend.
  for (Influences& all : skin.influences) {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    if (all.size() > 4) all.resize(4);
    double total = 0;
    for (const auto& [joint, weight] : all) total += weight;
    for (auto& [joint, weight] : all) weight /= total;
  }
  return skin;
}

// Takes the inverse transpose: scales are baked, and not always uniform.
Vec3 transformNormal(const Mat4& to_world, const aiVector3D& n) {
  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  const bool invertible = std::abs(linear.determinant()) > 1e-18;
  const Vec3 turned = (invertible ? Eigen::Matrix3d(linear.inverse().transpose()) : linear) * Vec3(n.x, n.y, n.z);
  return turned.allFinite() && turned.norm() > 1e-12 ? Vec3(turned.normalized()) : Vec3(Vec3::UnitY());
}

void appendVertex(const Import& import, const aiMesh& source, const Skin& skin, int node, unsigned v,
                  SkinnedMesh& mesh) {
  // Skin without a bone, and meshes without a skin, move with their node.
  const Influences& influences = skin.influences[v];
  Mat4 to_rest = influences.empty() ? import.nodes[node].rest_world : Mat4(Mat4::Zero());
  std::array<std::uint16_t, 4> joints{static_cast<std::uint16_t>(node), 0, 0, 0};
  std::array<float, 4> weights{1, 0, 0, 0};
  for (std::size_t k = 0; k < influences.size(); ++k) {
    const auto [joint, weight] = influences[k];
    joints[k] = static_cast<std::uint16_t>(joint);
    weights[k] = static_cast<float>(weight);
    to_rest += weight * import.nodes[joint].rest_world * skin.offset[joint];
  }
  const Mat4 to_world = import.to_metres * to_rest;
  const aiVector3D p = source.mVertices[v];
  const Eigen::Vector4d world = to_world * Eigen::Vector4d(p.x, p.y, p.z, 1);
  if (!world.allFinite() || world.head<3>().norm() > 1e6)
    import.fail(meshName(source), "has a vertex over 1,000 km away", "export the mesh again");
  const Vec3 normal = source.HasNormals() ? transformNormal(to_world, source.mNormals[v]) : Vec3(Vec3::UnitY());
  mesh.positions.push_back(world.head<3>().cast<float>());
  mesh.normals.push_back(normal.cast<float>());
  mesh.joints.push_back(joints);
  mesh.weights.push_back(weights);
}

void appendMesh(const Import& import, const aiMesh& source, int node, SkinnedMesh& mesh, MaterialList& materials) {
  const std::string place = meshName(source);
  if (mesh.positions.size() + source.mNumVertices > kMaxVertices)
    import.fail(place, "has too many vertices", "reduce the mesh below four million");
  const Skin skin = readSkin(import, source, place);
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (unsigned v = 0; v < source.mNumVertices; ++v) {
    appendVertex(import, source, skin, node, v, mesh);
    materials.appendPlace(source, v, mesh);
  }
  for (unsigned f = 0; f < source.mNumFaces; ++f) {
    const aiFace& face = source.mFaces[f];
    if (face.mNumIndices != 3) continue;
    for (int k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= source.mNumVertices)
        import.fail(place + ", face " + std::to_string(f), "names a vertex that is not there", "export the mesh again");
      mesh.triangles.push_back(base + face.mIndices[k]);
    }
  }
}

SkinnedMesh gatherMesh(const Import& import, MaterialList& materials) {
  SkinnedMesh mesh;
  for (std::size_t n = 0; n < import.nodes.size(); ++n)
    for (unsigned m = 0; m < import.nodes[n].source->mNumMeshes; ++m)
      appendMesh(import, *import.scene->mMeshes[import.nodes[n].source->mMeshes[m]], static_cast<int>(n), mesh,
                 materials);
  if (mesh.triangles.empty())
    import.fail("", "holds no mesh with triangles",
                "export the character with its skinned mesh, or give a .bvh motion");
  return mesh;
}

// Up axis and unit from the mesh in its rest pose.
void inferUnits(const SkinnedMesh& raw, int head, Import& import) {
  Eigen::Vector3f low = raw.positions.front(), high = low;
  for (const auto& p : raw.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 size = (high - low).cast<double>();
  Mat4 turn = Mat4::Identity();
  double height = size.y();
  // A z-up file stands its head along z; glTF and most FBX arrive with y up.
  const Vec3 head_place = import.nodes[head].rest_world.topRightCorner<3, 1>() - low.cast<double>();
  if (size.z() > 1.4 * size.y() && head_place.z() > 0.6 * size.z()) {
    turn.topLeftCorner<3, 3>() = Eigen::AngleAxisd(-EIGEN_PI / 2, Vec3::UnitX()).toRotationMatrix();
    height = size.z();
    import.notes.push_back("up axis: z, turned to y");
  } else {
    import.notes.push_back("up axis: y");
  }
  if (!(height > 1e-6)) import.fail("", "the mesh has no height", "export the character in its rest pose");
  char text[160];
  double unit = 0;
  const char* name = "";
  constexpr std::array<std::pair<double, const char*>, 4> kFigureUnits{
      {{1.0, "metres"}, {0.01, "centimetres"}, {0.0254, "inches"}, {0.001, "millimetres"}}};
  for (const auto& [candidate, unit_name] : kFigureUnits) {
    if (height * candidate >= 1.2 && height * candidate <= 2.2) {
      unit = candidate;
      name = unit_name;
      break;
    }
  }
  if (unit > 0) {
    std::snprintf(text, sizeof text, "unit: %s (the mesh is %.2f m tall)", name, height * unit);
  } else {
    unit = 1.70 / height;
    std::snprintf(text, sizeof text, "unit: unknown (the mesh is %.4g units tall), scaled to 1.70 m", height);
  }
  import.notes.push_back(text);
  import.to_metres = turn;
  import.to_metres.topLeftCorner<3, 3>() *= unit;
}

Skeleton buildSkeleton(const Import& import) {
  Skeleton skeleton;
  for (const Node& node : import.nodes) {
    Joint joint;
    joint.name = node.source->mName.C_Str();
    joint.parent = node.parent;
    joint.rest_world = rigidOf(import.to_metres * node.rest_world);
    joint.rest_local =
        node.parent < 0 ? joint.rest_world : skeleton.joints[node.parent].rest_world.inverse() * joint.rest_world;
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

// Keys around a time: index of the earlier one and the share of the later.
template <typename Key>
std::pair<unsigned, double> keyAt(const Key* keys, unsigned count, double time) {
  if (count < 2 || time <= keys[0].mTime) return {0, 0.0};
  if (time >= keys[count - 1].mTime) return {count - 1, 0.0};
  const Key* next = std::upper_bound(keys, keys + count, time, [](double t, const Key& k) { return t < k.mTime; });
  const auto i = static_cast<unsigned>(next - keys - 1);
  const double gap = keys[i + 1].mTime - keys[i].mTime;
  return {i, gap > 0 ? std::clamp((time - keys[i].mTime) / gap, 0.0, 1.0) : 0.0};
}

Vec3 vectorAt(const aiVectorKey* keys, unsigned count, double time) {
  const auto [i, share] = keyAt(keys, count, time);
  const aiVector3D a = keys[i].mValue, b = keys[std::min(i + 1, count - 1)].mValue;
  return (1 - share) * Vec3(a.x, a.y, a.z) + share * Vec3(b.x, b.y, b.z);
}

Mat4 channelAt(const aiNodeAnim& channel, const Mat4& rest, double time) {
  Vec3 position = rest.topRightCorner<3, 1>();
  Vec3 scale(rest.col(0).head<3>().norm(), rest.col(1).head<3>().norm(), rest.col(2).head<3>().norm());
  Eigen::Quaterniond rotation(sim::nearestRotation(rest.topLeftCorner<3, 3>()));
  if (channel.mNumPositionKeys) position = vectorAt(channel.mPositionKeys, channel.mNumPositionKeys, time);
  if (channel.mNumScalingKeys) scale = vectorAt(channel.mScalingKeys, channel.mNumScalingKeys, time);
  if (channel.mNumRotationKeys) {
    const auto [i, share] = keyAt(channel.mRotationKeys, channel.mNumRotationKeys, time);
    const aiQuaternion a = channel.mRotationKeys[i].mValue,
                       b = channel.mRotationKeys[std::min(i + 1, channel.mNumRotationKeys - 1)].mValue;
    const Eigen::Quaterniond qa(a.w, a.x, a.y, a.z), qb(b.w, b.x, b.y, b.z);
    if (qa.norm() > 1e-6 && qb.norm() > 1e-6) rotation = qa.normalized().slerp(share, qb.normalized());
  }
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix() * scale.asDiagonal();
  m.topRightCorner<3, 1>() = position;
  return m;
}

Clip sampleClip(const Import& import, const aiAnimation& animation, const std::string& place) {
  double ticks = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25.0;
  double last = 0;
  std::vector<const aiNodeAnim*> channels(import.nodes.size(), nullptr);
  for (unsigned c = 0; c < animation.mNumChannels; ++c) {
    const aiNodeAnim& channel = *animation.mChannels[c];
    if (const int node = import.find(channel.mNodeName); node >= 0) channels[node] = &channel;
    if (channel.mNumPositionKeys) last = std::max(last, channel.mPositionKeys[channel.mNumPositionKeys - 1].mTime);
    if (channel.mNumRotationKeys) last = std::max(last, channel.mRotationKeys[channel.mNumRotationKeys - 1].mTime);
  }
  if (!std::isfinite(last) || !std::isfinite(ticks))
    import.fail(place, "has a key at no finite time", "export the animation again");
  const double seconds = last / ticks;
  Clip clip;
  clip.name = animation.mName.C_Str();
  clip.frame_time = 1 / kSampleRate;
  clip.joint_count = static_cast<int>(import.nodes.size());
  const double wanted = seconds * kSampleRate + 1;
  if (wanted * clip.joint_count > static_cast<double>(kMaxKeys))
    import.fail(place,
                "lasts " + std::to_string(static_cast<long long>(std::min(seconds, 1e15))) + " s, too long to sample",
                "cut the clip");
  const int frames = std::max(1, static_cast<int>(std::lround(seconds * kSampleRate)) + 1);
  std::vector<Mat4> world(import.nodes.size());
  std::vector<Rigid> rigid(import.nodes.size());
  for (int f = 0; f < frames; ++f) {
    const double time = f / kSampleRate * ticks;
    for (std::size_t n = 0; n < import.nodes.size(); ++n) {
      const Node& node = import.nodes[n];
      const Mat4 local = channels[n] ? channelAt(*channels[n], node.rest_local, time) : node.rest_local;
      world[n] = node.parent < 0 ? Mat4(import.to_metres * local) : Mat4(world[node.parent] * local);
      if (!world[n].allFinite()) import.fail(place, "moves a node to no finite place", "export the animation again");
      rigid[n] = rigidOf(world[n]);
      const Rigid in_parent = node.parent < 0 ? rigid[n] : rigid[node.parent].inverse() * rigid[n];
      Eigen::Quaterniond q(in_parent.linear());
      if (f > 0 && q.dot(clip.rotations[clip.rotations.size() - import.nodes.size()]) < 0) q.coeffs() *= -1;
      clip.rotations.push_back(q.normalized());
      clip.translations.push_back(in_parent.translation());
    }
  }
  return clip;
}

ReferencePose referenceOf(const Skeleton& skeleton) {
  ReferencePose reference;
  for (const Joint& joint : skeleton.joints) {
    reference.world.push_back(joint.rest_world);
    reference.ends.push_back(joint.rest_world.translation());
  }
  return reference;
}

// The same, for the head to be found: a joint that carries skin goes on to the middle of it.
ReferencePose referenceOf(const Skeleton& skeleton, const SkinnedMesh& mesh) {
  ReferencePose reference = referenceOf(skeleton);
  std::vector<Vec3> sums(reference.ends.size(), Vec3::Zero());
  std::vector<double> counts(reference.ends.size(), 0);
  const std::vector<int> dominant = dominantJoints(mesh);
  for (std::size_t v = 0; v < dominant.size(); ++v) {
    sums[static_cast<std::size_t>(dominant[v])] += mesh.positions[v].cast<double>();
    ++counts[static_cast<std::size_t>(dominant[v])];
  }
  for (std::size_t j = 0; j < counts.size(); ++j) {
    if (counts[j] > 0) reference.ends[j] = sums[j] / counts[j];
  }
  return reference;
}

// Whether any vertex moves with a joint or one below it.
bool carriesSkin(const Character& character, int joint) {
  std::vector<bool> below(character.skeleton.joints.size(), false);
  for (std::size_t j = 0; j < below.size(); ++j) {
    const int parent = character.skeleton.joints[j].parent;
    below[j] = static_cast<int>(j) == joint || (parent >= 0 && below[parent]);
  }
  const std::vector<int> dominant = dominantJoints(character.mesh);
  return std::any_of(dominant.begin(), dominant.end(), [&](int j) { return below[j]; });
}

// The rest pose as the only clip.
void holdStill(Import& import, Character& character) {
  Clip still;
  still.name = "rest";
  still.joint_count = static_cast<int>(character.skeleton.joints.size());
  for (const Joint& joint : character.skeleton.joints) {
    still.rotations.emplace_back(joint.rest_local.linear());
    still.translations.push_back(joint.rest_local.translation());
  }
  character.clips.push_back(std::move(still));
  import.notes.push_back("animation: none, the rest pose is held");
}

// Of a head that looks ahead: see Character::head_frame.
Rigid headFrame(const Joint& head, const Vec3& forward) {
  Rigid scalp = Rigid::Identity();
  scalp.linear() << Vec3::UnitY().cross(forward), Vec3::UnitY(), forward;
  scalp.translation() = head.rest_world.translation();
  return head.rest_world.inverse() * scalp;
}

// Whether nothing moves any mesh of a file.
bool isStill(const aiScene& scene) {
  return scene.mNumAnimations == 0 &&
         std::none_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes, [](const aiMesh* m) { return m->HasBones(); });
}

// A mesh that nothing moves: a body, and a head on its neck.
Character assembleStill(Import& import, const SkinnedMesh& raw, const std::string& told, MaterialList& materials) {
  ToldBody tells;
  if (const std::string fault = readToldBody(told, tells); !fault.empty()) throw InputError("", "body", fault, "");
  const std::optional<StillBody> body = measureStillBody(raw.positions, raw.triangles, tells);
  if (!body)
    import.fail("", "is no figure: it has no skeleton, and no neck under a head is found in its mesh",
                "give one upright body, arms down, without hair; hair goes to --hair, a hat to --attach");
  import.to_metres = body->to_metres;
  import.notes = body->notes;
  Character character;
  character.is_still = true;
  character.mesh = gatherMesh(import, materials);
  materials.fill(*import.scene, import.file, character.mesh, import.notes);
  const Rigid skull_base(Eigen::Translation3d(body->neck + 0.2 * body->head_height * Vec3::UnitY()));
  character.skeleton.joints = {{"body"}, {"head", 0, skull_base, skull_base}};
  character.head_joint = 1;
  character.head_frame = headFrame(character.skeleton.joints[1], body->forward);
  for (std::size_t v = 0; v < character.mesh.positions.size(); ++v) {
    const Vec3 above = character.mesh.positions[v].cast<double>() - body->neck;
    const bool is_head = above.y() >= 0 && std::hypot(above.x(), above.z()) < body->head_height;
    character.mesh.joints[v] = {static_cast<std::uint16_t>(is_head ? 1 : 0), 0, 0, 0};
  }
  if (turnFacesOutwards(1, character.mesh)) import.notes.push_back("faces: wound inwards, turned round");
  holdStill(import, character);
  character.notes = import.notes;
  sampleHead(nullptr, character);
  BodyRoles roles;
  roles.head = 1;
  roles.spine = {1};
  fitParts(partsByJoint(character, roles), character);
  return character;
}

Character assemble(Import& import, const std::string& told) {
  MaterialList materials;
  const SkinnedMesh raw = gatherMesh(import, materials);
  bool is_neck = false;
  Skeleton skeleton = buildSkeleton(import);
  int head = findHeadJoint(skeleton, referenceOf(skeleton, raw), is_neck);
  // Nodes of an OBJ are called like its file and groups, whatever these hold.
  if ((head < 0 || endingOf(import.file) == ".obj") && isStill(*import.scene))
    return assembleStill(import, raw, told, materials);
  if (!told.empty())
    import.fail("", "has bones, and '" + told.substr(0, 80) + "' is told of a body without",
                "leave out --body, or the scene's \"body\"");
  if (head >= 0) head = import.by_name.at(skeleton.joints[head].name);
  if (head < 0)
    import.fail("skeleton", "no joint of " + std::to_string(skeleton.joints.size()) + " can carry a head",
                "name the joint that turns the head 'Head'");
  Character character;
  inferUnits(raw, head, import);
  character.mesh = gatherMesh(import, materials);
  materials.fill(*import.scene, import.file, character.mesh, import.notes);
  character.skeleton = skeleton = buildSkeleton(import);
  if (!carriesSkin(character, head))
    import.fail("skeleton", "joint '" + skeleton.joints[head].name + "', taken for the head, carries no skin",
                "name the joint that turns the head 'Head' and bind the head's mesh to it");

  const ReferencePose reference = referenceOf(skeleton);
  BodyRoles roles = inferRoles(skeleton, reference, head, is_neck);
  std::string how;
  const Vec3 forward = inferForward(skeleton, reference, roles, how);
  orderSides(reference, forward, roles);

  character.head_joint = head;
  character.head_frame = headFrame(skeleton.joints[head], forward);

  for (unsigned a = 0; a < import.scene->mNumAnimations; ++a)
    character.clips.push_back(sampleClip(import, *import.scene->mAnimations[a], "animation " + std::to_string(a)));
  if (character.clips.empty()) holdStill(import, character);
  character.notes = import.notes;
  character.notes.push_back("head: joint '" + skeleton.joints[head].name + "'; facing told by " + how);
  sampleHead(nullptr, character);
  fitParts(partsByJoint(character, roles), character);
  return character;
}

}  // namespace

Character importSkinned(const std::string& file, const std::string& told) {
  Assimp::Importer importer;
  Import import(file);
  import.scene = &readFigureFile(file, importer);
  import.flatten();
  return assemble(import, told);
}

}  // namespace app
