#include "app/scene/attachments.h"

#include <algorithm>
#include <cmath>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/groom/edit/mesh_edit.h"
#include "app/scene/haircuts.h"
#include "app/styles/style_untangle.h"

namespace app {

namespace {

constexpr double kOverHead = 0.10;                        // m off the scalp, within which an attachment lies over it
constexpr double kUnderside = 0.0045, kMinRoom = 0.0035;  // m that hair keeps off the inside; least room over the scalp
constexpr double kInside = 0.002, kDeep = 0.004;          // m, of roots and of other vertices in the solid
constexpr double kMaxEnclosed = 0.25;                     // of the hair, in the solid
constexpr double kLaidFatness = 0.04, kLaidGap = 0.002;   // see untangle; m
constexpr int kLaidRounds = 6;                            // of untangling
constexpr int kRays = 400;
constexpr int kTurns = 72, kPolars = 90;          // of directions in which a ring is looked for
constexpr double kCrown = 0.2, kDown = 2.1;       // rad from upright, between which a ring lies; a collar is lower
constexpr double kPassesOver = 0.03;              // m off the scalp: hair that lies over a ring
constexpr std::size_t kPieces = 8;                // of a segment, that are looked at one by one
constexpr double kRise = 0.3;                     // m a m: how steeply hair comes out from under a ring
constexpr double kPressed = 0.03, kHeld = 0.015;  // m off a ring, within which it presses hair, holds hair

double distanceTo(const Attachment& attachment, const Vec3& p) {
  return attachment.part.grid.interpolate(attachment.to_scalp.inverse(Eigen::Isometry) * p);
}

[[noreturn]] void refuseWorn(const Attachment& attachment, const std::string& fault, const char* mend) {
  throw InputError(attachment.key.substr(0, attachment.key.find('|')), "", fault, mend);
}

// Whether it surrounds the head: rays evenly over the sphere (Fibonacci's spiral) all meet it.
bool surrounds(const Attachment& attachment, const Scalp& scalp) {
  for (int k = 0; k < kRays; ++k) {
    const double y = 1 - 2 * (k + 0.5) / kRays, ring = std::sqrt(1 - y * y), turn = 2.399963229728653 * k;
    const Vec3 along(ring * std::sin(turn), y, ring * std::cos(turn));
    if (std::isinf(meetsAlong(attachment, scalp, along, 3 * kOverHead))) return false;
  }
  return true;
}

void checkRoom(const Attachment& attachment, const Scalp& scalp, const sim::HairMeshShape& shape) {
  int roots = 0;
  for (const int root : shape.column_first) {
    if (root >= static_cast<int>(shape.positions.size())) break;
    roots += distanceTo(attachment, shape.positions[static_cast<std::size_t>(root)]) < -kInside;
  }
  if (roots > 0)
    refuseWorn(
        attachment,
        "encloses " + std::to_string(roots) + " of the head's " + std::to_string(shape.columnCount()) + " hair roots",
        "make it hollow or larger, or move it off the head in its file (or by \"at\": [0, 0.03, 0], m from the joint, "
        "y up)");
  if (surrounds(attachment, scalp))
    refuseWorn(attachment, "encloses the whole head", "leave it open where hair and neck come out");
}

void checkHair(const Attachment& attachment, const sim::HairMeshShape& shape) {
  const auto in =
      std::ranges::count_if(shape.positions, [&](const Vec3& p) { return distanceTo(attachment, p) < -kDeep; });
  if (static_cast<double>(in) > kMaxEnclosed * static_cast<double>(shape.positions.size()))
    refuseWorn(attachment,
               "encloses the hair: " + std::to_string(in) + " of its " + std::to_string(shape.positions.size()) +
                   " vertices lie in it",
               "make it smaller, or move it out of the hair in its file (or by \"at\")");
}

// Whether it goes round the head and leaves the crown open, as a headband does.
bool isRing(const Attachment& attachment, const Scalp& scalp) {
  const auto meets = [&](double turn, double polar) {
    const Vec3 along(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn));
    return !std::isinf(meetsAlong(attachment, scalp, along, kOverHead));
  };
  for (int t = 0; t < kTurns; ++t) {
    const double turn = 2 * EIGEN_PI * t / kTurns;
    double polar = 0;
    while (polar < kDown && !meets(turn, polar)) polar += kDown / kPolars;
    if (polar < kCrown || polar >= kDown) return false;
  }
  return true;
}

// A place of a strand under a ring.
struct UnderRing {
  Vec3 at;
  double room;  // m over the scalp
};

// Where a column passes under a ring, as the curve that strands take.
std::vector<UnderRing> passesUnder(const Attachment& ring, const Scalp& scalp, std::span<const Vec3> column) {
  std::vector<UnderRing> under;
  for (std::size_t k = 0; k + kPieces < kPieces * column.size(); ++k) {
    const Vec3 at = onColumn(column, static_cast<double>(k) / kPieces);
    const Vec3 out = at - scalp.center;
    const double floor = scalp.radiusAt(out);
    if (out.norm() > floor + kPassesOver) continue;
    const double meets = meetsAlong(ring, scalp, out, kOverHead);
    if (!std::isinf(meets)) under.push_back({at, std::max(kMinRoom, meets - kUnderside - floor)});
  }
  return under;
}

// The vertices that a ring holds, moved to lie under it; hair before and behind rises to where it was. Of tied hair
// what comes before the tie.
std::vector<int> layUnderRing(const Attachment& ring, const Scalp& scalp, std::span<const int> tied,
                              sim::HairMeshShape& shape) {
  std::vector<int> held;
  for (int c = 0; c < shape.columnCount(); ++c) {
    const int first = shape.column_first[static_cast<std::size_t>(c)];
    const auto tie = std::ranges::find_if(tied, [&](int v) { return v >= first && v < first + shape.columnLength(c); });
    const int end = tie == tied.end() ? first + shape.columnLength(c) : *tie;
    const std::span column(shape.positions.data() + first, static_cast<std::size_t>(end - first));
    const std::vector<UnderRing> passes = passesUnder(ring, scalp, column);
    for (std::size_t v = 1; v < column.size(); ++v) {
      double room = INFINITY, apart = INFINITY;
      for (const UnderRing& pass : passes) {
        const double way = (column[v] - pass.at).norm();
        apart = std::min(apart, way);
        if (way < kPressed) room = std::min(room, pass.room + kRise * way);
      }
      if (std::isinf(room)) continue;
      const Vec3 out = column[v] - scalp.center;
      const double floor = scalp.radiusAt(out), height = std::max(0.0, out.norm() - floor);
      column[v] = scalp.center + (floor + room * (1 - std::exp(-height / room))) / out.norm() * out;
      if (apart < kHeld) held.push_back(first + static_cast<int>(v));
    }
  }
  return held;
}

// The vertices under one attachment, moved to lie there.
std::vector<int> layUnderOne(const Attachment& attachment, const Scalp& scalp, sim::HairMeshShape& shape) {
  std::vector<int> under;
  for (int c = 0; c < shape.columnCount(); ++c) {
    const int first = shape.column_first[static_cast<std::size_t>(c)];
    const Vec3 root = shape.positions[static_cast<std::size_t>(first)] - scalp.center;
    if (std::isinf(meetsAlong(attachment, scalp, root, kOverHead))) continue;
    for (int v = first + 1; v < first + shape.columnLength(c); ++v) {
      Vec3& p = shape.positions[static_cast<std::size_t>(v)];
      const Vec3 out = p - scalp.center;
      const double meets = meetsAlong(attachment, scalp, out, kOverHead);
      if (std::isinf(meets)) break;  // it has come out
      const double floor = scalp.radiusAt(out), room = std::max(kMinRoom, meets - kUnderside - floor);
      const double height = std::max(0.0, out.norm() - floor);
      p = scalp.center + (floor + room * (1 - std::exp(-height / room))) / out.norm() * out;
      under.push_back(v);
    }
  }
  return under;
}

}  // namespace

