#include "app/scene/record/hair_export.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <thread>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/report_line.h"
#include "app/groom/formats/glb_file.h"
#include "app/groom/formats/tfx_file.h"
#include "app/groom/groom_writer.h"
#include "app/options.h"
#include "app/scene/record/card_mesh.h"
#include "app/scene/view/figure_input.h"
#include "render/light/fiber_scattering.h"
#include "render/strands/strand_growth.h"

namespace app {

namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr std::size_t kStrandsAThread = 512;  // fewer are not worth one

// The reflectance of hair in even light, from its absorption: the inverse of the fit that absorptionOf has of Chiang et
// al. 2016.
Vector3f hairColor(const render::HairLook& look) {
  const float b = look.beta_n;
  const float fit = 5.969f + b * (-0.215f + b * (2.532f + b * (-10.73f + b * (5.574f + b * 0.245f))));
  const render::Float3 sigma = render::absorptionOf(look);
  Vector3f color;
  for (int c = 0; c < 3; ++c) color[c] = std::exp(-fit * std::sqrt(sigma[c]));
  return color;
}

// A direction from the middle of the roots as longitude and latitude, each 0..1.
Vector2f sphericalUv(const Vector3f& from_middle) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float reach = std::max(from_middle.norm(), 1e-12f);
  return {0.5f + std::atan2(from_middle.x(), from_middle.z()) / (2 * kPi),
          0.5f + std::asin(std::clamp(from_middle.y() / reach, -1.0f, 1.0f)) / kPi};
}

// Calls work(first, end) on parts of [0, count), each on a thread of its own.
template <class Work>
void inParts(std::size_t count, Work&& work) {
  const std::size_t threads = std::clamp<std::size_t>(
      std::min<std::size_t>(std::thread::hardware_concurrency(), count / kStrandsAThread), 1, 8);
  std::vector<std::jthread> others;
  for (std::size_t part = 1; part < threads; ++part)
    others.emplace_back([&, part] { work(count * part / threads, count * (part + 1) / threads); });
  work(0, count / threads);
}

}  // namespace

// The strands of one character that have points, and where they begin in the groom.
struct StrandExport::Grown {
  render::StrandGrowth growth;
  std::vector<render::Strand> strands;
  std::size_t first_strand = 0;
  std::vector<float> drawn;  // where strands grow, of plaits and grooms
};

StrandExport::~StrandExport() = default;

StrandExport::StrandExport(const Demo& demo, ExportWhat what, int points) : what_(what), points_(points) {
  std::int32_t number = 0, character = 0;
  const auto addStrand = [&](std::size_t count, const Vector2f& uv, std::int32_t id) {
    groom_.points.resize(groom_.points.size() + count);
    groom_.strand_first.push_back(static_cast<std::uint32_t>(groom_.points.size()));
    groom_.root_uvs.push_back(uv);
    groom_.ids.push_back(id);
    groom_.groups.push_back(character);
    groom_.guides.push_back(what_ == ExportWhat::kGuides);
  };
  for (const Actor& actor : demo.actors) {
    const CharacterLook& look = actor.spec.look;
    const Haircut& haircut = *actor.haircut;
    const sim::HairMeshShape& shape = haircut.mesh.shape;
    Vector3f middle = Vector3f::Zero();
    for (int c = 0; c < shape.columnCount(); ++c)
      middle += shape.positions[shape.column_first[c]].cast<float>() / static_cast<float>(shape.columnCount());
    std::vector<float> grows_at;
    const render::HairInput input = hairInput(actor, look, haircut.rest, grows_at);
    grown_.push_back(std::make_unique<Grown>(Grown{
        {input.faces, input.rest, input.strands, input.segments_per_layer, input.look, input.shares}, {}, 0, {}}));
    Grown& grown = *grown_.back();
    grown.first_strand = groom_.strandCount();
    grown.growth.setPositions(input.positions);
    if (what_ == ExportWhat::kGuides) {
      for (int c = 0; c < shape.columnCount(); ++c) {
        const Vector3f root = shape.positions[shape.column_first[c]].cast<float>();
        addStrand(static_cast<std::size_t>(shape.columnLength(c)), sphericalUv(root - middle), number++);
      }
    }
    for (int s = 0; what_ == ExportWhat::kStrands && s < grown.growth.strandCount(); ++s, ++number) {
      const render::Strand strand = grown.growth.strand(s);
      const int drawn = grown.growth.drawnPoints(strand);
      if (drawn < 2) continue;
      std::array<render::CurvePoint, 2> ends;
      grown.growth.growEven(strand, ends);
      grown.strands.push_back(strand);
      addStrand(static_cast<std::size_t>(points_ > 0 ? points_ : drawn), sphericalUv(ends[0].position - middle),
                number);
    }
    groom_.colors.resize(groom_.points.size(), hairColor(look.hair));  // guides'; strands' are dyed as they grow
    ++character;
  }
  groom_.widths.resize(groom_.points.size());
}

