#include "app/scene/view/figure_input.h"

#include <Eigen/Geometry>
#include <utility>

#include "app/figure/body_input.h"
#include "app/motion/least_rotation.h"
#include "app/scene/attachments.h"
#include "app/scene/braid/braid_band.h"
#include "app/scene/braid/braid_draw.h"
#include "render/light/fiber_scattering.h"

namespace app {

render::HairInput hairInput(const Actor& actor, const CharacterLook& look, std::span<const float> positions,
                            std::vector<float>& drawn) {
  render::HairInput input;
  input.id = actor.id;
  input.layout_revision = actor.layout_revision;
  input.position_revision = actor.position_revision;
  input.layout_id = actor.haircut->id;
  input.faces = actor.haircut->faces;
  input.positions = positions;
  input.rest = actor.haircut->rest;
  input.strands = look.strands;
  input.segments_per_layer = look.segments_per_layer;
  input.look = look.hair;
  input.shares = actor.haircut->look_shares.shares();
  if (look.lift_strands) {
    input.skin = actor.shown_skin.ellipsoids;
    input.skin_grids = actor.shown_skin.grids;
  }
  const render::GroomOffsets& offsets = actor.haircut->offsets;
  if (!offsets.empty() && positions.size() == actor.haircut->rest.size()) {
    offsets.add(positions, drawn);
    input.positions = drawn;
    input.rest = actor.haircut->rest_drawn;
  }
  const BraidPlan& braids = actor.haircut->braids;
  if (!braids.empty() && positions.size() == actor.haircut->rest.size()) {
    const std::vector<float> read = std::move(drawn);  // input.positions may lie in it
    drawBraids(braids, input.positions, drawn);
    input.faces = braids.faces;
    input.positions = drawn;
    input.rest = braids.rest;
    input.segments_per_layer = braidSegments(braids, look.segments_per_layer);
    input.shares.roots = braids.root_shares;
  }
  return input;
}

// From the band to the figure as it is shown. The ring's axis leads away from the head's middle.
render::Mat4 bandAround(const HairTie& tie, const Actor& actor) {
  const Character& character = actor.body->character;
  const auto head = static_cast<std::size_t>(character.head_joint);
  const Vec3 axis = tie.at - character.scalp.center;
  const Eigen::Affine3d ring =
      Eigen::Translation3d(tie.at) * leastRotation(Vec3::UnitZ(), axis) * Eigen::Scaling(tie.radius);
  const Eigen::Affine3d at_rest = character.skeleton.joints[head].rest_world * character.head_frame * ring;
  render::Mat4 matrix;
  Eigen::Map<Eigen::Matrix4f>(matrix.data()) =
      Eigen::Map<const Eigen::Matrix4f>(actor.joint_matrices[head].data()) * at_rest.matrix().cast<float>();
  return matrix;
}

void addBands(const Actor& actor, std::span<const float> positions, std::vector<render::Mat4>& matrices,
              std::vector<render::BodyInput>& bodies) {
  matrices.clear();
  if (actor.spec.look.strands <= 0) return;
  const BraidPlan& braids = actor.haircut->braids;
  if (!braids.empty() && positions.size() == actor.haircut->rest.size()) matrices = braidBands(braids, positions);
  for (const HairTie& tie : actor.haircut->bands) matrices.push_back(bandAround(tie, actor));
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    render::BodyInput input = bandInput(actor.id, k);
    input.joint_matrices = {&matrices[k], 1};
    input.pose_revision = actor.position_revision;
    input.hair_id = actor.id;
    bodies.push_back(input);
  }
}

render::BodyInput bodyInput(const Actor& actor, const CharacterLook& look, bool show_strands) {
  const SkinnedMesh& mesh = actor.body->character.mesh;
  render::BodyInput input;
  input.id = actor.id;
  input.mesh_id = actor.body->id;
  pointTo(mesh, input);
  input.joint_matrices = actor.joint_matrices;
  input.pose_revision = actor.pose_revision;
  input.color = look.body_color;
  input.roughness = look.body_roughness;
  // A head whose hair is not drawn is bald.
  input.scalp_id = show_strands && look.strands > 0 ? actor.scalp->id : 0;
  input.root_cover = actor.scalp->cover;
  input.hair_id = input.scalp_id != 0 ? actor.id : 0;
  input.scalp_tint = look.scalp_tint;
  input.root_color = render::rootColor(look.hair);
  const Face& face = actor.body->character.face;
  for (int k = 0; k < 3; ++k) input.face_origin[k] = static_cast<float>(face.origin[k]);
  input.face_height = static_cast<float>(face.height);
  input.face_paint = look.face_paint;
  input.cloth = mesh.cloth;
  input.dressed = look.dressed;
  input.cloth_color = look.cloth_color;
  if (!mesh.materials.empty()) {
    input.material_places = {mesh.material_places.data()->data(), 3 * mesh.material_places.size()};
    input.materials = mesh.materials;
    input.own_materials = look.own_materials;
  }
  return input;
}

render::BodyInput attachmentInput(const Actor& actor, std::size_t k, bool show_strands) {
  const WornAttachment& worn = actor.worn[k];
  const Attachment& mesh = *worn.mesh;
  render::BodyInput input;
  input.id = worn.id;
  input.mesh_id = mesh.id;
  pointTo(mesh, input);
  input.joint_matrices = {&worn.matrix, 1};
  input.pose_revision = actor.pose_revision;
  input.hair_id = show_strands && actor.spec.look.strands > 0 ? actor.id : 0;
  input.color = wornColor(actor, k);
  input.roughness = actor.spec.attachments[k].roughness;
  return input;
}

}  // namespace app
