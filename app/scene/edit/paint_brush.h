// Strokes of paint: asked for as text, so that recordings keep them; they change a field over the scalp, and the hair
// goes on moving.
#pragma once

#include <array>
#include <string>

#include "app/files/field_map.h"
#include "app/scene/edit/groom_brush.h"

namespace app {

// One sample of a stroke. The field is drawn towards `value` at the roots of the hair within the brush.
struct PaintSample {
  std::string field;  // of kFieldNames
  Vec3 at = Vec3::Zero();
  double radius = 0.04, strength = 0.5, falloff = 1;
  bool mirror = false;
  double value = 0;               // 0 to 1
  std::array<double, 3> color{};  // in its place for the field "color": of a picture, 0 to 1
};

// "x y z  radius strength falloff mirror  value", of a colour "... red green blue"; parsePaint reads the same bits
// back.
std::string paintText(const PaintSample& sample);
// Throws InputError.
PaintSample parsePaint(const std::string& field, const std::string& text);

// Changes the picture of the field in the actor's spec and what it does to the hair, or to its look. Throws InputError
// where the brush reaches no hair, or the length of hair that is tied, covered or reshaped by hand would be painted;
// then nothing has changed.
void applyPaint(const PaintSample& sample, int actor, Demo& demo);

// Gives the hair what pictures and curves paint, its length apart, and goes on moving. They are not yet, or no longer,
// in the actor's spec. Throws InputError where a picture cannot be read; then nothing has changed.
void repaint(const FieldFiles& maps, const FieldCurves& curves, int actor, Demo& demo);

// Says why a painted field shows nothing: "painted curl changes nothing while curl_radius is 0". Empty where it shows.
std::string paintNote(const std::string& field, const CharacterSpec& spec);

// Gives the actor's hair another curve from root to tip, see setCurve. Throws InputError.
void applyCurve(const std::string& name, const std::string& text, int actor, Demo& demo);

}  // namespace app