const Groom& StrandExport::groom(const Demo& demo, double unit) {
  const auto scale = static_cast<float>(1 / unit);
  const Vector3f origin = demo.origin.cast<float>();
  for (std::size_t a = 0; a < grown_.size() && a < demo.actors.size(); ++a) {
    Grown& grown = *grown_[a];
    const Actor& actor = demo.actors[a];
    const render::HairInput input = hairInput(actor, actor.spec.look, actor.shown_positions, grown.drawn);
    if (!grown.growth.setPositions(input.positions)) {
      throw OutputError("export", "the hair of character " + std::to_string(a + 1) + " was exchanged during the run",
                        "export without changing style or hair mesh");
    }
    grown.growth.setSkin(input.skin, input.skin_grids);
    if (what_ == ExportWhat::kGuides) {
      const std::size_t first = groom_.strand_first[grown.first_strand];
      const float width = 2 * actor.spec.look.hair.strand_radius;
      for (std::size_t v = 0; 3 * v + 2 < actor.shown_positions.size(); ++v) {
        const Vector3f at = Eigen::Map<const Vector3f>(&actor.shown_positions[3 * v]);
        groom_.points[first + v] = scale * (at + origin);
        groom_.widths[first + v] = scale * width;
      }
      continue;
    }
    const Vector3f color = hairColor(actor.spec.look.hair);
    inParts(grown.strands.size(), [&](std::size_t begin, std::size_t end) {
      std::vector<render::CurvePoint> points(static_cast<std::size_t>(std::max(points_, grown.growth.maxPoints())));
      for (std::size_t s = begin; s < end; ++s) {
        const std::size_t first = groom_.strand_first[grown.first_strand + s];
        const std::span<render::CurvePoint> own(points.data(), groom_.pointCount(grown.first_strand + s));
        if (points_ > 0) {
          grown.growth.growEven(grown.strands[s], own);
        } else {
          grown.growth.growDrawn(grown.strands[s], own);
        }
        for (std::size_t p = 0; p < own.size(); ++p) {
          groom_.points[first + p] = scale * (own[p].position + origin);
          groom_.widths[first + p] = 2 * scale * grown.growth.radius(grown.strands[s], own[p].along);
          const render::Float3 dyed = grown.growth.color(grown.strands[s], own[p].along);
          groom_.colors[first + p] = color.cwiseProduct(Vector3f(dyed[0], dyed[1], dyed[2]));
        }
      }
    });
  }
  return groom_;
}

struct HairExport::Impl {
  ExportSpec spec;
  std::optional<StrandExport> strands;
  std::optional<GroomWriter> writer;
  std::optional<GlbWriter> mesh;
  CardMesh cards;
  std::string note;
  bool numbered = false;  // a file a frame
  int moments = 0, frames = 0, first_frame = 0, last_frame = -1;
};

