#include "tests/bench/collision_scenes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/actor.h"
#include "app/data_path.h"
#include "sim/self_contact.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

using sim::Ellipsoid;
using sim::Vec3;

constexpr double kSettle = 2;  // s

app::Actor makeDancer(const std::string& clip, sim::Style style, sim::Resolution resolution, app::Wardrobe& wardrobe) {
  app::CharacterSpec spec;
  spec.motion = app::findFile(clip, "", "clips");
  spec.style = style, spec.resolution = resolution;
  app::Actor actor = app::makeActor(spec, app::PlaybackSpec{}, wardrobe);
  app::settleActor(sim::SimParams{}, kSettle, actor);
  return actor;
}

// A figure that stands, with a body more.
struct Scene {
  app::Actor actor;
  std::vector<Ellipsoid> bodies;
  const sim::HairMesh& mesh() const { return actor.haircut->mesh; }
  Ellipsoid& guest() { return bodies.back(); }

  Scene(app::Actor a, const Ellipsoid& guest) : actor(std::move(a)), bodies(actor.ellipsoids) {
    for (Ellipsoid& e : bodies) e.velocity = e.angular_velocity = Vec3::Zero();
    bodies.push_back(guest);
  }
  sim::StepReport step(const sim::SimParams& params) {
    return sim::advance(mesh(), params, {actor.roots, bodies, 0}, params.time_step, *actor.context, actor.hair);
  }
  double deepest() const {
    double depth = 0;
    for (const int v : mesh().external_vertices)
      depth = std::max(depth, -sim::closestPoint(bodies.back(), actor.hair.positions[v]).distance);
    return depth;
  }
  double kineticEnergy(const sim::SimParams& params) const {
    double energy = 0;
    for (int v = 0; v < mesh().vertexCount(); ++v)
      energy += 0.5 * params.density * mesh().vertex_volume[v] * actor.hair.velocities[v].squaredNorm();
    return energy;
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

int insideForeign(const sim::HairMesh& mesh, const sim::SimParams& params, const sim::HairState& state) {
  sim::SelfContact self(mesh);
  sim::HairState copy = state;
  return sim::resolveSelfContacts(mesh, params, params.time_step, self, copy);
}

}  // namespace

void writeSpawns(std::FILE* out) {
  std::fprintf(
      out,
      "| style | speed allowed, m/s | deepest at first, mm | out after, s | fastest vertex, m/s | kinetic energy, "
      "most, mJ | two seconds later, mJ | recoveries |\n|---|---|---|---|---|---|---|---|\n");
  app::Wardrobe wardrobe;
  for (const sim::Style style : {sim::Style::kShoulder, sim::Style::kLong}) {
    for (const double speed : {0.2, 0.5, 1.0, 2.0}) {
      sim::SimParams params;
      params.max_depenetration = speed;
      app::Actor actor = makeDancer("idle_turns.bvh", style, sim::Resolution::kMedium, wardrobe);
      Ellipsoid ball;
      const HangingHair hair(actor);
      ball.center = 0.5 * (hair.low + hair.high);
      ball.center.z() = hair.low.z() + 0.02;
      ball.radii = Vec3::Constant(0.05);
      Scene scene(std::move(actor), ball);
      const double at_first = scene.deepest();
      double fastest = 0, most = 0;
      int steps = 0, recoveries = 0;
      const auto step = [&] {
        recoveries += scene.step(params).recoveries;
        for (const Vec3& v : scene.actor.hair.velocities) fastest = std::max(fastest, v.norm());
        most = std::max(most, scene.kineticEnergy(params));
      };
      for (; steps < 600 && (steps == 0 || scene.deepest() > 1e-4); ++steps) step();
      for (int n = 0; n < 120; ++n) step();
      std::fprintf(out, "| %s medium | %.1f | %.1f | %.2f | %.2f | %.2f | %.4f | %d |\n",
                   std::string(sim::styleName(style)).c_str(), speed, 1e3 * at_first, steps * params.time_step, fastest,
                   1e3 * most, 1e3 * scene.kineticEnergy(params), recoveries);
    }
  }
}

void writeCrossings(std::FILE* out) {
  std::fprintf(out,
               "| style | direction | speed, m/s | turning, rad/s | way a step, mm | vertices met | passed through | "
               "inside afterwards, mm | recoveries |\n|---|---|---|---|---|---|---|---|---|\n");
  app::Wardrobe wardrobe;
  const Vec3 thin(0.012, 0.06, 0.12);
  for (const sim::Style style : {sim::Style::kShoulder, sim::Style::kLong}) {
    for (const double side : {-1.0, 1.0}) {  // from the right, from the left
      for (const double speed : {4.0, 8.0, 16.0, 32.0}) {
        for (const double spin : {0.0, 10.0}) {
          const sim::SimParams params;
          app::Actor actor = makeDancer("idle_turns.bvh", style, sim::Resolution::kMedium, wardrobe);
          Ellipsoid arm;
          const double way = speed * params.time_step;
          const HangingHair hair(actor);
          arm.center = 0.5 * (hair.low + hair.high);
          arm.center.x() = side < 0 ? hair.low.x() - 0.03 : hair.high.x() + 0.03;
          arm.center.z() = hair.low.z() + 0.03;
          arm.radii = thin;
          Scene scene(std::move(actor), arm);
          const auto before = scene.actor.hair.positions;
          const Ellipsoid start = scene.guest();
          Ellipsoid& guest = scene.guest();
          guest.velocity = Vec3(-side * speed, 0, 0);
          guest.angular_velocity = Vec3(0, spin, 0);
          guest.center += params.time_step * guest.velocity;
          guest.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(spin * params.time_step, Vec3::UnitY()));
          const int recoveries = scene.step(params).recoveries;
          int met = 0, passed = 0;
          const auto local = [](const Ellipsoid& e, const Vec3& p) {
            return Vec3(e.rotation.conjugate() * (p - e.center));
          };
          for (const int v : scene.mesh().external_vertices) {
            const Vec3 a = local(start, before[v]), untouched = local(guest, before[v]);
            if (a.x() * untouched.x() > 0 || (0.5 * (a + untouched)).cwiseQuotient(thin).tail<2>().norm() > 0.8)
              continue;
            ++met;
            passed += a.x() * local(guest, scene.actor.hair.positions[v]).x() < 0;
          }
          std::fprintf(out, "| %s medium | %s | %.0f | %.0f | %.0f | %d | %d | %.3f | %d |\n",
                       std::string(sim::styleName(style)).c_str(), side < 0 ? "from the right" : "from the left", speed,
                       spin, 1e3 * way, met, passed, 1e3 * scene.deepest(), recoveries);
        }
      }
    }
  }
}