std::vector<const Attachment*> attach(const CharacterSpec& spec, const LoadedBody& body, AssetCache& asset_cache) {
  std::vector<const Attachment*> worn;
  for (const AttachmentSpec& one : spec.attachments) {
    const std::string key = one.file + "|" + body.key + wornText({one});
    auto& cached = asset_cache.attachments;
    auto found = std::ranges::find_if(cached, [&](const auto& entry) { return entry->key == key; });
    if (found == cached.end()) {
      auto fresh = std::make_unique<Attachment>(loadAttachment(one, body.character));
      fresh->key = key;
      fresh->id = freshId();
      cached.push_back(std::move(fresh));
      found = cached.end() - 1;
    }
    worn.push_back(found->get());
  }
  return worn;
}

std::vector<int> layUnder(std::span<const Attachment* const> attachments, const Scalp& scalp, const BodyDistance& body,
                          std::span<const int> tied, sim::HairMeshShape& shape) {
  std::vector<int> under;
  for (const Attachment* attachment : attachments) {
    checkRoom(*attachment, scalp, shape);
    const std::vector<int> more = isRing(*attachment, scalp) ? layUnderRing(*attachment, scalp, tied, shape)
                                                             : layUnderOne(*attachment, scalp, shape);
    under.insert(under.end(), more.begin(), more.end());
  }
  if (!under.empty()) {
    std::ranges::sort(under);
    under.erase(std::unique(under.begin(), under.end()), under.end());
    const auto around = [&](const Vec3& p) {
      double nearest = body(p);
      for (const Attachment* attachment : attachments) nearest = std::min(nearest, distanceTo(*attachment, p));
      return nearest;
    };
    for (int round = 0; round < kLaidRounds && untangle(around, kLaidFatness, kLaidGap, shape) < kLaidFatness / 2;
         ++round) {
    }
  }
  for (const Attachment* attachment : attachments) checkHair(*attachment, shape);
  return under;
}

