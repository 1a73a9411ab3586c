#include "sim/forces/material.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {
namespace {

V3<double> plain(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

// Bounds of the shifts where the material is too soft to hold the style: strain, shear, rad, share of the volume.
constexpr double kMostStrain = 0.5, kMostShear = 0.5, kMostAngle = 1, kMostVolume = 0.5;

template <int N>
void takeShare(const Elements<double, N>& elements, const std::vector<V3<double>>& x, const std::vector<V3<double>>& y,
               const auto& conditionOf, RestBalance::Share& share) {
  share.change.resize(elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    V3<double> p[N];
    for (int k = 0; k < N; ++k) p[k] = x[elements.vertices[e][k]];
    const Condition<double, N> c = conditionOf(e, p);
    double change = 0;
    for (int k = 0; k < N; ++k) change += dot(c.g[k], y[elements.vertices[e][k]]);
    share.change[e] = change;
  }
}

// The share's shift of element e when its stiffness is `stiffness` and the load `scale` times as large.
double shiftOf(const RestBalance::Share& share, std::size_t e, double stiffness, double scale, double bound) {
  const double change = share.change[e] * (share.stiffness[e] / stiffness) * scale;
  return -std::clamp(change, -bound, bound);
}

}  // namespace

Material::Material(const HairMesh& mesh, const BlockPattern& pattern)
    : mesh_(&mesh), pattern_(&pattern), stiffness_(&pattern) {
  const int n = mesh.vertexCount();
  for (auto* array : {&x_, &load_, &y_, &residual_, &more_}) array->resize(n);
  for (int v = 0; v < n; ++v) x_[v] = plain(mesh.shape.positions[v]);
}

void Material::rebuild() {
  model = makeElements(*mesh_, *pattern_, params_);
  rest_shear_ = model.shear.shift;
  balance_ = coming_ = {};
  stage_ = Stage::kIdle;
}

void Material::set(const SimParams& params) {
  params_ = params;
  if (!setStiffness(*mesh_, params, model)) rebuild();
  stage_ = Stage::kIdle;
  outdated_ = false;
  balance_.load = 0;
  applyBalance();
  if (wantedLoad() <= 0) return;
  beginBalance();
  while (stage_ != Stage::kIdle) continueBalance(std::numeric_limits<double>::infinity());
  factor_.release();
}

void Material::follow(const SimParams& params) {
  params_ = params;
  if (!setStiffness(*mesh_, params, model)) return set(params);
  applyBalance();
  // Weight alone changes no more than the scale.
  const RestBalance& last = stage_ == Stage::kIdle ? balance_ : coming_;
  const bool same = last.load > 0 && last.stretch.stiffness == model.stretch.stiffness &&
                    last.shear.stiffness == model.shear.stiffness && last.bend.stiffness == model.bend.stiffness &&
                    last.volume.stiffness == model.volume.stiffness;
  outdated_ = wantedLoad() > 0 && !same;
}

bool Material::work(int slices) {
  if (stage_ == Stage::kIdle) {
    if (!outdated_) return false;
    beginBalance();
    return false;
  }
  return continueBalance(factor_.factorOperations() / slices);
}

// With C = shift + (change) at the styled pose, balance asks for sum k s g = M a with s the extra shift and a =
// -gravity up; of all solutions the one of least energy is s = -g . y, where K y = M (0, -gravity, 0) and K = sum k g
// g^T over the free vertices: one linear solve.
void Material::beginBalance() {
  outdated_ = false;
  stiffness_.setZero();
  Evaluation<double> out;
  out.matrix = &stiffness_;
  out.matrix_scale = 1;
  evaluate<double>(model, x_, out);
  const int n = mesh_->vertexCount();
  double scale = 0;
  for (int i = 0; i < n; ++i) scale = std::max(scale, stiffness_.diagonal[i].m[0]);
  coming_.load = wantedLoad();
  for (int i = 0; i < n; ++i) {
    load_[i] = {0, mesh_->isRoot(i) ? 0 : -params_.density * mesh_->vertex_volume[i] * params_.gravity, 0};
    // A material without bend or shear leaves modes without stiffness; the smallest share keeps the solve defined.
    for (int k = 0; k < 9; k += 4) stiffness_.diagonal[i].m[k] += 1e-13 * scale;
  }
  coming_.stretch.stiffness = model.stretch.stiffness;
  coming_.shear.stiffness = model.shear.stiffness;
  coming_.bend.stiffness = model.bend.stiffness;
  coming_.volume.stiffness = model.volume.stiffness;
  if (factor_.order.empty()) {
    std::vector<unsigned char> free_vertex(n);
    for (int i = 0; i < n; ++i) free_vertex[i] = !mesh_->isRoot(i);
    factor_.analyze(*mesh_, *pattern_, free_vertex);
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
      if (!outdated_) factor_.release();
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
  coming_.stretch.change.resize(model.stretch.size());
  for (std::size_t e = 0; e < model.stretch.size(); ++e) {
    const auto [a, b] = model.stretch.vertices[e];
    const auto s = stretchCondition(x_[a], x_[b], model.stretch.inverse_length[e]);
    coming_.stretch.change[e] = s.inverse_length * dot(s.direction, y_[b] - y_[a]);
  }
  const auto& shear = model.shear;
  takeShare<4>(
      shear, x_, y_,
      [&](std::size_t e, const V3<double>* p) {
        return shearCondition(p, shear.inverse_along[e], shear.inverse_across[e]);
      },
      coming_.shear);
  const auto& bend = model.bend;
  takeShare<6>(
      bend, x_, y_,
      [&](std::size_t e, const V3<double>* p) {
        return bendCondition(p, bend.rest_angle[e], bend.inverse_length[e], bend.smallest_square[e]);
      },
      coming_.bend);
  takeShare<4>(
      model.volume, x_, y_,
      [&](std::size_t e, const V3<double>* p) { return volumeCondition(p, model.volume.rest_volume[e]); },
      coming_.volume);
  std::swap(balance_, coming_);
}

void Material::applyBalance() {
  const double load = wantedLoad();
  const bool balanced = load > 0 && balance_.load > 0;
  const double scale = balanced ? load / balance_.load : 0;
  const auto apply = [&](auto& elements, const RestBalance::Share& share, const auto& baseOf, const auto& boundOf) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      elements.shift[e] = baseOf(e);
      if (balanced) elements.shift[e] += shiftOf(share, e, elements.stiffness[e], scale, boundOf(e));
    }
  };
  const auto zero = [](std::size_t) { return 0.0; };
  apply(model.stretch, balance_.stretch, zero, [](std::size_t) { return kMostStrain; });
  apply(
      model.shear, balance_.shear, [&](std::size_t e) { return rest_shear_[e]; },
      [](std::size_t) { return kMostShear; });
  apply(model.bend, balance_.bend, zero, [&](std::size_t e) { return kMostAngle * model.bend.inverse_length[e]; });
  apply(model.volume, balance_.volume, zero, [&](std::size_t e) { return kMostVolume * model.volume.rest_volume[e]; });
}

ForceModel<double> makeForceModel(const HairMesh& mesh, const BlockPattern& pattern, const SimParams& params) {
  Material material(mesh, pattern);
  material.set(params);
  return std::move(material.model);
}

}  // namespace sim
