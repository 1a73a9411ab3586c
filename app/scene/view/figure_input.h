// A figure as the renderer is given it: its hair, its body and what it wears, as they are shown. Spans point into the
// actor.
#pragma once

#include "app/scene/actor.h"
#include "render/frame_input.h"

namespace app {

render::HairInput hairInput(const Actor& actor, const CharacterLook& look);
// `show_strands`: whether hair is drawn at all; without it the head is bald.
render::BodyInput bodyInput(const Actor& actor, const CharacterLook& look, bool show_strands);
// The attachment of that number.
render::BodyInput attachmentInput(const Actor& actor, std::size_t k, bool show_strands);

}  // namespace app
