// Strands of a hair, of the C interface. They are grown in single precision about the first root: a figure that has
// walked for miles has hair as fine as one at the origin.
#include <string>

#include "app/library/convert.h"
#include "app/library/objects.h"
#include "app/scene/edit/render_faces.h"

namespace app::library {
namespace {

void localPositions(std::span<const Vec3> points, const Vec3& origin, std::vector<float>& floats) {
  floats.resize(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 local = points[i] - origin;
    for (std::size_t k = 0; k < 3; ++k) floats[3 * i + k] = static_cast<float>(local[static_cast<long>(k)]);
  }
}

// The growth for the present parameters; made where there is none.
render::StrandGrowth& growthOf(Hair& hair) {
  const bool fits =
      hair.growth && hair.grown_strands == hair.look.strands && hair.grown_segments == hair.look.segments_per_layer;
  if (!fits) {
    const std::vector<render::HairFace> faces = renderFaces(hair.mesh());
    localPositions(hair.mesh().shape.groom_offsets, Vec3::Zero(), hair.drawn);
    localPositions(hair.mesh().shape.positions, Vec3::Zero(), hair.floats);
    hair.offsets = render::GroomOffsets(faces, hair.floats, hair.drawn);
    hair.offsets.add(hair.floats, hair.drawn);
    hair.growth.emplace(faces, hair.drawn, hair.look.strands, hair.look.segments_per_layer, hair.look.hair);
    hair.grown_strands = hair.look.strands;
    hair.grown_segments = hair.look.segments_per_layer;
  }
  hair.growth->setLook(hair.look.hair);
  return *hair.growth;
}

void checkNumber(int number, const render::StrandGrowth& growth) {
  if (number < 0 || number >= growth.strandCount())
    throw Fault{HM_ERROR_ARGUMENT, "there is no strand " + std::to_string(number) + "; the hair has " +
                                       std::to_string(growth.strandCount()) + ", and the parameter strands sets it"};
}

void checkRequest(const hm_strand_settings& settings, const hm_strand_output& output,
                  const render::StrandGrowth& growth) {
  if (settings.points < 2) throw Fault{HM_ERROR_ARGUMENT, "points is below 2; a strand has a root and a tip"};
  if (settings.count < 0) throw Fault{HM_ERROR_ARGUMENT, "count is below 0"};
  const auto elements = static_cast<std::size_t>(settings.count) * static_cast<std::size_t>(settings.points);
  if (output.positions.data) checkTarget(output.positions, elements, 3, "positions");
  if (output.tangents.data) checkTarget(output.tangents, elements, 3, "tangents");
  if (output.radii.data) checkTarget(output.radii, elements, 1, "radii");
  if (settings.numbers) {
    for (int i = 0; i < settings.count; ++i) checkNumber(settings.numbers[i], growth);
  } else if (settings.count > 0) {
    checkNumber(settings.first, growth);
    if (settings.count > growth.strandCount() - settings.first) checkNumber(growth.strandCount(), growth);
  }
}

void growOne(const render::StrandGrowth& growth, int number, std::size_t first, const Vec3& origin,
             const hm_strand_output& output, std::span<render::CurvePoint> points) {
  const render::Strand strand = growth.strand(number);
  growth.growEven(strand, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 position = origin + points[i].position.cast<double>(), tangent = points[i].tangent.cast<double>();
    const double radius = growth.radius(strand, points[i].along);
    if (output.positions.data) writeElement(output.positions, first + i, 3, position.data());
    if (output.tangents.data) writeElement(output.tangents, first + i, 3, tangent.data());
    if (output.radii.data) writeElement(output.radii, first + i, 1, &radius);
  }
}

}  // namespace
}  // namespace app::library

using namespace app::library;

void hm_default_strand_settings(hm_strand_settings* settings) {
  if (settings) *settings = {nullptr, 0, 0, 16};
}

hm_result hm_hair_grow_strands(hm_hair hair, const hm_strand_settings* settings, const hm_strand_output* output) {
  return guarded("hm_hair_grow_strands", [&] {
    const HairUse use(hair);
    needs(settings, "settings");
    needs(output, "output");
    render::StrandGrowth& growth = growthOf(*use);
    checkRequest(*settings, *output, growth);
    const Vec3 origin = use->state.positions[0];
    localPositions(use->state.positions, origin, use->floats);
    use->offsets.add(use->floats, use->drawn);
    if (!growth.setPositions(use->drawn)) throw Fault{HM_ERROR_INTERNAL, "the state is not finite; reset the hair"};
    use->points.resize(static_cast<std::size_t>(settings->points));
    for (int i = 0; i < settings->count; ++i)
      growOne(growth, settings->numbers ? settings->numbers[i] : settings->first + i,
              static_cast<std::size_t>(i) * use->points.size(), origin, *output, use->points);
  });
}

hm_result hm_hair_describe_strand(hm_hair hair, int32_t number, hm_strand* strand) {
  return guarded("hm_hair_describe_strand", [&] {
    const HairUse use(hair);
    needs(strand, "strand");
    const render::StrandGrowth& growth = growthOf(*use);
    checkNumber(number, growth);
    const render::Strand of = growth.strand(number);
    *strand = {of.face, {of.root.x(), of.root.y()}, of.end, of.loose > 0};
  });
}
