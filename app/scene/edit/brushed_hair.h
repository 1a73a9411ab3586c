// What brushes have made of hair, kept where the hair is made anew: tied, under a hat, painted by a picture, at another
// resolution or on another head. CharacterSpec::brushed has it as bytes; none of them is nothing.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/scene/actor.h"

namespace app {

// A rest shape that brushes have made, in the scalp's frame.
struct BrushedShape {
  sim::HairMeshShape shape;
  std::vector<Vec3> before;   // m, the same vertices without brushes; empty: the structure is another as well
  std::vector<float> frozen;  // as Haircut has it
};

struct BrushedHair {
  std::string hair;  // what brushes worked on: style or file, and its painted length
  std::string body;  // LoadedBody::key
  Resolution resolution = Resolution::kMedium;
  double head_height = 0.23;  // m
  std::optional<BrushedShape> loose;
  std::optional<BrushedShape> tied;  // as it came out of these ties
  std::string ties;
};

// Root faces as binaries have them: corner count and columns.
using FaceRow = std::array<int, 5>;
std::vector<FaceRow> faceRows(const sim::HairMeshShape& shape);
std::vector<sim::RootFace> rootFaces(std::span<const FaceRow> rows);

std::vector<std::byte> brushedBytes(const BrushedHair& brushed);
// Nothing of bytes that are none, or not those of a hair mesh.
std::optional<BrushedHair> readBrushed(std::span<const std::byte> bytes);

// What brushes have made of the actor's hair by now. Hair that was carried to another resolution or head, and not
// brushed since, has what it was carried from: it comes back as it was.
std::vector<std::byte> brushedHair(const Actor& actor);

// Hands to `spec`, for which the actor's hair is made anew, what brushes have made of it; `another_hair`: nothing of
// it. Returns what is said where something is lost, to follow a title.
std::string keepBrushed(const Actor& actor, bool another_hair, CharacterSpec& spec);

// The actor's hair as it grows, before ties and attachments, where brushes have made that; else nothing.
std::optional<sim::HairMeshShape> looseBrushed(const Actor& actor);

enum class Dress { kLoose, kTied };  // hair as it grows; as it comes out of its ties

// Puts what brushes have made over hair that was made for `spec`: at another resolution or on another head as much of
// it as leaves every prism positive and no vertex in the body, column by column. The haircut is then edited, and a note
// of it says where that is less than all. Throws sim::MeshError where the hair it is put over is not valid.
void putBrushed(const CharacterSpec& spec, const LoadedBody& body, Haircut& haircut, Dress dress,
                sim::HairMeshShape& shape);

}  // namespace app
