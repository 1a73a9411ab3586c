#include "tests/bench/bullet_peer.h"

#ifdef HAIRMESH_BULLET
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <algorithm>
#include <set>

namespace bench {
namespace {

btVector3 toBullet(const sim::Vec3& p) {
  return {static_cast<btScalar>(p.x()), static_cast<btScalar>(p.y()), static_cast<btScalar>(p.z())};
}

}  // namespace

// The order of the members is that of their construction: worlds before what lies in them, forces last.
struct BulletHair::Parts {
  const sim::HairMesh& mesh;
  BulletMethod method;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver rigid_solver;
  btDeformableBodySolver deformable_solver;
  btDeformableMultiBodyConstraintSolver deformable_constraints;
  std::unique_ptr<btSoftRigidDynamicsWorld> world;
  std::unique_ptr<btDeformableMultiBodyDynamicsWorld> deformable_world;
  std::unique_ptr<btSoftBody> body;
  std::vector<std::unique_ptr<btDeformableLagrangianForce>> forces;

  Parts(const sim::HairMesh& m, BulletMethod chosen) : mesh(m), method(chosen) {}

  void makeWorld(const btVector3& gravity) {
    if (method == BulletMethod::kImplicit) {
      deformable_constraints.setDeformableSolver(&deformable_solver);
      deformable_world = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
          &dispatcher, &broadphase, &deformable_constraints, &configuration, &deformable_solver);
      deformable_world->setImplicit(true);
      deformable_world->setLineSearch(false);
      deformable_world->setUseProjection(true);  // without it, implicit bodies do not move at all (3.24)
      deformable_world->setGravity(gravity);
      deformable_world->getWorldInfo().m_gravity = gravity;
    } else {
      world = std::make_unique<btSoftRigidDynamicsWorld>(&dispatcher, &broadphase, &rigid_solver, &configuration);
      world->setGravity(gravity);
      world->getWorldInfo().m_gravity = gravity;
    }
  }
  btSoftBodyWorldInfo& info() { return world ? world->getWorldInfo() : deformable_world->getWorldInfo(); }

  void addLinks() {
    std::set<std::pair<int, int>> pairs;
    const auto add = [&](int a, int b) { pairs.insert(std::minmax(a, b)); };
    for (const auto* edges : {&mesh.horizontal_edges, &mesh.vertical_edges}) {
      for (const sim::Edge& edge : *edges) add(edge.a, edge.b);
    }
    // Bullet's own way with tetrahedra (btSoftBodyHelpers::CreateFromTetGenData): links along all their edges.
    if (method != BulletMethod::kImplicit) {
      for (const sim::CornerTet& tet : mesh.tets) {
        for (int i = 0; i < 4; ++i) {
          for (int j = i + 1; j < 4; ++j) add(tet.v[i], tet.v[j]);
        }
      }
    }
    for (const auto& [a, b] : pairs) {
      if (!mesh.isRoot(a) || !mesh.isRoot(b)) body->appendLink(a, b);
    }
  }

  // Springs of one stiffness: the mean over the edges along the hair of modulus x volume / length^2. Tetrahedra: ours
  // resist volume alone; a tenth of that modulus as shear keeps theirs from collapsing.
  void addForces(const sim::SimParams& params) {
    double stiffness = 0;
    for (const sim::Edge& edge : mesh.vertical_edges) {
      stiffness += params.stretch_along * edge.volume / (edge.rest_length * edge.rest_length);
    }
    stiffness /= static_cast<double>(mesh.vertical_edges.size());
    for (const sim::CornerTet& tet : mesh.tets) body->appendTetra(tet.v[0], tet.v[1], tet.v[2], tet.v[3]);
    body->initializeDmInverse();
    body->m_tetraScratches.resize(body->m_tetras.size());
    body->m_tetraScratchesTn.resize(body->m_tetras.size());
    const auto scalar = [](double value) { return static_cast<btScalar>(value); };
    forces.push_back(std::make_unique<btDeformableMassSpringForce>(
        scalar(stiffness), scalar(stiffness * params.damping), true, scalar(0)));
    forces.push_back(std::make_unique<btDeformableNeoHookeanForce>(scalar(0.1 * params.volume), scalar(params.volume),
                                                                   scalar(params.damping)));
    forces.push_back(std::make_unique<btDeformableGravityForce>(info().m_gravity));
    for (const auto& force : forces) deformable_world->addForce(body.get(), force.get());
  }
};

