// What stands behind the handles of include/hairmesh.h.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/library/handles.h"
#include "app/scene/view/look_params.h"
#include "render/strands/groom_offsets.h"
#include "render/strands/strand_growth.h"
#include "sim/step.h"

namespace app::library {

struct Mesh {
  sim::HairMesh mesh;
  std::vector<std::int32_t> faces;  // four a root face
  int layers = 0;
  std::atomic<int> references{0};
};

// A mesh that its handle and its hairs share.
class MeshRef {
 public:
  MeshRef() = default;
  explicit MeshRef(std::unique_ptr<Mesh> mesh) : mesh_(mesh.release()) { ++mesh_->references; }
  MeshRef(const MeshRef& other) : mesh_(other.mesh_) {
    if (mesh_) ++mesh_->references;
  }
  MeshRef(MeshRef&& other) noexcept : mesh_(std::exchange(other.mesh_, nullptr)) {}
  MeshRef& operator=(MeshRef other) noexcept {
    std::swap(mesh_, other.mesh_);
    return *this;
  }
  ~MeshRef() {
    if (mesh_ && --mesh_->references == 0) delete mesh_;
  }
  const Mesh* operator->() const { return mesh_; }

 private:
  Mesh* mesh_ = nullptr;
};

struct Hair {
  MeshRef shared;
  sim::SimParams params;
  CharacterLook look;
  sim::StepContext context;
  sim::HairState state;
  bool busy = false;  // a call is working on it; guarded by the table
  // Of the step at hand.
  std::vector<sim::Vec3> roots;
  std::vector<sim::Ellipsoid> ellipsoids;
  std::vector<sim::PinnedVertex> pins;
  // Strands, made when they are first asked for, and anew where their number or segments change.
  std::optional<render::StrandGrowth> growth;
  render::GroomOffsets offsets;
  int grown_strands = 0, grown_segments = 0;
  std::vector<float> floats, drawn;
  std::vector<render::CurvePoint> points;

  Hair(MeshRef of, double (*clock)()) : shared(std::move(of)), context(shared->mesh, clock) {}
  const sim::HairMesh& mesh() const { return shared->mesh; }
};

HandleTable<MeshRef>& meshes();
HandleTable<std::unique_ptr<Hair>>& hairs();

// A mesh by its handle. Throws Fault.
MeshRef meshOf(hm_mesh handle);

// A hair for the length of a call. Throws Fault where it does not exist or another call is working on it.
class HairUse {
 public:
  explicit HairUse(hm_hair handle);
  ~HairUse();
  HairUse(const HairUse&) = delete;
  HairUse& operator=(const HairUse&) = delete;
  Hair& operator*() const { return *hair_; }
  Hair* operator->() const { return hair_; }

 private:
  std::uint64_t id_;
  Hair* hair_ = nullptr;
};

}  // namespace app::library
