// A figure as the renderer is given it: its hair, its body and what it wears, as they are shown. Spans point into the
// actor.
#pragma once

#include <span>
#include <vector>

#include "app/scene/actor.h"
#include "render/frame_input.h"

namespace app {

// `positions`: of the simulated vertices, as shown. `drawn` keeps those that hair is drawn at where that is
// elsewhere: braided, or of a groom.
render::HairInput hairInput(const Actor& actor, const CharacterLook& look, std::span<const float> positions,
                            std::vector<float>& drawn);
// Its ties, and those that hold the ends of its plaits, where hair is drawn; `matrices` keeps where they are.
void addBands(const Actor& actor, std::span<const float> positions, std::vector<render::Mat4>& matrices,
              std::vector<render::BodyInput>& bodies);
// `show_strands`: whether hair is drawn at all; without it the head is bald.
render::BodyInput bodyInput(const Actor& actor, const CharacterLook& look, bool show_strands);
// The attachment of that number.
render::BodyInput attachmentInput(const Actor& actor, std::size_t k, bool show_strands);

}  // namespace app
