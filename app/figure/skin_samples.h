// Samples of the skin that hair can reach, at moments of a character's clips.
#pragma once

#include <cstddef>
#include <vector>

#include "app/figure/character.h"

namespace app {

struct SkinSample {
  Vec3 rest, normal;  // m; unit; of the model's rest pose
  double weight;      // share of all samples' area
  int vertex, joint;  // of the mesh without long edges; the nearest joint from the vertex's own upwards that carries an
                      // ellipsoid
  bool of_head;       // above the chin but for mouth, chin and neck: styles grow around it as it is
};

// A place is a sample at a moment: moment * samples.size() + sample. Moment 0 is the rest pose.
struct PosedSkin {
  std::vector<SkinSample> samples;
  std::vector<std::vector<Rigid>> to_joint;  // per moment and joint: world to joint
  std::vector<std::vector<Vec3>> world;      // m, per moment and sample
  std::vector<unsigned char> reached;        // per place: whether hair can come there
  std::vector<Vec3> air;                     // m, rest pose: free places in front of samples, where hair may lie

  std::size_t momentOf(std::size_t place) const { return place / samples.size(); }
  const SkinSample& sampleOf(std::size_t place) const { return samples[place % samples.size()]; }
  // As the sample's joint turns it: exact for rigid parts.
  Vec3 normalAt(std::size_t place) const {
    const auto joint = static_cast<std::size_t>(sampleOf(place).joint);
    return to_joint[momentOf(place)][joint].linear().transpose() * to_joint[0][joint].linear() * sampleOf(place).normal;
  }
  Vec3 inJoint(std::size_t place, int joint) const {
    return to_joint[momentOf(place)][static_cast<std::size_t>(joint)] * world[momentOf(place)][place % samples.size()];
  }
};

// Samples at most `most` vertices, of the skin and of its long edges' divisions, that come within three head heights of
// the head at rest or at one of `moments` moments spread over the clips. Empty where none does or no ellipsoid is
// there. Deterministic.
PosedSkin poseSkin(const Character& character, std::size_t most, int moments);

}  // namespace app
