// Laws of the light on hair: a fibre gives no more than it gets, and a lock sends back and on what a random walk says.
// The shaders' own functions are evaluated, by transform feedback.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <vector>

#include "render/gl/render_target.h"
#include "render/gl/shader.h"
#include "render/hair/hair_store.h"
#include "shaders/shared.h"
#include "tests/gl_fixture.h"
#include "tests/slab_walk.h"
#include "tests/synthetic_hair.h"

namespace light_test {

using render::HairLook;

constexpr const char* kIncludes = R"(#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/shadow.glsl"
#include "common/hair_shading.glsl"
layout(location = 0) uniform float parameter;
out vec4 result;
)";

// parameter 0: radiance of one fibre under even light of one, seen at inclinations of -85 to 85 degrees, a degree a
// vertex. Above: share of a beam of that inclination that it sends on. Midpoints of the table's azimuths are exact.
constexpr const char* kFurnace = R"(
const int kInclinations = 256, kAzimuths = kScatterPhi - 1;
void main() {
  float theta = radians(float(gl_VertexID) - 85.0);
  vec3 tangent = vec3(1.0, 0.0, 0.0), fixed_side = vec3(sin(theta), cos(theta), 0.0);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < kInclinations; ++i) {
    float t = kPi * ((float(i) + 0.5) / float(kInclinations) - 0.5);
    for (int j = 0; j < kAzimuths; ++j) {
      float phi = kPi * (float(j) + 0.5) / float(kAzimuths);
      vec3 other = vec3(sin(t), cos(t) * cos(phi), cos(t) * sin(phi));
      float weight = 2.0 * kPi / float(kInclinations) * kPi / float(kAzimuths) * cos(t);
      if (parameter > 0.0)
        sum += weight * cos(t) / cos(theta) * scatterLight(scatterGeometry(eyeSide(tangent, other, 1.0), fixed_side), vec2(0.0), vec3(1.0));
      else
        sum += weight * scatterLight(scatterGeometry(eyeSide(tangent, fixed_side, 1.0), other), vec2(0.0), vec3(1.0));
    }
  }
  result = vec4(sum, 1.0);
}
)";

// Light that fibres of a slab of thickness `parameter` send towards an azimuth of flight, over all inclinations: depths
// times azimuths vertices.
constexpr int kDepths = 64, kAzimuths = 32;
constexpr const char* kSlab = R"(
const int kDepths = 64, kAzimuths = 32, kInclinations = 64;
void main() {
  float x = (float(gl_VertexID / kAzimuths) + 0.5) / float(kDepths), psi = kPi * (float(gl_VertexID % kAzimuths) + 0.5) / float(kAzimuths);
  float depth = parameter * x * x * (3.0 - 2.0 * x);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < kInclinations; ++i) {
    float t = kPi * ((float(i) + 0.5) / float(kInclinations) - 0.5);
    vec3 to_eye = vec3(sin(t), -cos(t) * cos(psi), cos(t) * sin(psi));
    Geometry g = scatterGeometry(eyeSide(vec3(1.0, 0.0, 0.0), to_eye, 1.0), vec3(0.0, 1.0, 0.0));
    sum += kPi / float(kInclinations) * cos(t) * cos(t) * scatterLight(g, vec2(depth, parameter - depth), vec3(1.0));
  }
  result = vec4(sum, 1.0);
}
)";

class LightTest : public gl_fixture::GlTest {
 protected:
  using Values = std::vector<std::array<float, 4>>;

  // What the probe gives for a look, a vertex each.
  Values evaluate(const render::ShaderProgram& probe, const HairLook& look, float parameter, int vertices) {
    static const synthetic::Hair hair = synthetic::makeHair();
    render::HairInput input = synthetic::hairInput(hair, 10);
    input.look = look;
    render::HairStore store;
    store.update({&input, 1}, render::LightInput{});
    render::HairStore::bind(store.hairs()[0], {});
    render::Buffer result = render::makeBuffer();
    glNamedBufferStorage(result.id(), vertices * 16, nullptr, 0);
    render::ImageTarget target;
    target.prepare(4, 4);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
    render::VertexArray none = render::makeVertexArray();
    glBindVertexArray(none.id());
    probe.use();
    glUniform1f(0, parameter);
    glEnable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, result.id());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, vertices);
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    Values values(static_cast<std::size_t>(vertices));
    glGetNamedBufferSubData(result.id(), 0, vertices * 16, values.data());
    return values;
  }

  static render::ShaderProgram makeProbe(const char* source) {
    const std::string folder = gl_fixture::copyShaders("light_shaders");
    std::ofstream(folder + "/light_probe.vert") << kIncludes << source;
    return render::ShaderProgram(folder, {{"light_probe.vert"}, {}, {"result"}});
  }
};

HairLook lossless(float beta_m) {
  HairLook look;
  look.eumelanin = look.pheomelanin = 0;
  look.beta_m = beta_m;
  return look;
}

constexpr int kAngles = 171;
int degrees(int vertex) {
  return vertex - 85;
}

TEST_F(LightTest, AFibreWithoutLossIsAsBrightAsEvenLightAtEveryRoughness) {
  const render::ShaderProgram probe = makeProbe(kFurnace);
  for (float beta_m : {0.05f, 0.1f, 0.24f, 0.5f, 0.8f, 1.0f}) {
    for (float specular : {0.3f, 1.0f, 3.0f}) {
      HairLook look = lossless(beta_m);
      look.specular = specular;
      const Values values = evaluate(probe, look, 0, kAngles);
      float low = 1, high = 1;
      for (int v = 0; v < kAngles; ++v) {
        if (std::abs(degrees(v)) > 80) continue;
        low = std::min(low, values[static_cast<std::size_t>(v)][1]);
        high = std::max(high, values[static_cast<std::size_t>(v)][1]);
      }
      std::printf("beta_m %.2f specular %.1f: %.4f to %.4f\n", beta_m, specular, low, high);
      EXPECT_GT(low, 0.98f) << beta_m;
      EXPECT_LT(high, 1.02f) << beta_m;
    }
  }
}

