#include "tests/reference/drawn.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>

#include "app/files/errors.h"
#include "render/renderer.h"

namespace reference {
namespace {

std::string readAll(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// Replaces the only occurrence of a text in a shader.
void replaceIn(const std::filesystem::path& file, const std::string& what, const std::string& by) {
  std::string text = readAll(file);
  const std::size_t at = text.find(what);
  if (at == std::string::npos)
    throw app::InputError(file.string(), "", "does not hold '" + what + "' any more",
                          "say in drawn.cpp how the shader shows its terms");
  text.replace(at, what.size(), by);
  std::ofstream(file) << text;
}

const char* strandsShow(Term term) {
  switch (term) {
    case Term::kCover:
      return "vec3 shadeStrand(in Strand strand, in CurvePoint point) { return vec3(1.0, 0.0, 0.0); }\n";
    case Term::kShadow:
      return R"(vec3 shadeStrand(in Strand strand, in CurvePoint point) {
  vec3 at = hairShadowCoordinates(draw.w, point.position);
  vec3 to_eye = normalize(eye.xyz - point.position);
  float depth = seenShare(to_eye, to_key.xyz) * hairOpticalDepths(draw.w, at).x;
  return vec3(bodyLightOnHair(draw.w, at) * exp(-depth), exp(-kSoftDepth * point.light.yz));
}
)";
    case Term::kSkinShadow:
      return "vec3 shadeStrand(in Strand strand, in CurvePoint point) { return vec3(0.0); }\n";
    default:
      return "vec3 shadeStrand(in Strand strand, in CurvePoint point) { return shadeWhole(strand, point); }\n";
  }
}

const char* skinShows(Term term) {
  switch (term) {
    case Term::kCover:
      return "  return vec3(0.0, 1.0, 0.0);\n";
    case Term::kSkinShadow:
      return "  return vec3(lit * min(through_hair.x, among_roots.g), min(through_hair.zw, among_roots.gg));\n";
    default:
      return "  return vec3(0.0);\n";
  }
}

// A copy of the shaders in which the backdrop is black, strands and skin show a term, and the screen shows square
// roots of plain means.
std::string shadersFor(Term term) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("hairmesh_reference_" + std::to_string(::getpid()) + "_" + std::to_string(static_cast<int>(term)));
  std::filesystem::remove_all(folder);
  std::filesystem::copy(std::string(HAIRMESH_SOURCE_DIR) + "/shaders", folder,
                        std::filesystem::copy_options::recursive);
  replaceIn(folder / "common/hair_shading.glsl", "vec3 shadeStrand(", "vec3 shadeWhole(");
  std::ofstream(folder / "common/hair_shading.glsl", std::ios::app) << strandsShow(term);
  replaceIn(folder / "common/body_light.glsl", "  return radiance;\n", skinShows(term));
  replaceIn(folder / "common/backdrop.glsl", "  return sweep", "  return 0.0 * sweep");
  std::ofstream(folder / "tone_map.frag") << R"(#include "shared.h"
layout(binding = kUnitColor) uniform sampler2DMS samples;
layout(location = 0) uniform int sample_count;
layout(location = 1) uniform float exposure;
layout(location = 0) out vec4 color;
void main() {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < sample_count; ++i) sum += texelFetch(samples, ivec2(gl_FragCoord.xy), i).rgb;
  color = vec4(sqrt(exposure * sum / float(sample_count)), 1.0);
}
)";
  return folder.string();
}

render::Renderer& rendererFor(Term term) {
  static std::map<Term, std::unique_ptr<render::Renderer>> renderers;
  std::unique_ptr<render::Renderer>& renderer = renderers[term];
  if (!renderer) {
    const std::string folder = shadersFor(term);
    renderer = std::make_unique<render::Renderer>(folder);
    std::filesystem::remove_all(folder);
  }
  return *renderer;
}

}  // namespace

std::vector<Eigen::Vector3f> drawTerm(render::FrameInput frame, Term term, const DrawOptions& options) {
  frame.width = options.width * options.finer;
  frame.height = options.height * options.finer;
  frame.view.ground = false;
  frame.view.exposure = 1 / options.brightest;
  std::vector<unsigned char> rgba;
  rendererFor(term).renderImage(frame, rgba);
  std::vector<Eigen::Vector3f> pixels(static_cast<std::size_t>(options.width * options.height),
                                      Eigen::Vector3f::Zero());
  const float share = options.brightest / static_cast<float>(options.finer * options.finer);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const unsigned char* from = &rgba[4 * static_cast<std::size_t>(y * frame.width + x)];
      const Eigen::Vector3f root(from[0], from[1], from[2]);
      pixels[static_cast<std::size_t>(y / options.finer * options.width + x / options.finer)] +=
          share * (root / 255).cwiseAbs2();
    }
  }
  return pixels;
}

}  // namespace reference
