// What every kind of character shares once its skeleton, mesh and clips are there: head, scalp and collision
// ellipsoids.
#pragma once

#include "app/figure/character.h"
#include "app/figure/character_roles.h"
#include "app/figure/ellipsoid_fit.h"
#include "app/figure/scalp_sampling.h"

namespace app {

// A body part to fit: its name, the joint it moves with, the vertices that belong to it, and where to start. Points and
// start are in the model's rest pose; a part with `given_start` keeps the start's far side where no points are.
struct BodyPart {
  std::string name;
  int joint = 0;
  std::vector<FitPoint> points;
  bool given_start = false;
  BodyEllipsoid start;
  double hold = 0.05;  // m, see fitEllipsoid
  double outside = 1;  // see fitEllipsoid
};

// Fits one ellipsoid a part (parts of under eight points are left out) and notes mean and largest gap.
void fitParts(std::vector<BodyPart> parts, Character& character);

// Vertices with the area that each stands for, rest pose.
std::vector<FitPoint> surfacePoints(const SkinnedMesh& mesh);

// The joint with the largest weight of each vertex.
std::vector<int> dominantJoints(const SkinnedMesh& mesh);

// The parts of any skinned character: one a joint with enough skin, small joints (fingers, toes, face) joined to the
// part above them, the head split into cranium and jaw.
std::vector<BodyPart> partsByJoint(const Character& character, const BodyRoles& roles);

// Samples the scalp from the triangles that hang on the head joint or below it; head_joint and head_frame must be set.
// `measure`: landmarks where they are known, else null.
void sampleHead(const HeadMeasure* measure, Character& character);

// drawn: the skin to show, in place of that which ellipsoids are fitted to.
Character loadMannequin(const std::string& text, const std::string& file, SkinnedMesh& drawn);
Character loadRigidParts(const std::string& text, const std::string& file, const std::string& parts_dir);
// told: see readToldBody.
Character importSkinned(const std::string& file, const std::string& told);

}  // namespace app