void writeSelfContacts(int frames, std::FILE* out) {
  std::fprintf(out,
               "| style | clip | ms a step, off | on | on, against off | vertices inside foreign bundles, off | on | "
               "most, off | on | recoveries |\n|---|---|---|---|---|---|---|---|---|---|\n");
  app::Wardrobe wardrobe;
  for (const sim::Style style : {sim::Style::kShort, sim::Style::kShoulder, sim::Style::kLong}) {
    for (const char* clip : {"walk.bvh", "jump_spin.bvh"}) {
      double milliseconds[2], mean[2];
      int most[2] = {0, 0}, recoveries = 0;
      for (const bool on : {false, true}) {
        sim::SimParams params;
        params.self_collide = on;
        app::Actor actor = makeDancer(clip, style, sim::Resolution::kMedium, wardrobe);
        std::vector<double> times;
        long sum = 0;
        for (int frame = 0; frame < frames; ++frame) {
          app::moveActor(params.time_step, actor);
          const double started = cpuSeconds();
          recoveries += app::simulateActor(params, params.time_step, frame * params.time_step, actor).recoveries;
          times.push_back(cpuSeconds() - started);
          const int inside = insideForeign(actor.haircut->mesh, params, actor.hair);
          sum += inside;
          most[on] = std::max(most[on], inside);
        }
        milliseconds[on] = 1e3 * medianOf(times);
        mean[on] = static_cast<double>(sum) / frames;
      }
      std::fprintf(out, "| %s medium | %s | %.3f | %.3f | %+.1f %% | %.2f | %.2f | %d | %d | %d |\n",
                   std::string(sim::styleName(style)).c_str(), clip, milliseconds[0], milliseconds[1],
                   100 * (milliseconds[1] / milliseconds[0] - 1), mean[0], mean[1], most[0], most[1], recoveries);
    }
  }
}

}  // namespace bench