namespace {

// Outer faces of all hair meshes of the scene, wound outwards.
std::vector<std::uint32_t> cageTriangles(const Demo& demo) {
  std::vector<std::uint32_t> triangles;
  int before = 0;
  for (const Actor& actor : demo.actors) {
    for (const sim::ExternalFace& face : actor.haircut->mesh.external_faces) {
      for (int corner = 2; corner < face.corner_count; ++corner) {
        for (const int k : {0, corner - 1, corner}) triangles.push_back(static_cast<std::uint32_t>(before + face.v[k]));
      }
    }
    before += actor.haircut->mesh.vertexCount();
  }
  return triangles;
}

// m, as glTF has it.
std::vector<Vector3f> cageVertices(const Demo& demo) {
  std::vector<Vector3f> vertices;
  const Vector3f origin = demo.origin.cast<float>();
  for (const Actor& actor : demo.actors) {
    for (std::size_t v = 0; 3 * v + 2 < actor.shown_positions.size(); ++v) {
      const Vector3f at = Eigen::Map<const Vector3f>(&actor.shown_positions[3 * v]);
      vertices.push_back(at + origin);
    }
  }
  return vertices;
}

std::vector<Vector3f> cardVertices(const CardMesh& cards, const Demo& demo) {
  const std::vector<Vector3f> all = cageVertices(demo);
  std::vector<Vector3f> vertices;
  for (const std::uint32_t v : cards.vertices) {
    if (v < all.size()) vertices.push_back(all[v]);
  }
  return vertices;
}

// What is worn is a mesh of its own, which an export of hair leaves out.
std::string wornNote(const Demo& demo) {
  std::string names;
  for (const Actor& actor : demo.actors) {
    for (const AttachmentSpec& one : actor.spec.attachments) {
      const std::string name = stem(one.file);
      if (names.find(name) == std::string::npos) names += (names.empty() ? "" : ", ") + name;
    }
  }
  return names.empty() ? "" : "; the hair alone, without what is worn (" + names + ")";
}

// Why there are fewer strands than were asked for.
std::string fewerNote(std::size_t written, const Demo& demo) {
  std::size_t asked = 0;
  for (const Actor& actor : demo.actors) asked += static_cast<std::size_t>(actor.spec.look.strands);
  if (written >= asked) return "";
  return " (" + std::to_string(asked) + " were asked for: the others have no length, as where the hairline thins out)";
}

}  // namespace

HairExport::~HairExport() = default;

namespace {

// A .glb file holds so many moments at most; frames of the run may be left out for that. What is recorded until it is
// stopped is told when it comes so far.
void checkMoments(const ExportSpec& spec, int first, int run_end) {
  const bool until_stopped = spec.last < 0 && run_end == std::numeric_limits<int>::max();
  if (until_stopped || std::filesystem::path(spec.file).extension() != ".glb") return;
  const long end = spec.last < 0 ? run_end : std::min(run_end, spec.last + 1), span = std::max(0L, end - first);
  const auto most = static_cast<long>(kMaxGlbMoments) / spec.samples;  // frames
  if ((span + spec.every - 1) / spec.every <= most) return;
  if (most == 0)
    throw OutputError(spec.file, "a .glb file is given at most 1000 moments", "ask for fewer --export-samples");
  throw OutputError(spec.file, "a .glb file is given at most 1000 moments",
                    "leave frames out, --export-every " + std::to_string((span + most - 1) / most));
}

}  // namespace

