// Bullet's soft body wearing the same hair mesh, as an outside peer. Built where Bullet (Debian: libbullet-dev) is
// installed; HAIRMESH_BULLET says so.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"
#include "sim/sim_params.h"

namespace bench {

// How Bullet is asked to simulate.
enum class BulletMethod {
  kPositions10,  // btSoftBody: links along every edge of the mesh and of its tetrahedra, 10 position iterations
  kPositions50,  // the same with 50
  kImplicit      // btDeformableMultiBodyDynamicsWorld, implicit: springs on the mesh's edges, Neo-Hookean tetrahedra
};
const char* bulletMethodName(BulletMethod method);

class BulletHair {
 public:
  // Nodes are the mesh's vertices with its masses, roots are prescribed. `rest`: the rest shape in the world. Springs
  // and tetrahedra of the implicit method take their stiffness from the same moduli as ours.
  BulletHair(const sim::HairMesh& mesh, const sim::SimParams& params, std::span<const sim::Vec3> rest,
             BulletMethod method);
  ~BulletHair();
  BulletHair(BulletHair&&) noexcept;

  // Puts the vertices there, at rest.
  void place(std::span<const sim::Vec3> positions);
  // Advances by dt with the roots carried to `roots`.
  void step(std::span<const sim::Vec3> roots, double dt);
  void readPositions(std::vector<sim::Vec3>& positions) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace bench