void poseAttachments(double dt, Actor& actor) {
  actor.worn_distances.clear();
  for (const WornAttachment& worn : actor.worn)
    posePartDistance(worn.mesh->part, actor.pose, actor.previous_pose, dt, actor.worn_distances.emplace_back());
}

bool showAttachments(const Vec3& origin, Actor& actor) {
  bool changed = false;
  for (WornAttachment& worn : actor.worn) {
    Eigen::Affine3d carried = actor.shown_pose.world[static_cast<std::size_t>(worn.mesh->part.joint)] * worn.dragged;
    carried.translation() -= origin;
    const Eigen::Matrix4f m = carried.matrix().cast<float>();
    changed = changed || !std::equal(m.data(), m.data() + 16, worn.matrix.begin());
    std::copy(m.data(), m.data() + 16, worn.matrix.begin());
  }
  return changed;
}

void drawDragged(const std::string& text, Actor& actor) {
  const std::vector<AttachmentSpec> specs = attachmentsFromText(text);
  const std::size_t count = std::min({specs.size(), actor.worn.size(), actor.spec.attachments.size()});
  for (std::size_t k = 0; k < count; ++k) {
    const AttachmentSpec &to = specs[k], &from = actor.spec.attachments[k];
    if (to.file != from.file) continue;
    const Attachment& mesh = *actor.worn[k].mesh;
    const Vec3 at = to.at.isZero() ? mesh.at : to.at, turn = to.turn.isZero() ? mesh.turn : to.turn;
    const Eigen::Matrix3d upright = mesh.to_scalp.linear();  // from the joint's axes
    const Eigen::Matrix3d turned = to.size / from.size * (turnOf(turn) * turnOf(mesh.turn).transpose());
    Eigen::Affine3d dragged = Eigen::Affine3d::Identity();
    dragged.linear() = upright.transpose() * turned * upright;
    dragged.translation() = upright.transpose() * (at - turned * mesh.at);
    actor.worn[k].dragged = dragged;
  }
  actor.shown_still = false;
}

bool drawInPlace(Actor& actor) {
  const auto at_place = [](const WornAttachment& worn) { return worn.dragged.matrix().isIdentity(0); };
  if (std::ranges::all_of(actor.worn, at_place)) return false;
  for (WornAttachment& worn : actor.worn) worn.dragged = Eigen::Affine3d::Identity();
  actor.shown_still = false;
  return true;
}

std::array<float, 3> wornColor(const Actor& actor, std::size_t k) {
  constexpr std::array kPlain{0.10f, 0.16f, 0.24f};  // of a file without a material
  if (k >= std::min(actor.worn.size(), actor.spec.attachments.size())) return kPlain;
  return actor.spec.attachments[k].color.value_or(actor.worn[k].mesh->color.value_or(kPlain));
}

namespace {

// Of what nowhere comes near the body at rest; empty for the rest.
std::string hangNote(const Attachment& attachment, const Actor& actor) {
  constexpr double kHangs = 0.02;  // m
  double least = INFINITY;
  for (const Eigen::Vector3f& p : attachment.positions) {
    least = std::min(least, actor.body->distance(attachment.to_scalp * p.cast<double>()));
    if (least < kHangs) return "";
  }
  return stem(attachment.key.substr(0, attachment.key.find('|'))) + " hangs " +
         std::to_string(std::lround(1000 * least)) + " mm off the body; move it there (Place, or \"at\")";
}

}  // namespace

std::string attachmentNotes(const Actor& actor) {
  std::vector<std::string> lines;
  for (const WornAttachment& worn : actor.worn) {
    for (const std::string& note : {worn.mesh->note, hangNote(*worn.mesh, actor)})
      if (!note.empty()) lines.push_back(note);
    const auto same = [&](const WornAttachment& other) { return other.mesh == worn.mesh; };
    const std::string file = worn.mesh->key.substr(0, worn.mesh->key.find('|'));
    if (const auto times = std::ranges::count_if(actor.worn, same); times > 1)
      lines.push_back(stem(file) + " is worn " + std::to_string(times) + " times in one place; take the others off");
  }
  std::string notes;
  for (auto line = lines.begin(); line != lines.end(); ++line) {
    if (std::find(lines.begin(), line, *line) == line) notes += (notes.empty() ? "" : "\n") + *line;
  }
  return notes;
}

}  // namespace app
