// Strokes of a brush on an actor's hair: asked for as text, so that recordings keep them, and carried out on the rest
// shape while the hair goes on moving.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/groom/edit/shape_brush.h"
#include "app/scene/actor.h"

namespace app {

struct Demo;

// One sample of a stroke. Places are those of Brush: the scalp's frame, m.
struct BrushSample {
  BrushTool tool = BrushTool::kComb;
  Vec3 at = Vec3::Zero(), along = Vec3::Zero();
  double radius = 0.04, strength = 0.5, falloff = 1;
  bool mirror = false;
};

inline constexpr double kSmallestBrush = 0.003, kLargestBrush = 0.3;  // m
inline constexpr double kLargestFalloff = 8;

// The numbers of a text, with blanks between; their count, one more than there is room for where they are more or no
// numbers.
std::size_t numbersOf(std::string_view text, std::span<double> numbers);

// "x y z  x y z  radius strength falloff mirror"; parseBrush reads the same bits back.
std::string brushText(const BrushSample& sample);
// `tool`: as kBrushNames. Throws InputError.
BrushSample parseBrush(const std::string& tool, const std::string& text);

// Changes the rest shape of the actor's hair, which becomes its own. Throws InputError where the brush reaches no hair;
// then nothing has changed.
void applyBrush(const BrushSample& sample, int actor, Demo& demo);

// The moving hair in the scalp's frame, m; and what shapes it, with the distance to the body, made on first use.
std::vector<Vec3> seenFromScalp(const Actor& actor);
ShapeBrushes& handsOn(const Actor& actor);

// Of a haircut that was changed by hand; never the same twice.
std::string freshKey(const std::string& key);

// Gives the actor's hair other painted shares. What moves goes on moving.
void repaintHair(const PaintedShares& shares, int actor, Demo& demo);

// Whether the rest shape is another than style or file, painted length, ties and attachments make it.
bool reshapedByHand(const Haircut& haircut);

// The actor's haircut, its own from now on.
Haircut& ownHaircut(Actor& actor, Demo& demo);

// Gives the actor's hair another mask of what brushes leave as it is (one share a vertex, or none at all).
void freezeHair(const std::vector<float>& frozen, int actor, Demo& demo);

// Gives the actor's hair other rest positions (one a vertex, scalp frame, m). What moves goes on moving. Throws
// InputError where a prism would not be positive; then nothing has changed.
void reshapeHair(const std::vector<Vec3>& positions, int actor, Demo& demo);

// Does something while the hair of each actor has other rest positions, as one that it has had, and brings those of now
// back. What moves is where that leaves it.
void inShapes(const std::vector<std::vector<Vec3>>& shapes, const std::function<void()>& act, Demo& demo);

}  // namespace app
