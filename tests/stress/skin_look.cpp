#include "tests/stress/skin_look.h"

#ifdef HAIRMESH_EMBREE

#include <algorithm>

#include "app/figure/body_input.h"
#include "app/scene/sim_to_render.h"
#include "render/strands/strand_growth.h"
#include "tests/skin/drawn_skin.h"

namespace stress {
namespace {

constexpr int kStrands = 150;

render::BodyInput bodyOf(const app::Actor& actor, std::span<const render::Mat4> joints) {
  render::BodyInput body;
  app::pointTo(actor.body->character.mesh, body);
  body.joint_matrices = joints;
  body.scalp_id = actor.scalp->id;
  body.root_cover = actor.scalp->cover;
  return body;
}

}  // namespace

struct SkinLook::Impl {
  render::StrandGrowth growth;
  std::vector<render::Mat4> joints;
  app::ShownSkin skin;
  std::vector<float> positions;
  std::vector<render::CurvePoint> strand;
};

SkinLook::SkinLook(const Stage& stage) {
  const app::Actor& actor = stage.actor;
  const app::CharacterLook& look = actor.spec.look;
  impl_.reset(new Impl{
      {actor.haircut->faces, actor.haircut->rest, kStrands, look.segments_per_layer, look.hair}, {}, {}, {}, {}});
  impl_->strand.resize(static_cast<std::size_t>(impl_->growth.maxPoints()));
}

SkinLook::~SkinLook() = default;

void SkinLook::look(const app::Actor& actor, std::span<const sim::Vec3> hair, SkinSeen& seen) {
  Impl& my = *impl_;
  const app::Character& character = actor.body->character;
  const sim::Vec3 origin = hair.front();
  app::blendPositions(hair, hair, 0, origin, my.positions);
  app::jointMatrices(character.skeleton, actor.pose, origin, my.joints);
  app::showSkin(character, actor.body->unfit_parts, actor.pose, origin, my.skin);
  if (!my.growth.setPositions(my.positions)) return;  // not finite, or of another hair
  my.growth.setSkin(my.skin.ellipsoids, my.skin.grids);
  const skin::DrawnSkin skin(bodyOf(actor, my.joints));
  for (int number = 0; number < my.growth.strandCount(); ++number) {
    const int count = my.growth.growDrawn(my.growth.strand(number), my.strand);
    for (int i = 0; i < count; ++i) {
      const double depth = skin.depth(my.strand[i].position);
      ++seen.points;
      seen.under += depth > kUnder;
      seen.deepest = std::max(seen.deepest, depth);
    }
  }
}

}  // namespace stress

#else

namespace stress {

struct SkinLook::Impl {};
SkinLook::SkinLook(const Stage&) {}
SkinLook::~SkinLook() = default;
void SkinLook::look(const app::Actor&, std::span<const sim::Vec3>, SkinSeen&) {}

}  // namespace stress

#endif
