#include "sim/forces/rest_balance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/forces/evaluate.h"
#include "sim/linear/elimination_order.h"

namespace sim {
namespace {

V3<double> plain(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

template <class Kind>
constexpr int kIndex = ForceKinds::indexOf<Kind>();

}  // namespace

Material::Material(const HairMesh& mesh, const BlockPattern& pattern)
    : mesh_(&mesh), pattern_(&pattern), stiffness_(&pattern) {
  const int n = mesh.vertexCount();
  for (auto* array : {&x_, &load_, &y_, &residual_, &more_}) array->resize(n);
  for (int v = 0; v < n; ++v) x_[v] = plain(mesh.shape.positions[v]);
}

void Material::setMoving(std::span<const PinnedVertex> pins) {
  setMovingElements({*mesh_, params_, pins}, *pattern_, model);
}

void Material::rebuild() {
  model = makeElements({*mesh_, params_}, *pattern_);
  model.forEachOfMaterial(
      [&]<class Kind>(const Elements<Kind, double>& elements) { unloaded_[kIndex<Kind>] = elements.shift; });
  balance_ = coming_ = {};
  stage_ = Stage::kIdle;
}

void Material::set(const SimParams& params) {
  params_ = params;
  if (!setStiffness({*mesh_, params}, model)) rebuild();
  stage_ = Stage::kIdle;
  memory_ = {.known = true, .params = params, .balanced = params, .coming = params};
  balance_.load = 0;
  applyBalance();
  if (wantedLoad() <= 0) return;
  beginBalance();
  while (stage_ != Stage::kIdle) continueBalance(std::numeric_limits<double>::infinity());
  memory_.slices = 0;
  factor_.release();
}

void Material::follow(const SimParams& params) {
  params_ = params;
  if (!setStiffness({*mesh_, params}, model)) return set(params);
  applyBalance();
  // Weight alone changes no more than the scale.
  const RestBalance& last = stage_ == Stage::kIdle ? balance_ : coming_;
  bool same = last.load > 0;
  model.forEachOfMaterial([&]<class Kind>(const Elements<Kind, double>& elements) {
    same = same && last.stiffness[kIndex<Kind>] == elements.stiffness;
  });
  memory_.params = params;
  memory_.outdated = wantedLoad() > 0 && !same;
}

void Material::reshape() {
  for (std::size_t v = 0; v < x_.size(); ++v) x_[v] = plain(mesh_->shape.positions[v]);
  if (!memory_.known) return;
  RestBalance kept = std::move(balance_);
  rebuild();
  balance_ = std::move(kept);
  applyBalance();
  memory_.slices = 0;
  memory_.outdated = wantedLoad() > 0;
}

bool Material::work() {
  if (stage_ == Stage::kIdle) {
    if (!memory_.outdated) return false;
    beginBalance();
    return false;
  }
  ++memory_.slices;
  const bool changed = continueBalance(factor_.factorOperations() / kSlices);
  if (stage_ == Stage::kIdle) memory_.slices = 0;
  if (changed) memory_.balanced = memory_.coming;
  return changed;
}

bool Material::recall(const MaterialMemory& memory) {
  const auto same = [](const MaterialMemory& a, const MaterialMemory& b) {
    return a.known == b.known && a.slices == b.slices && a.outdated == b.outdated && sameMaterial(a.params, b.params) &&
           sameMaterial(a.balanced, b.balanced) && (a.slices == 0 || sameMaterial(a.coming, b.coming));
  };
  if (same(memory, memory_) || !memory.known) return false;
  set(memory.balanced);
  if (memory.slices > 0) {
    params_ = memory.coming;
    setStiffness({*mesh_, params_}, model);
    beginBalance();
    for (int k = 1; k < memory.slices; ++k) work();
  }
  params_ = memory.params;
  setStiffness({*mesh_, params_}, model);
  applyBalance();
  memory_ = memory;
  return true;
}

// With C = shift + (change) at the styled pose, balance asks for sum k s g = M a with s the extra shift and a =
// -gravity up; of all solutions the one of least energy is s = -g . y, where K y = M (0, -gravity, 0) and K = sum k g
// g^T over the free vertices: one linear solve.
void Material::beginBalance() {
  memory_.outdated = false;
  memory_.coming = params_;
  memory_.slices = 1;
  stiffness_.setZero();
  Evaluation<double> out;
  out.matrix = &stiffness_;
  out.matrix_scale = 1;
  double energy = 0;
  model.forEachOfMaterial([&](const auto& elements) {
    evaluateElements(elements, BlockSums<double>{x_, out}, energy);
  });
  const int n = mesh_->vertexCount();
  double scale = 0;
  for (int i = 0; i < n; ++i) scale = std::max(scale, stiffness_.diagonal[i].m[0]);
  coming_.load = wantedLoad();
  for (int i = 0; i < n; ++i) {
    load_[i] = {0, mesh_->isRoot(i) ? 0 : -params_.density * mesh_->vertex_volume[i] * params_.gravity, 0};
    // A material without bend or shear leaves modes without stiffness; the smallest share keeps the solve defined.
    for (int k = 0; k < 9; k += 4) stiffness_.diagonal[i].m[k] += 1e-13 * scale;
  }
  model.forEachOfMaterial([&]<class Kind>(const Elements<Kind, double>& elements) {
    coming_.stiffness[kIndex<Kind>] = elements.stiffness;
  });
  if (factor_.order.empty()) {
    std::vector<unsigned char> free_vertex(n);
    for (int i = 0; i < n; ++i) free_vertex[i] = !mesh_->isRoot(i);
    factor_.analyze(*pattern_, minimumDegreeOrder(*pattern_, free_vertex));
  }
  factor_.beginFactor();
  stage_ = Stage::kFactor;
}

// One stage, or a slice of the factorization.
bool Material::continueBalance(double operations) {
  switch (stage_) {
    case Stage::kIdle:
      return false;
    case Stage::kFactor: {
      using Progress = BlockCholesky<double>::Progress;
      const Progress progress = factor_.continueFactor(stiffness_, operations);
      if (progress == Progress::kDone) stage_ = Stage::kSolve;
      if (progress == Progress::kFailed) stage_ = Stage::kIdle;
      return false;
    }
    case Stage::kSolve:
      factor_.solve(load_, y_);
      stage_ = Stage::kRefine;
      return false;
    case Stage::kRefine:
      stage_ = refine() ? Stage::kShifts : Stage::kIdle;
      return false;
    case Stage::kShifts:
      takeChanges();
      applyBalance();
      stage_ = Stage::kIdle;
      if (!memory_.outdated) factor_.release();
      return true;
  }
  return false;
}

bool Material::refine() {
  multiply<double>(stiffness_, y_, residual_);
  for (std::size_t i = 0; i < y_.size(); ++i) residual_[i] = load_[i] - residual_[i];
  factor_.solve(residual_, more_);
  for (std::size_t i = 0; i < y_.size(); ++i) {
    y_[i] += more_[i];
    if (!std::isfinite(dot(y_[i], y_[i]))) return false;
  }
  return true;
}

void Material::takeChanges() {
  model.forEachOfMaterial([&]<class Kind>(const Elements<Kind, double>& elements) {
    std::vector<double>& changes = coming_.change[kIndex<Kind>];
    changes.resize(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const auto& v = elements.vertices[e];
      V3<double> p[Kind::kVertices];
      for (int k = 0; k < Kind::kVertices; ++k) p[k] = x_[v[k]];
      const auto c = Kind::condition(p, elements.rest[e], 0.0);
      double change = 0;
      for (int k = 0; k < Kind::kVertices; ++k) change += dot(c.g[k], y_[v[k]]);
      changes[e] = change;
    }
  });
  std::swap(balance_, coming_);
}

// What balances gravity is the product of stiffness and shift: a balance serves other stiffnesses and loads too.
void Material::applyBalance() {
  const double load = wantedLoad();
  const bool balanced = load > 0 && balance_.load > 0;
  const double scale = balanced ? load / balance_.load : 0;
  model.forEachOfMaterial([&]<class Kind>(Elements<Kind, double>& elements) {
    const std::vector<double>&change = balance_.change[kIndex<Kind>], &stiffness = balance_.stiffness[kIndex<Kind>];
    for (std::size_t e = 0; e < elements.size(); ++e) {
      elements.shift[e] = unloaded_[kIndex<Kind>][e];
      if (!balanced) continue;
      const double bound = Kind::maxShift(elements.rest[e]);
      elements.shift[e] -= std::clamp(change[e] * (stiffness[e] / elements.stiffness[e]) * scale, -bound, bound);
    }
  });
}

ForceModel<double> makeForceModel(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params) {
  Material material(mesh, pattern);
  material.set(params);
  return std::move(material.model);
}

}  // namespace sim