HairExport::HairExport(const ExportSpec& spec, const Demo& demo, double fps, int begin, int end)
    : impl_(std::make_unique<Impl>()) {
  impl_->spec = spec;
  int first = std::max(spec.first, begin), taken = 0;
  while (first < end && !spec.takes(first)) ++first;
  for (int frame = first; frame < end && taken < 2; ++frame) taken += spec.takes(frame);
  ClipSettings settings{fps, first, {}, spec.unit, static_cast<int>(demo.actors.size()), spec.every};
  for (int n = 0; n < spec.samples; ++n)
    settings.offsets.push_back(n * spec.shutter / (std::max(spec.samples - 1, 1) * fps));
  const Vector3f color = hairColor(demo.actors.front().spec.look.hair);
  if (spec.what == ExportWhat::kMesh) {
    checkWritable(spec.file);
    checkMoments(spec, first, end);
    impl_->mesh.emplace(spec.file, settings, GlbMesh{"hair mesh", cageTriangles(demo), {}, color, false});
    return;
  }
  if (spec.what == ExportWhat::kCards) {
    checkWritable(spec.file);
    checkMoments(spec, first, end);
    impl_->cards = cardsOf(demo);
    impl_->note = " of " + countOf(impl_->cards.count, "card");
    impl_->mesh.emplace(spec.file, settings,
                        GlbMesh{"hair cards", impl_->cards.triangles, impl_->cards.coordinates, color, true});
    return;
  }
  int points = spec.points;
  if (points == 0 && spec.what == ExportWhat::kStrands && std::filesystem::path(spec.file).extension() == ".tfx") {
    points = nearestTfxPoints(StrandExport(demo, spec.what, 0).last());
    impl_->note =
        ", " + std::to_string(points) + " points each, the power of two nearest to those drawn (.tfx takes no other)";
  }
  impl_->strands.emplace(demo, spec.what, points);
  if (impl_->strands->last().strandCount() == 0)
    throw UsageError("there are no strands to export; ask for more than 0 --strands, or for --export-what guides");
  impl_->numbered = (taken > 1 || spec.range) && !takesClip(spec.file);
  impl_->writer.emplace(spec.file, settings, impl_->numbered);
}

void HairExport::add(const Demo& demo, int frame) {
  if (impl_->mesh) {
    const bool cards = impl_->spec.what == ExportWhat::kCards;
    impl_->mesh->add(cards ? cardVertices(impl_->cards, demo) : cageVertices(demo));
  } else {
    impl_->writer->add(impl_->strands->groom(demo, impl_->spec.unit), frame);
  }
  if (impl_->moments++ == 0) impl_->first_frame = frame;
  if (frame != impl_->last_frame) ++impl_->frames;
  impl_->last_frame = frame;
}

std::string HairExport::finish(const Demo& demo) {
  if (impl_->moments == 0) return "no frame to export; " + impl_->spec.file + " is as it was\n";
  if (impl_->mesh) impl_->mesh->finish();
  if (impl_->writer) impl_->writer->finish();
  std::string text = countOf(impl_->frames, "frame");
  if (impl_->moments > impl_->frames) text += ", " + std::to_string(impl_->moments) + " moments";
  if (impl_->strands) {
    const Groom& groom = impl_->strands->last();
    text += " of " + countOf(groom.strandCount(), "strand") + " with " + countOf(groom.points.size(), "point") +
            impl_->note;
    if (impl_->spec.what == ExportWhat::kStrands) text += fewerNote(groom.strandCount(), demo);
  }
  if (impl_->mesh) text += impl_->note;
  if (impl_->mesh && impl_->spec.unit != 1) text += ", in metres: glTF has no other unit";
  std::string file = impl_->spec.file;
  if (impl_->writer && impl_->numbered) file = numberedName(impl_->spec.file, impl_->first_frame);
  if (impl_->writer && impl_->numbered && impl_->frames > 1)
    file += " to " + numberedName(impl_->spec.file, impl_->last_frame);
  return text + ", written to " + file + wornNote(demo) + "\n";
}

void simulateAll(SkipSet& skips) {
  for (const SkipId id : {kSkipUnseen, kSkipFarSteps, kSkipFarMesh}) skips.on[id] = false;
}

}  // namespace app
