// Hair at rest on the body: it hangs still.
#include <gtest/gtest.h>

#include <cmath>

#include "app/files/data_path.h"
#include "app/scene/actor.h"

namespace rest_test {

// Root mean square and largest vertex speed, m/s, over the last of `seconds` of standing still, all of the hair having
// been thrown sideways at `thrown` m/s.
std::pair<double, double> restSpeed(app::Style style, app::Resolution resolution, double seconds,
                                    const sim::SimParams& params = {}, double thrown = 0) {
  app::CharacterSpec spec;
  spec.motion = app::findFile("idle_turns.bvh", "", "clips");
  spec.style = style, spec.resolution = resolution;
  app::AssetCache asset_cache;
  app::Actor actor = app::makeActor(spec, app::PlaybackSpec{}, asset_cache);
  app::settleActor({}, 1, actor);
  for (int i = 0; i < actor.haircut->mesh.vertexCount(); ++i) {
    if (!actor.haircut->mesh.isRoot(i)) actor.hair.velocities[i].x() += thrown;
  }
  const int steps = static_cast<int>(seconds / params.time_step), last = static_cast<int>(1 / params.time_step);
  double sum = 0, most = 0;
  for (int step = 0; step < steps; ++step) {
    app::simulateActor(params, params.time_step, 0, actor);
    if (step < steps - last) continue;
    for (const sim::Vec3& v : actor.hair.velocities) sum += v.squaredNorm(), most = std::max(most, v.norm());
  }
  EXPECT_FALSE(actor.hair.contacts.empty()) << "it does rest on the body";
  return {std::sqrt(sum / (last * static_cast<double>(actor.hair.velocities.size()))), most};
}

// The vertices of the short style are so light that friction against the slip of the step before would throw them to
// and fro without end: 10 mm/s.
TEST(Rest, HairThatLiesOnTheBodyHangsStill) {
  struct Case {
    app::Style style;
    app::Resolution resolution;
  };
  for (const Case& c :
       {Case{app::Style::kLong, app::Resolution::kMedium}, Case{app::Style::kShort, app::Resolution::kHigh}}) {
    const auto [rms, most] = restSpeed(c.style, c.resolution, 2);
    std::printf("%s %s: %.4f mm/s RMS, %.3f largest\n", app::styleName(c.style).data(),
                app::resolutionName(c.resolution).data(), 1e3 * rms, 1e3 * most);
    EXPECT_LT(rms, 1e-3);
    EXPECT_LT(most, 1e-2);
  }
}

// One displacement that a solve may be off by, whatever the step, let short ones pass over half a metre per second
// squared: hair went on at 0.1 m/s for good.
TEST(Rest, HairComesToRestInShortStepsToo) {
  for (const sim::Integrator integrator : {sim::Integrator::kLinearizedEuler, sim::Integrator::kBdf2}) {
    for (const double step : {1.0 / 120, 1.0 / 480}) {
      sim::SimParams params;
      params.integrator = integrator;
      params.time_step = step;
      const auto [rms, most] = restSpeed(app::Style::kLong, app::Resolution::kLow, 4, params, 1);
      std::printf("integrator %d, 1/%.0f s: %.4f mm/s RMS, %.3f largest\n", static_cast<int>(integrator), 1 / step,
                  1e3 * rms, 1e3 * most);
      EXPECT_LT(rms, 5e-3);
      EXPECT_LT(most, 3e-2);
    }
  }
}

}  // namespace rest_test
