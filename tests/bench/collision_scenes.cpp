#include "tests/bench/collision_scenes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/files/data_path.h"
#include "sim/contact/self_contact.h"
#include "tests/bench/collisions.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/scene_times.h"
#include "tests/sim_probes.h"

namespace bench {
namespace {

using sim::Ellipsoid;
using sim::Vec3;

app::Actor settledDancer(const std::string& clip, app::Style style, app::AssetCache& asset_cache) {
  app::Actor actor = makeDancer(clip, style, app::Resolution::kMedium, asset_cache);
  app::settleActor(sim::SimParams{}, kSettle, actor);
  return actor;
}

// A figure that stands, with a body more; its hair begins as the figure's.
struct Scene {
  const app::Actor& actor;
  sim::HairState hair;
  sim::StepContext context;
  std::vector<Ellipsoid> bodies;
  const sim::HairMesh& mesh() const { return actor.haircut->mesh; }
  Ellipsoid& guest() { return bodies.back(); }

  Scene(const app::Actor& a, const Ellipsoid& guest)
      : actor(a), hair(a.hair), context(a.haircut->mesh), bodies(a.ellipsoids) {
    for (Ellipsoid& e : bodies) e.velocity = e.angular_velocity = Vec3::Zero();
    bodies.push_back(guest);
  }
  sim::StepReport step(const sim::SimParams& params) {
    return sim::advance(mesh(), params, {actor.roots, bodies, 0}, params.time_step, context, hair);
  }
  double deepest() const {
    double depth = 0;
    for (const int v : mesh().external_vertices)
      depth = std::max(depth, -sim::closestPoint(bodies.back(), hair.positions[v]).distance);
    return depth;
  }
  double kineticEnergy(const sim::SimParams& params) const {
    double energy = 0;
    for (int v = 0; v < mesh().vertexCount(); ++v)
      energy += 0.5 * params.density * mesh().vertex_volume[v] * hair.velocities[v].squaredNorm();
    return energy;
  }
  // Whether the figure itself leaves p no room.
  bool hemmedIn(const Vec3& p, double offset) const {
    return std::any_of(bodies.begin(), bodies.end() - 1,
                       [&](const Ellipsoid& e) { return sim::closestPoint(e, p).distance < offset; });
  }
};

// The hair's box half way down.
struct HangingHair {
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  explicit HangingHair(const app::Actor& actor) {
    double bottom = INFINITY, top = -INFINITY;
    for (const Vec3& p : actor.hair.positions) bottom = std::min(bottom, p.y()), top = std::max(top, p.y());
    for (const Vec3& p : actor.hair.positions) {
      if (std::abs(p.y() - 0.5 * (bottom + top)) > 0.1 * (top - bottom)) continue;
      low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
  }
};

// What became of the vertices that a flat arm met on its way through the hair within one step.
struct Crossing {
  int met = 0;     // on its flat side, where the figure leaves them room before it on all of its way
  int slid = 0;    // of those: over the arm's rim to the other side
  int passed = 0;  // of those: to the other side otherwise
  double inside = 0;
  int recoveries = 0;
};

Crossing cross(const app::Actor& still, double side, double speed, double spin) {
  const Vec3 radii(0.012, 0.09, 0.09);
  constexpr double kFlat = 0.7, kRim = 0.9;  // of the radii
  const sim::SimParams params;
  const HangingHair hair(still);
  Ellipsoid arm;
  arm.center = 0.5 * (hair.low + hair.high);
  arm.center.x() = side < 0 ? hair.low.x() - 0.03 : hair.high.x() + 0.03;
  arm.center.z() = hair.low.z();
  arm.radii = radii;
  Scene scene(still, arm);
  const auto before = scene.hair.positions;
  Ellipsoid& guest = scene.guest();
  guest.velocity = Vec3(-side * speed, 0, 0);
  guest.angular_velocity = Vec3(0, spin, 0);
  guest.center += params.time_step * guest.velocity;
  guest.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(spin * params.time_step, Vec3::UnitY()));
  Crossing result;
  result.recoveries = scene.step(params).recoveries;
  result.inside = scene.deepest();
  const auto local = [](const Ellipsoid& e, const Vec3& p) { return Vec3(e.rotation.conjugate() * (p - e.center)); };
  const auto share = [&](const Vec3& p) { return p.cwiseQuotient(radii).tail<2>().norm(); };
  // Whether the figure leaves no room for what the arm pushes before it, anywhere on the rest of its way.
  const auto inTheWay = [&](const Vec3& at, double from) {
    constexpr int kLooks = 64;
    for (int k = 0; k <= kLooks; ++k) {
      const double t = from + (1 - from) * k / kLooks;
      const Vec3 center = arm.center + t * (guest.center - arm.center);
      const Eigen::Quaterniond turn = arm.rotation.slerp(t, guest.rotation);
      if (scene.hemmedIn(center + turn * at, params.contact_offset)) return true;
    }
    return false;
  };
  for (const int v : scene.mesh().external_vertices) {
    const Vec3 a = local(arm, before[v]), untouched = local(guest, before[v]);
    if (a.x() * untouched.x() > 0) continue;
    const double when = a.x() / (a.x() - untouched.x());
    Vec3 at = a + when * (untouched - a);  // where it came to the arm's middle plane
    if (share(at) > kFlat) continue;
    at.x() = std::copysign(radii.x() + params.contact_offset, a.x());
    if (inTheWay(at, when)) continue;
    ++result.met;
    const Vec3 now = local(guest, scene.hair.positions[v]);
    if (a.x() * now.x() >= 0) continue;
    ++(share(now) > kRim ? result.slid : result.passed);
  }
  return result;
}

int insideForeign(const sim::HairMesh& mesh, const sim::SimParams& params, const sim::HairState& state) {
  sim::SelfContact self(mesh);
  sim::HairState copy = state;
  return sim::resolveSelfContacts({mesh, params, {}, params.time_step}, self, copy);
}

}  // namespace

void writeSpawns(std::FILE* out) {
  std::fprintf(
      out,
      "| style | speed allowed, m/s | deepest at first, mm | out after, s | fastest vertex, m/s | kinetic energy, "
      "most, mJ | total energy, before, mJ | when out | most afterwards | two seconds later | recoveries |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  app::AssetCache asset_cache;
  for (const app::Style style : {app::Style::kShoulder, app::Style::kLong}) {
    const app::Actor actor = settledDancer("idle_turns.bvh", style, asset_cache);
    for (const double speed : {0.2, 0.5, 1.0, 2.0}) {
      sim::SimParams params;
      params.max_depenetration = speed;
      Ellipsoid ball;
      const HangingHair hair(actor);
      ball.center = 0.5 * (hair.low + hair.high);
      ball.center.z() = hair.low.z() + 0.02;
      ball.radii = Vec3::Constant(0.05);
      Scene scene(actor, ball);
      const auto energy = [&] { return test::mechanicalEnergy(scene.mesh(), params, scene.context, scene.hair); };
      const double at_first = scene.deepest(), before = energy();
      double fastest = 0, most = 0, highest = -INFINITY;
      int steps = 0, recoveries = 0;
      const auto step = [&] {
        recoveries += scene.step(params).recoveries;
        for (const Vec3& v : scene.hair.velocities) fastest = std::max(fastest, v.norm());
        most = std::max(most, scene.kineticEnergy(params));
      };
      for (; steps < 600 && (steps == 0 || scene.deepest() > 1e-4); ++steps) step();
      const double when_out = energy();
      for (int n = 0; n < 120; ++n) {
        step();
        highest = std::max(highest, energy());
      }
      std::fprintf(out, "| %s medium | %.1f | %.1f | %.2f | %.2f | %.2f | 0 | %+.2f | %+.2f | %+.2f | %d |\n",
                   std::string(app::styleName(style)).c_str(), speed, 1e3 * at_first, steps * params.time_step, fastest,
                   1e3 * most, 1e3 * (when_out - before), 1e3 * (highest - before), 1e3 * (energy() - before),
                   recoveries);
    }
  }
}

void writeCrossings(std::FILE* out) {
  std::fprintf(
      out,
      "| style | direction | speed, m/s | turning, rad/s | way a step, mm | vertices met | slid over the rim | "
      "passed through | inside afterwards, mm | recoveries |\n|---|---|---|---|---|---|---|---|---|---|\n");
  app::AssetCache asset_cache;
  for (const app::Style style : {app::Style::kShoulder, app::Style::kLong}) {
    const app::Actor actor = settledDancer("idle_turns.bvh", style, asset_cache);
    for (const double side : {-1.0, 1.0}) {  // from the right, from the left
      for (const double speed : {5.0, 10.0, 20.0, 40.0}) {
        for (const double spin : {0.0, 10.0}) {
          const Crossing crossing = cross(actor, side, speed, spin);
          std::fprintf(out, "| %s medium | %s | %.0f | %.0f | %.0f | %d | %d | %d | %.3f | %d |\n",
                       std::string(app::styleName(style)).c_str(), side < 0 ? "from the right" : "from the left", speed,
                       spin, 1e3 * speed * sim::SimParams{}.time_step, crossing.met, crossing.slid, crossing.passed,
                       1e3 * crossing.inside, crossing.recoveries);
        }
      }
    }
  }
}

void writeSelfContacts(int frames, std::FILE* out) {
  std::fprintf(
      out,
      "| style | clip | ms a step, off | ms a step, on | on, against off | vertices inside foreign bundles, off "
      "| vertices inside foreign bundles, on | most, off | most, on | recoveries "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  app::AssetCache asset_cache;
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
    for (const char* clip : {"walk.bvh", "jump_spin.bvh"}) {
      // Both go side by side, frame by frame, so that whatever else the machine does falls on both.
      app::Actor actors[2] = {settledDancer(clip, style, asset_cache), settledDancer(clip, style, asset_cache)};
      std::vector<double> times[2];
      long sum[2] = {0, 0};
      int most[2] = {0, 0}, recoveries = 0;
      for (int frame = 0; frame < frames; ++frame) {
        for (const bool on : {false, true}) {
          sim::SimParams params;
          params.self_collide = on;
          app::Actor& actor = actors[on];
          app::moveActor(params.time_step, actor);
          const double started = cpuSeconds();
          recoveries += app::simulateActor(params, params.time_step, frame * params.time_step, actor).recoveries;
          times[on].push_back(cpuSeconds() - started);
          const int inside = insideForeign(actor.haircut->mesh, params, actor.hair);
          sum[on] += inside;
          most[on] = std::max(most[on], inside);
        }
      }
      const double milliseconds[2] = {1e3 * medianOf(times[0]), 1e3 * medianOf(times[1])};
      const double mean[2] = {static_cast<double>(sum[0]) / frames, static_cast<double>(sum[1]) / frames};
      std::fprintf(out, "| %s medium | %s | %.3f | %.3f | %+.1f %% | %.2f | %.2f | %d | %d | %d |\n",
                   std::string(app::styleName(style)).c_str(), clip, milliseconds[0], milliseconds[1],
                   100 * (milliseconds[1] / milliseconds[0] - 1), mean[0], mean[1], most[0], most[1], recoveries);
    }
  }
}

}  // namespace bench
