// What figures wear: loaded once, posed with its joint, collided with beside the body, drawn as a body of its own; and
// what a hat does to the hair under it.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "app/figure/attachment.h"
#include "app/scene/actor.h"

namespace app {

// The attachments of a character on its body, each read on first use. Throws InputError.
std::vector<const Attachment*> attach(const CharacterSpec& spec, const LoadedBody& body, AssetCache& asset_cache);

// Lays the hair that is rooted under an attachment of the head beneath it, and under one that goes round the head, as a
// headband, all hair that passes it: each vertex nearer to the scalp, in proportion to how far it stands off. `tied`:
// vertices in the rings of ties, beyond which hair passes over a headband. Returns the vertices that lie under an
// attachment, roots left out, each once and ascending. Throws InputError where the attachment encloses the head, its
// roots or the hair.
std::vector<int> layUnder(std::span<const Attachment* const> attachments, const Scalp& scalp, const BodyDistance& body,
                          std::span<const int> tied, sim::HairMeshShape& shape);

// Signed distances of a pose, with velocities from the previous one over dt.
void poseAttachments(double dt, Actor& actor);

// Matrices of the shown pose relative to `origin` (m). Returns whether any bit changed.
bool showAttachments(const Vec3& origin, Actor& actor);

// Draws what the actor wears where `text` has it (see attachmentsFromText; the same files in the same order). Distances
// and hair stay, and what would be inferred stays as it is. Throws InputError.
void drawDragged(const std::string& text, Actor& actor);
// Draws it where its distances are. Returns whether it was elsewhere.
bool drawInPlace(Actor& actor);

// The colour that one of the actor's attachments is drawn in, linear.
std::array<float, 3> wornColor(const Actor& actor, std::size_t k);

// What was inferred of the actor's attachments, and which is worn twice, a line each.
std::string attachmentNotes(const Actor& actor);

}  // namespace app