TEST_F(LightTest, ALoneFibreSendsOnNoMoreOfABeamThanItGets) {
  const render::ShaderProgram probe = makeProbe(kFurnace);
  for (float cuticle : {0.0f, 0.05f}) {
    for (float beta_m : {0.1f, 0.24f, 0.5f, 1.0f}) {
      HairLook look = lossless(beta_m);
      look.cuticle_angle = cuticle;
      const Values values = evaluate(probe, look, 1, kAngles);
      float high = 0, mean = 0, weight = 0;
      for (int v = 0; v < kAngles; ++v) {
        if (std::abs(degrees(v)) > 80) continue;
        const float cosine = std::cos(static_cast<float>(degrees(v)) * std::numbers::pi_v<float> / 180);
        high = std::max(high, values[static_cast<std::size_t>(v)][1]);
        mean += cosine * cosine * values[static_cast<std::size_t>(v)][1];
        weight += cosine * cosine;
      }
      std::printf("cuticle %.2f beta_m %.2f: at most %.4f, mean %.4f\n", cuticle, beta_m, high, mean / weight);
      EXPECT_LT(mean / weight, 1.01f);
      EXPECT_LT(high, cuticle > 0 ? 1.12f : 1.1f);
    }
  }
}

TEST_F(LightTest, NoLookMakesAFibreBrighterThanItsLight) {
  std::string coarse(kFurnace);
  coarse.replace(coarse.find("float(gl_VertexID)"), 18, "24.0 * float(gl_VertexID)");
  const render::ShaderProgram probe = makeProbe(coarse.c_str());
  std::mt19937 random(5);
  const auto between = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  float high = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    HairLook look = lossless(between(0.05f, 1));
    look.eumelanin = std::max(between(-0.5f, 1), 0.0f);
    look.beta_n = between(0.05f, 1);
    look.eta = between(1.05f, 2.5f);
    look.cuticle_angle = between(-0.2f, 0.2f);
    look.specular = between(0, 4);
    look.diffuse = between(0, 1);
    for (const auto& value : evaluate(probe, look, 0, kAngles / 24 + 1)) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(value[c]));
        high = std::max(high, value[c]);
      }
    }
  }
  std::printf("at most %.4f\n", high);
  EXPECT_LT(high, 1.02f);
}

// Shares of the light that leave the shaders' slab.
slab_walk::Result shadersSlab(const std::vector<std::array<float, 4>>& sent, double thickness) {
  slab_walk::Result result;
  result.through.fill(static_cast<float>(std::exp(-thickness)));
  for (int d = 0; d < kDepths; ++d) {
    const double x = (d + 0.5) / kDepths, depth = thickness * x * x * (3 - 2 * x);
    const double step = thickness * 6 * x * (1 - x) / kDepths;
    for (int a = 0; a < kAzimuths; ++a) {
      const double mu = std::cos(std::numbers::pi * (a + 0.5) / kAzimuths);
      const double left = std::exp(-(mu < 0 ? depth : thickness - depth) / std::abs(mu));
      const double weight = 2 * std::numbers::pi / kAzimuths * step * left;
      for (int c = 0; c < 3; ++c) {
        (mu < 0 ? result.back : result.through)[static_cast<std::size_t>(c)] +=
            static_cast<float>(weight) * sent[static_cast<std::size_t>(d * kAzimuths + a)][static_cast<std::size_t>(c)];
      }
    }
  }
  return result;
}

TEST_F(LightTest, ALockSendsBackAndOnWhatARandomWalkSays) {
  const render::ShaderProgram probe = makeProbe(kSlab);
  struct Colour {
    const char* name;
    float eumelanin, pheomelanin;
  };
  for (const Colour& colour :
       {Colour{"white", 0, 0}, {"blond", 0.28f, 0.22f}, {"brown", 1.1f, 0.35f}, {"black", 4, 0.3f}}) {
    HairLook look;
    look.eumelanin = colour.eumelanin;
    look.pheomelanin = colour.pheomelanin;
    const slab_walk::Walk walk(look);
    for (double thickness : {0.3, 1.0, 3.0, 10.0}) {
      const slab_walk::Result walked = walk.through(thickness, 60000, 3);
      const slab_walk::Result shaded =
          shadersSlab(evaluate(probe, look, static_cast<float>(thickness), kDepths * kAzimuths), thickness);
      for (int c = 0; c < 3; ++c) {
        const auto close = [&](float a, float b, const char* side) {
          EXPECT_NEAR(a, b, 0.05f * b + 0.0025f) << colour.name << " " << thickness << " " << side << " " << c;
        };
        close(shaded.back[c], walked.back[c], "back");
        close(shaded.through[c], walked.through[c], "through");
      }
      std::printf("%s %.1f: back %.3f %.3f %.3f, walk %.3f %.3f %.3f; through %.3f %.3f %.3f, walk %.3f %.3f %.3f\n",
                  colour.name, thickness, shaded.back[0], shaded.back[1], shaded.back[2], walked.back[0],
                  walked.back[1], walked.back[2], shaded.through[0], shaded.through[1], shaded.through[2],
                  walked.through[0], walked.through[1], walked.through[2]);
    }
  }
}

}  // namespace light_test
