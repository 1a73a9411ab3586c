// Hair of a file, for the head at hand: a hair mesh as it is, or curves, strips and tubes that become one.
#pragma once

#include "app/figure/character.h"
#include "app/scene/actor.h"

namespace app {

// Unit, axes and place are inferred as fitHair does, and curves mended as the inspector is certain of and the scene
// asks for, where `spec.fit` says so. What was found and done goes to the haircut's note and findings, what makes a
// groom's strands individual to its look and fields. Throws InputError.
sim::HairMeshShape hairFromFile(const CharacterSpec& spec, const Character& character, Haircut& haircut);

// The character's fields with those that its hair's file brings, where it has none or those of the hair before, until
// it has been given them; a groom that brings none is alike everywhere.
FieldFiles withFields(const Haircut& haircut, const CharacterSpec& spec);

// Puts a file's hair in the place of the character's own, and an empty name its style's: the look that the file brings
// goes over that of the hair before, and away with the file.
void chooseHair(const std::string& file, CharacterSpec& spec);

}  // namespace app