const char* bulletMethodName(BulletMethod method) {
  switch (method) {
    case BulletMethod::kPositions10:
      return "Bullet soft body, 10 position iterations";
    case BulletMethod::kPositions50:
      return "Bullet soft body, 50 position iterations";
    default:
      return "Bullet deformable body, implicit";
  }
}

BulletHair::BulletHair(const sim::HairMesh& mesh, const sim::SimParams& params, std::span<const sim::Vec3> rest,
                       BulletMethod method)
    : parts_(std::make_unique<Parts>(mesh, method)) {
  parts_->makeWorld({0, static_cast<btScalar>(-params.gravity), 0});
  std::vector<btVector3> nodes;
  std::vector<btScalar> masses;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    nodes.push_back(toBullet(rest[i]));
    const double mass = mesh.isRoot(static_cast<int>(i)) ? 0 : params.density * mesh.vertex_volume[i];
    masses.push_back(static_cast<btScalar>(mass));
  }
  parts_->body =
      std::make_unique<btSoftBody>(&parts_->info(), static_cast<int>(nodes.size()), nodes.data(), masses.data());
  btSoftBody& body = *parts_->body;
  body.m_cfg.collisions = 0;
  body.m_cfg.piterations = method == BulletMethod::kPositions50 ? 50 : 10;
  body.m_cfg.kDP = static_cast<btScalar>(params.air_drag / 60);  // share of the velocity lost a step
  body.m_materials[0]->m_kLST = 1;
  body.setSelfCollision(false);
  body.setActivationState(DISABLE_DEACTIVATION);
  parts_->addLinks();
  if (parts_->world) {
    parts_->world->addSoftBody(&body);
  } else {
    parts_->deformable_world->addSoftBody(&body);
    parts_->addForces(params);
  }
}

BulletHair::~BulletHair() {
  if (!parts_) return;
  if (parts_->world) parts_->world->removeSoftBody(parts_->body.get());
  if (parts_->deformable_world) {
    parts_->deformable_world->removeSoftBodyForce(parts_->body.get());
    parts_->deformable_world->removeSoftBody(parts_->body.get());
  }
}
BulletHair::BulletHair(BulletHair&&) noexcept = default;

void BulletHair::place(std::span<const sim::Vec3> positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    btSoftBody::Node& node = parts_->body->m_nodes[static_cast<int>(i)];
    node.m_x = node.m_q = toBullet(positions[i]);
    node.m_v = node.m_vn = node.m_f = node.m_splitv = btVector3(0, 0, 0);
  }
}

void BulletHair::step(std::span<const sim::Vec3> roots, double dt) {
  const sim::HairMesh& mesh = parts_->mesh;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    btSoftBody::Node& node = parts_->body->m_nodes[mesh.shape.column_first[c]];
    node.m_x = node.m_q = toBullet(roots[c]);
    node.m_v = node.m_vn = btVector3(0, 0, 0);
  }
  if (parts_->world) {
    parts_->world->stepSimulation(static_cast<btScalar>(dt), 0);
  } else {
    parts_->deformable_world->stepSimulation(static_cast<btScalar>(dt), 0);
  }
}

void BulletHair::readPositions(std::vector<sim::Vec3>& positions) const {
  positions.resize(parts_->body->m_nodes.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const btVector3& p = parts_->body->m_nodes[static_cast<int>(i)].m_x;
    positions[i] = {p.x(), p.y(), p.z()};
  }
}

}  // namespace bench
#endif
