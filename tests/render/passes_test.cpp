// A kept frame shows what a fresh one would: every member of the frame's input is changed in turn. And every pass is in
// the list.
#include "render/passes.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "render/stage.h"
#include "tests/draw_skips.h"
#include "tests/gl_fixture.h"
#include "tests/golden_compare.h"
#include "tests/synthetic_hair.h"

namespace passes_test {

// The members of a struct as references, with their names. A structured binding names all members of a struct or does
// not compile, so a new member has to be added here, and is then changed by the test below.
template <class... T>
struct Members {
  const char* names;
  std::tuple<T&...> values;
};
template <class... T>
Members<T...> makeMembers(const char* names, std::tuple<T&...> values) {
  return {names, values};
}
#define MEMBERS(Type, ...)                                   \
  auto membersOf(render::Type& all) {                        \
    auto& [__VA_ARGS__] = all;                               \
    return makeMembers(#__VA_ARGS__, std::tie(__VA_ARGS__)); \
  }
MEMBERS(CameraInput, eye, target, up, fov_y, near_plane, far_plane, shift, rise)
MEMBERS(LightInput, to_light, key, fill, rim, to_fill, to_rim, ambient_sky, ambient_ground, shadow_size, shadow_strands,
        opacity_layers, layer_thickness, shadow_strength, shadow_strands_per_pixel, shadow_strand_share, shadows)
MEMBERS(ViewOptions, samples, exposure, backdrop_top, backdrop_bottom, ground_color, ground_height, ground,
        show_strands, show_body, strand_path, strands_per_pixel, strand_share, segment_error)
MEMBERS(DrawSkips, frame, rows, shadows, view, shadow_view, body_parts, body_detail, strands, segments, shadow_detail,
        skin, shading, hair_light, sky_visibility)
MEMBERS(HairLook, strand_radius, strands_represented, width_compensation, least_pixels, taper, length_variation, offset,
        clump, clump_size, lock, wisp, drift, root_spread, curl_radius, curl_pitch, wave_height, wave_length, frizz,
        flyaways, flyaway_lift, hairline, baby_hairs, eumelanin, pheomelanin, use_color, color, root_darkening,
        tint_variation, beta_m, beta_n, eta, cuticle_angle, shine_variation, specular, diffuse, seed)
MEMBERS(LookShares, roots, along)
MEMBERS(HairInput, id, layout_revision, position_revision, layout_id, faces, positions, rest, strands,
        segments_per_layer, look, shares, skin, skin_grids)
MEMBERS(BodyInput, id, mesh_id, positions, normals, triangles, joints, weights, joint_matrices, pose_revision, color,
        roughness, scalp_id, root_cover, root_color, scalp_tint, hair_id, face_origin, face_height, face_paint, cloth,
        dressed, cloth_color, material_places, materials, own_materials)
MEMBERS(FrameInput, width, height, camera, light, view, skips, hairs, bodies, debug_lines, debug_triangles,
        debug_points)
#undef MEMBERS

// A small change of a value.
void change(float& value) {
  value = 1.2f * value + 0.04f;
}
void change(int& value) {
  value += value >= 64 ? value : value / 2 + 1;
}
void change(bool& value) {
  value = !value;
}
void change(std::uint32_t& value) {
  value += 7;
}
void change(std::uint64_t& value) {
  value += 7;
}
void change(render::Float3& value) {
  value[0] += 0.11f;
}
void change(render::StrandPath& value) {
  value = render::StrandPath::kCompute;
}

// One hair on one body, and what the frame's spans point to.
struct Scene {
  synthetic::Hair hair = synthetic::makeHair(5);
  synthetic::Body body = synthetic::makeBody();
  std::vector<float> cover, rest, cloth, places;
  std::vector<std::vector<std::uint32_t>> materials{{0xff405070u, 0xff80a050u, 0xff703050u, 0xff205030u},
                                                    {0xff704050u, 0xff306090u, 0xff907050u, 0xff504030u}};
  std::vector<render::SkinEllipsoid> skin;
  std::vector<float> distances;
  render::SkinGrid grid;
  std::vector<render::LookShare> shares;
  std::vector<render::HairInput> hairs;
  std::vector<render::BodyInput> bodies;
  std::vector<render::LineVertex> shape;
  render::FrameInput frame;

  Scene() : cover(body.positions.size() / 3 * 2, 0.0f), hairs{synthetic::hairInput(hair, 400)} {
    bodies.push_back(synthetic::bodyInput(body));
    for (std::size_t v = 0; v < cover.size(); v += 2) cover[v] = body.positions[3 * v / 2 + 1] > 1.6f;
    hairs[0].segments_per_layer = 6;
    hairs[0].look.diffuse = 0.7f;
    rest = hair.positions;
    hairs[0].rest = rest;
    bodies[0].scalp_id = 1;
    bodies[0].scalp_tint = 0.6f;
    bodies[0].root_color = {0.4f, 0.3f, 0.2f};
    bodies[0].root_cover = cover;
    for (std::size_t v = 1; v < body.positions.size(); v += 3) cloth.push_back(body.positions[v] - 1.42f);
    bodies[0].cloth = cloth;
    for (std::size_t v = 0; v < body.positions.size(); v += 3)
      places.insert(places.end(), {body.positions[v], body.positions[v + 1], body.positions[v] > 0 ? 1.0f : 0.0f});
    bodies[0].material_places = places;
    bodies[0].materials = materials;
    // The synthetic body's front lies where face.glsl paints lips and brows.
    bodies[0].face_origin = {0, 1.45f, 0};
    bodies[0].face_height = 0.25f;
    bodies[0].face_paint = 0.6f;
    frame = synthetic::frameInput(hairs, bodies, 96, 64);
    // The software path rounds depths otherwise with every other near plane: a level or two in a pixel.
    frame.view.strand_path = render::StrandPath::kGeometry;
    frame.camera.eye = {0.25f, 1.6f, 0.6f};
    frame.light.shadow_size = 128;
    frame.light.shadow_strands = 100;
    frame.light.opacity_layers = 4;
    frame.view.samples = 2;
    frame.view.strands_per_pixel = 3;
    frame.view.strand_share = frame.light.shadow_strand_share = 0.7f;
    // Of the approximate skips, those whose picture does not depend on earlier frames.
    frame.skips = draw_skips::exact();
    frame.skips.strands = frame.skips.segments = true;
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // Spans change by their content and the revision that tells of it; the ids of what they are change as values do.
  void change(std::span<const render::HairFace>&) {
    hair.faces.pop_back();
    hairs[0].faces = hair.faces;
    ++hairs[0].layout_revision;
  }
  void change(std::span<const float>& values) {
    if (&values == &hairs[0].rest) {
      for (std::size_t i = 0; i < rest.size(); i += 2) rest[i] = 0.9f * rest[i];
      ++hairs[0].layout_revision;
      return;
    }
    const bool of_hair = &values == &hairs[0].positions, of_cover = &values == &bodies[0].root_cover;
    std::vector<float>& numbers = of_hair                                 ? hair.positions
                                  : of_cover                              ? cover
                                  : &values == &bodies[0].normals         ? body.normals
                                  : &values == &bodies[0].weights         ? body.weights
                                  : &values == &bodies[0].cloth           ? cloth
                                  : &values == &bodies[0].material_places ? places
                                                                          : body.positions;
    for (std::size_t i = 0; i < numbers.size(); i += 2) numbers[i] = 0.95f * numbers[i] + 0.01f;
    ++(of_hair ? hairs[0].position_revision : of_cover ? bodies[0].scalp_id : bodies[0].mesh_id);
  }
  void change(std::span<const render::SkinEllipsoid>& of) {
    skin.push_back(synthetic::skinBall({0.05f, synthetic::kHeadHeight, 0.05f}, 1.05f * synthetic::kHeadRadius));
    of = skin;
  }
  // A ball about the head.
  void change(std::span<const render::SkinGrid>& of) {
    constexpr int kNodes = 21;
    constexpr float kStep = 0.12f * synthetic::kHeadRadius, kMiddle = 0.5f * (kNodes - 1) * kStep;
    distances.clear();
    for (int k = 0; k < kNodes; ++k)
      for (int j = 0; j < kNodes; ++j)
        for (int i = 0; i < kNodes; ++i)
          distances.push_back((kStep * Eigen::Vector3f(i, j, k).array() - kMiddle).matrix().norm() -
                              1.08f * synthetic::kHeadRadius);
    grid = {1, {}, {kNodes, kNodes, kNodes}, distances};
    const std::array<float, 3> low{-kMiddle, synthetic::kHeadHeight - kMiddle, -kMiddle};
    for (std::size_t k = 0; k < 3; ++k) grid.to_nodes[k][k] = 1 / kStep, grid.to_nodes[k][3] = -low[k] / kStep;
    of = {&grid, 1};
  }
  void change(std::span<const render::LookShare>& of) {
    shares.assign(hair.positions.size() / 3, {0.5f, 1, 1, 0.5f, {1, 0.5f, 0.2f}});
    of = shares;
    ++hairs[0].layout_revision;
  }
  void change(std::span<const std::uint32_t>&) {
    body.triangles.resize(body.triangles.size() / 2 / 3 * 3);
    bodies[0].triangles = body.triangles;
    ++bodies[0].mesh_id;
  }
  void change(std::span<const std::vector<std::uint32_t>>&) {
    materials[0][0] ^= 0x00ffffffu;
    ++bodies[0].mesh_id;
  }
  void change(std::span<const std::uint16_t>&) { ++bodies[0].mesh_id; }  // there is one joint only
  void change(std::span<const render::Mat4>&) {
    body.joint_matrices[0][13] += 0.05f;
    ++bodies[0].pose_revision;
  }
  void change(std::span<const render::HairInput>& of) {
    hairs.push_back(hairs[0]);
    hairs[1].id = 2;
    hairs[1].look.eumelanin = 3;
    of = hairs;
  }
  void change(std::span<const render::BodyInput>& of) { of = {}; }
  void change(std::span<const render::LineVertex>& of) {
    shape = {{{-0.2f, 1.5f, 0.3f}, {1, 0, 0, 1}}, {{0.2f, 1.6f, 0.3f}, {1, 0, 0, 1}}, {{0, 1.4f, 0.3f}, {1, 0, 0, 1}}};
    of = std::span(shape).first(&of == &frame.debug_lines ? 2 : 3);
  }

  // Changes member number `wanted`, counted over all structs; false when there are not so many.
  bool changeMember(int wanted, std::string& name) {
    int number = 0;
    name.clear();
    visit(frame, "frame", wanted, number, name);
    return !name.empty();
  }

 private:
  template <class T>
  void visit(T& all, const std::string& path, int wanted, int& number, std::string& name) {
    const auto members = membersOf(all);
    std::vector<std::string> names;
    const std::string text = members.names;
    const std::regex word("\\w+");
    for (std::sregex_iterator at(text.begin(), text.end(), word); at != std::sregex_iterator(); ++at)
      names.push_back(at->str());
    std::size_t place = 0;
    std::apply([&](auto&... value) { (visitOne(value, path + "." + names[place++], wanted, number, name), ...); },
               members.values);
  }
  template <class T>
  void visitOne(T& value, const std::string& path, int wanted, int& number, std::string& name) {
    if (!name.empty()) return;
    if constexpr (requires { membersOf(value); }) {
      visit(value, path, wanted, number, name);
    } else {
      if constexpr (std::is_same_v<T, std::span<const render::HairInput>>) visit(hairs[0], path, wanted, number, name);
      if constexpr (std::is_same_v<T, std::span<const render::BodyInput>>) visit(bodies[0], path, wanted, number, name);
      if (!name.empty() || number++ != wanted) return;
      name = path;
      if constexpr (requires { passes_test::change(value); }) {
        passes_test::change(value);
      } else {
        change(value);
      }
    }
  }
};

// What may change without this picture changing: identities and revisions, exact skips and those of small pictures, the
// other path to the same strands, and what other members switch off here.
const std::set<std::string> kUnseen{"frame.bodies.color",  // the mesh brings its own
                                    "frame.bodies.id",
                                    "frame.bodies.joints",
                                    "frame.bodies.mesh_id",
                                    "frame.bodies.pose_revision",
                                    "frame.bodies.scalp_id",
                                    "frame.bodies.weights",  // of one rigid joint
                                    "frame.camera.far_plane",
                                    "frame.camera.near_plane",
                                    "frame.hairs.layout_id",
                                    "frame.hairs.layout_revision",
                                    "frame.hairs.look.color",
                                    "frame.hairs.look.curl_pitch",
                                    "frame.hairs.look.wave_length",
                                    "frame.hairs.position_revision",
                                    "frame.light.shadow_strands_per_pixel",
                                    "frame.skips.body_detail",
                                    "frame.skips.body_parts",
                                    "frame.skips.frame",
                                    "frame.skips.hair_light",  // of a body as coarse
                                    "frame.skips.rows",
                                    "frame.skips.shading",
                                    "frame.skips.shadow_detail",
                                    "frame.skips.shadow_view",
                                    "frame.skips.shadows",
                                    "frame.skips.skin",
                                    "frame.skips.sky_visibility",
                                    "frame.skips.view",
                                    "frame.view.strand_path"};

class Passes : public gl_fixture::GlTest {};

// Each change comes after a frame that shows the scene without it, and is held against a renderer that keeps nothing.
TEST_F(Passes, AKeptFrameIsWhatAFreshOneWouldBe) {
  render::Renderer keeping(gl_fixture::kShaderDir), fresh(gl_fixture::kShaderDir);
  std::set<std::string> unseen;
  int members = 0;
  std::string name;
  for (;; ++members) {
    Scene scene;
    std::vector<unsigned char> before, kept, redrawn;
    keeping.renderImage(scene.frame, before);
    if (!scene.changeMember(members, name)) break;
    keeping.renderImage(scene.frame, kept);
    scene.frame.skips.frame = scene.frame.skips.rows = scene.frame.skips.shadows = false;
    // What the second renderer keeps of hairs and bodies goes with a frame without them.
    render::FrameInput nothing;
    nothing.width = nothing.height = 16;
    std::vector<unsigned char> empty;
    fresh.renderImage(nothing, empty);
    fresh.renderImage(scene.frame, redrawn);
    const golden::Difference stale = golden::compare({96, 64, kept}, {96, 64, redrawn}, 0);
    EXPECT_TRUE(kept == redrawn) << "stale after a change of " << name << ", by " << stale.largest << " levels in "
                                 << stale.outliers << " pixels";
    if (kept != redrawn) {
      app::writePng(std::string(HAIRMESH_TEST_OUT) + "/" + name + "_kept.png", 96, 64, kept);
      app::writePng(std::string(HAIRMESH_TEST_OUT) + "/" + name + "_redrawn.png", 96, 64, redrawn);
    }
    if (redrawn == before) unseen.insert(name);
    keeping.renderImage(nothing, empty);
  }
  EXPECT_GE(members, 100);
  for (const std::string& one : unseen) EXPECT_TRUE(kUnseen.contains(one)) << one << " did not change the picture";
  for (const std::string& one : kUnseen) EXPECT_TRUE(unseen.contains(one)) << one << " changed the picture";
}

TEST_F(Passes, ExposureAloneRedrawsNothingBelowTheScreen) {
  render::Renderer renderer(gl_fixture::kShaderDir);
  Scene scene;
  std::vector<unsigned char> dark, bright;
  renderer.renderImage(scene.frame, dark);
  scene.frame.view.exposure *= 2;
  const render::FrameReport report = renderer.renderImage(scene.frame, bright);
  EXPECT_EQ(report.skip_counts.frame.skipped, 1);
  EXPECT_NE(dark, bright);
}

TEST_F(Passes, ReportsNameEveryPassInItsOrder) {
  render::Renderer renderer(gl_fixture::kShaderDir);
  Scene scene;
  std::vector<unsigned char> rgba;
  std::vector<std::string> names, expected{"upload"};
  for (const render::StageTime& stage : renderer.renderImage(scene.frame, rgba, true).stages)
    names.push_back(stage.name);
  for (const render::PassMaker make : render::kPasses) expected.push_back(make(gl_fixture::kShaderDir).name);
  EXPECT_EQ(names, expected);
}

std::string textOf(const std::string& file) {
  std::ifstream stream(std::string(HAIRMESH_SOURCE_DIR) + "/" + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PassList, HoldsEveryPassOfEveryPassFileOnce) {
  const std::string list = textOf("render/passes.h");
  const std::regex definition("\nclass (\\w+Pass) \\{");
  std::size_t passes = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::string(HAIRMESH_SOURCE_DIR) + "/render")) {
    const std::string name = file.path().filename().string();
    if (!name.ends_with("_pass.cpp")) continue;
    const std::string text = textOf("render/" + name);
    std::sregex_iterator found(text.begin(), text.end(), definition);
    EXPECT_NE(found, std::sregex_iterator()) << name << " defines no pass";
    for (; found != std::sregex_iterator(); ++found, ++passes) {
      const std::string entry = "makePass<class " + (*found)[1].str() + ">,";
      EXPECT_NE(list.find(entry), std::string::npos) << name << ": " << entry;
    }
  }
  EXPECT_EQ(passes, std::size(render::kPasses));
}

}  // namespace passes_test
