#include "app/scene/detail/skips.h"

#include <algorithm>
#include <initializer_list>

namespace app {

namespace {

constexpr const char* kSimulation = "simulation";
constexpr const char* kCharacter = "character";
constexpr const char* kDrawing = "drawing";

constexpr const char* kDetailBound = "mean 4.5 levels of 255 over blocks of hair, 9 where the hair is under 20 pixels";

// Exact skips have no bound: nothing may change.
constexpr std::array<Skip, kSkipCount> kTable{{
    {kSkipSleep, "sleep", kSimulation, "steps", false, "0.12 mm",
     "Hair that hangs still over a still head is not stepped.",
     "tests/sim/skips_sim_test.cpp: Sleep.ComesWhenNothingThatShowsIsLeft"},
    {kSkipUnseen, "unseen", kSimulation, "steps", false, "not in the picture",
     "Characters whose figure and shadow cannot be in the picture are neither posed nor stepped; their hair comes back "
     "as it hung.",
     "tests/sim/skips_sim_test.cpp: Unseen.WhoIsLeftOutIsNotInThePicture"},
    {kSkipFarSteps, "far-steps", kSimulation, "steps", false, "mean 3 pixels over the vertices",
     "A character smaller than 520 pixels takes steps twice as long, below 380 four times, below 100 eight times, "
     "as long as no vertex moves by a tenth of the hair's length against the head in such a step; the long steps of a "
     "crowd spread over the frames.",
     "tests/sim/skips_sim_test.cpp: Far.StaysWithinItsPixels"},
    {kSkipFarMesh, "far-mesh", kSimulation, "steps", false, "mean 3 pixels over the vertices",
     "A character smaller than 420 pixels, its hair shorter than 150, is simulated with its style's low resolution, "
     "below 240 with its minimal one, and drawn with its own.",
     "tests/sim/skips_sim_test.cpp: Far.StaysWithinItsPixels"},
    {kSkipPose, "pose", kCharacter, "poses", true, "",
     "A figure whose clip stands still is not posed again, and nothing is handed over while time stands still.",
     "tests/sim/skips_sim_test.cpp: Exact.PosesAndBonesChangeNoBit"},
    {kSkipBones, "bones", kCharacter, "joints", true, "",
     "Joints that neither skin nor ellipsoids nor the scalp hang on are not evaluated.",
     "tests/sim/skips_sim_test.cpp: Exact.PosesAndBonesChangeNoBit"},
    {kSkipFrame, "frame", kDrawing, "frames", true, "",
     "A frame that would show what the last one showed is not drawn again, only toned.",
     "tests/render/skips_draw_test.cpp: SkipsDraw.AStillFrameIsKeptAndAnyChangeSeen"},
    {kSkipRows, "rows", kDrawing, "vertices", true, "", "Only positions that changed are uploaded.",
     "tests/render/skips_draw_test.cpp: SkipsDraw.ExactSkipsChangeNoByte"},
    {kSkipShadows, "shadows", kDrawing, "maps", true, "",
     "Deep opacity maps and the body's shadow map are kept while light, hair and bodies stay.",
     "tests/render/skips_draw_test.cpp: SkipsDraw.ExactSkipsChangeNoByte"},
    {kSkipView, "view", kDrawing, "bundles", true, "",
     "Hairs, bundles of hair and bodies outside the camera's view are not drawn.",
     "tests/render/skips_draw_test.cpp: SkipsDraw.ExactSkipsChangeNoByte"},
    {kSkipShadowView, "shadow-view", kDrawing, "maps", true, "",
     "Hair whose shadow cannot fall into the view gets no shadow map, and maps draw only bodies that can shade them. "
     "(The other maps then lie elsewhere in their texture, whose filter may round otherwise: a level or two in a "
     "pixel or two.)",
     "tests/render/skips_draw_test.cpp: SkipsDraw.ExactSkipsChangeNoByte"},
    {kSkipBodyParts, "body-parts", kDrawing, "triangles", true, "", "Parts of a body outside the view are not skinned.",
     "tests/render/skips_draw_test.cpp: SkipsDraw.ExactSkipsChangeNoByte"},
    {kSkipBodyDetail, "body-detail", kDrawing, "triangles", false,
     "mean 2 levels of 255 over blocks of body, 4 where it is under 60 pixels",
     "Fewer triangles of a body the smaller it is in the picture: vertices within a cell of a pixel are merged, and "
     "the "
     "light is worked out at them.",
     "tests/render/skips_draw_test.cpp: SkipsDraw.BodyDetailStaysInItsBound"},
    {kSkipStrands, "strands", kDrawing, "strands", false, kDetailBound,
     "Fewer and wider strands the smaller the hair is in the picture (strands_per_pixel).",
     "tests/render/skips_draw_test.cpp: SkipsDraw.DetailStaysInItsBound"},
    {kSkipSegments, "segments", kDrawing, "curve points", false, kDetailBound,
     "Fewer segments the straighter and smaller the strands are in the picture (segment_error).",
     "tests/render/skips_draw_test.cpp: SkipsDraw.DetailStaysInItsBound"},
    {kSkipShadowDetail, "shadow-detail", kDrawing, "shadow strands", false, kDetailBound,
     "Fewer strands in smaller shadow maps the smaller the hair is in the picture (shadow_strands_per_pixel).",
     "tests/render/skips_draw_test.cpp: SkipsDraw.DetailStaysInItsBound"},
    {kSkipSkin, "skin", kDrawing, "tests of a bundle with an ellipsoid", true, "",
     "Strands are lifted only out of skin that their bundle can meet between two layers.",
     "tests/render/software_test.cpp: Software.SkinOutOfReachAndHiddenPointsChangeNoByte"},
    {kSkipShading, "shading", kDrawing, "curve points", true, "",
     "Drawn in software, only points of strands that some sample of the picture shows are shaded.",
     "tests/render/software_test.cpp: Software.SkinOutOfReachAndHiddenPointsChangeNoByte"},
    {kSkipHairLight, "hair-light", kDrawing, "triangles", false,
     "mean 2 levels of 255 over blocks of body, 4 where it is under 60 pixels",
     "The hair's shadow on a body whose vertices lie nearer than the shadow is soft is looked up at them.",
     "tests/render/software_test.cpp: Software.HairLightAtVerticesStaysInItsBound"},
    {kSkipSkyVisibility, "sky-visibility", kDrawing, "vertices", false, kDetailBound,
     "The soft light inside hair that is small in the picture is renewed every eighth time.",
     "tests/render/skips_draw_test.cpp: SkipsDraw.DetailStaysInItsBound"},
    {kSkipEvents, "events", "window", "waits", true, "", "The window waits for events while nothing in it moves.",
     "tests/sim/skips_sim_test.cpp: Exact.TheWindowWaitsOnlyWhenNothingMoves"},
}};

constexpr std::array<BuiltInSkip, kBuiltInCount> kBuiltIn{{
    {kNoContact, "no-contact", "steps", "no contact: no position correction and no deformation minimization",
     "tests/sim/contact/deformation_test.cpp: DeformationMinimization.DoesNoWorkWhenNothingTouches"},
    {kSolvedAtStart, "solved-at-start", "steps", "a solve that starts within its tolerance: no iteration",
     "tests/sim/skips_step_test.cpp: SkipCount.ASolveThatStartsWithinToleranceTakesNoIteration"},
    {kNoNewBalance, "no-new-balance", "steps", "unchanged parameters: no new balance of gravity",
     "tests/sim/skips_step_test.cpp: SkipCount.UnchangedParametersNeverBalanceAnew"},
    {kNoStiffness, "no-stiffness", "kinds of force", "a kind of force without stiffness: not assembled",
     "tests/sim/skips_step_test.cpp: SkipCount.KindsOfForceWithoutStiffnessAreNotAssembled"},
    {kOutOfReach, "out-of-reach", "tests of a vertex with a collider",
     "colliders out of reach, within the step, of the whole hair or of a cluster of its vertices: not tested",
     "tests/sim/reach_test.cpp: Reach.RandomBodiesAreFoundToTheBit"},
    {kPausedFrame, "paused", "frames", "paused: no step unless one is asked for",
     "tests/app/scene/demo_test.cpp: Demo.ASingleStepIsOneStep"},
    {kNoPicture, "no-picture", "frames", "no picture asked for: no OpenGL context",
     "tests/app/scene/demo_test.cpp: Headless.ARunWithoutPicturesNeedsNoGraphicsAndReportsEveryFrame"},
    {kHiddenPanels, "hidden-panels", "frames", "hidden panels: no work for them",
     "tests/app/ui/ui_test.cpp: Panels.HiddenPanelsDrawNothing"},
}};

std::string names() {
  std::string text;
  for (const Skip& skip : kTable) text += (text.empty() ? "" : ", ") + std::string(skip.name);
  return text;
}

}  // namespace

std::span<const Skip> skipTable() {
  return kTable;
}

const Skip* findSkip(std::string_view name) {
  const auto found = std::find_if(kTable.begin(), kTable.end(), [&](const Skip& skip) { return name == skip.name; });
  return found == kTable.end() ? nullptr : &*found;
}

std::span<const BuiltInSkip> builtInSkips() {
  return kBuiltIn;
}

std::string setSkip(std::string_view text, SkipSet& skips) {
  const std::size_t equals = text.find('=');
  const std::string_view name = text.substr(0, equals);
  const std::string_view value = equals == std::string_view::npos ? "" : text.substr(equals + 1);
  const Skip* skip = findSkip(name);
  std::string fault = "'";
  if (!skip && name != "all") {
    return fault.append(name.substr(0, 40)).append("' is no skip; choose all or one of ").append(names());
  }
  if (value != "on" && value != "off") {
    fault.append(text.substr(0, 60)).append("' does not say on or off; write ");
    return fault.append(name).append("=off");
  }
  if (skip) {
    skips.on[skip->id] = value == "on";
  } else {
    skips.on.fill(value == "on");
  }
  return {};
}

std::string skipTableText() {
  std::string text;
  const auto addRow = [&](std::initializer_list<std::string_view> cells) {
    text += "|";
    for (const std::string_view cell : cells) text.append(" ").append(cell).append(" |");
    text += "\n";
  };
  addRow({"skip", "part", "what is left out", "may change", "counted in", "proof"});
  text += "|---|---|---|---|---|---|\n";
  for (const Skip& skip : kTable) {
    const std::string_view change = skip.exact ? "nothing" : skip.bound;
    addRow({skip.name, skip.stage, skip.help, change, skip.counts, skip.proof});
  }
  for (const BuiltInSkip& skip : kBuiltIn)
    addRow({"(always)", skip.name, skip.what, "nothing", skip.counts, skip.proof});
  return text;
}

}  // namespace app
