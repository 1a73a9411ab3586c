// What brushes have made of hair, kept where the hair is made anew: tied, under a hat, painted by a picture, at another
// resolution or on another head.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/actor.h"
#include "sim/mesh/field_bytes.h"

namespace app {

// A rest shape that brushes have made, in the scalp's frame.
struct BrushedShape {
  sim::HairMeshShape shape;
  std::vector<Vec3> before;   // m, the same vertices without brushes; empty: the structure is another as well
  std::vector<float> frozen;  // as Haircut has it
};

struct BrushedHair {
  std::uint64_t id = 0;
  std::string hair;  // what brushes worked on: style or file, and its painted length
  std::string body;  // LoadedBody::key
  Resolution resolution = Resolution::kMedium;
  double head_height = 0.23;  // m
  std::optional<BrushedShape> loose;
  std::optional<BrushedShape> tied;  // as it came out of these ties
  std::string ties;
};

// What brushes have made of the actor's hair by now; null: nothing.
std::shared_ptr<const BrushedHair> brushedHair(const Actor& actor);

// Hands to `spec`, for which the actor's hair is made anew, what brushes have made of it; `another_hair`: nothing of
// it. Returns what is said where something is lost, to follow a title.
std::string keepBrushed(const Actor& actor, bool another_hair, CharacterSpec& spec);

enum class Dress { kLoose, kTied };  // hair as it grows; as it comes out of its ties

// Puts what brushes have made over hair that was made for `spec`: at another resolution or on another head as much of
// it as leaves every prism positive and no vertex in the body. The haircut is then edited, and a note of it says where
// that is less than all. Throws sim::MeshError where the hair it is put over is not valid.
void putBrushed(const CharacterSpec& spec, const LoadedBody& body, Haircut& haircut, Dress dress,
                sim::HairMeshShape& shape);

// As a part of a project's binary; null is one too. What cannot be read is null, and the reader then not complete.
void writeBrushed(const BrushedHair* brushed, sim::Bytes& out);
std::shared_ptr<const BrushedHair> readBrushed(sim::ByteReader& from);

}  // namespace app
