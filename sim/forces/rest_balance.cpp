#include "sim/forces/rest_balance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/forces/kernels.h"
#include "sim/linear/modified_pcg.h"
#include "sim/linear/two_level.h"

namespace sim {
namespace {

constexpr double kResidual = 2e-10;  // of a vertex's weight
constexpr int kMaxIterations = 3000;
constexpr int kPatience = 1000, kDoubling = 100;   // iterations: rounding keeps some hair from kResidual
constexpr int kSmallHair = 1000, kLeastSlice = 6;  // vertices up to which slices are whole; iterations
constexpr int kReshapeWait = 5;                    // steps: a stroke changes the shape again

template <class Kind>
constexpr int kIndex = ForceKinds::indexOf<Kind>();

}  // namespace

// K y = load at the styled pose, by preconditioned conjugate gradients from y = 0. K = sum k g g^T; roots are held.
struct Material::Solve {
  ColumnLayout layout;
  ColumnPattern columns;
  ColumnModel<double> elements;
  ColumnMatrix<double> k;
  ColumnProduct<double> product;
  ColumnField<double> packed;
  TwoLevel<double> preconditioner;
  Filter<double> free;
  std::vector<V3<double>> x, load, y, r, z, d, q;
  bool assembled = false;
  double square = 0;  // r . P r
  int iterations = 0;

  explicit Solve(const HairMesh& mesh)
      : layout(mesh),
        columns(mesh, layout),
        elements(mesh, layout, columns),
        k(layout, columns),
        product(layout),
        packed(layout),
        preconditioner(mesh) {
    for (auto* array : {&load, &y, &r, &z, &d, &q}) array->resize(mesh.vertexCount());
    for (const Vec3& p : mesh.shape.positions) x.push_back({p.x(), p.y(), p.z()});
    packed.pack(layout, x);
    free.vertices.assign(mesh.shape.column_first.begin(), mesh.shape.column_first.end() - 1);
    free.keep.resize(mesh.columnCount());
  }

  // Takes the elements, the weight (N/m^3) and where to begin; assemble() is a step's work of its own.
  void begin(const HairMesh& mesh, const ForceModel<double>& model, double weight, std::span<const V3<double>> start) {
    elements.setElements(mesh, layout, model);
    for (int i = 0; i < mesh.vertexCount(); ++i) load[i] = {0, -weight * mesh.vertex_volume[i], 0};
    free.apply(load);
    start.size() == y.size() ? y.assign(start.begin(), start.end()) : y.assign(y.size(), {});
    free.apply(y);
    assembled = false;
    iterations = 0;
  }

  void assemble() {
    k.setZero();
    ColumnEvaluation<double> out;
    out.matrix = &k;
    out.matrix_scale = 1;
    evaluate<double>(elements, layout, packed, out);
    double scale = 0;
    for (std::size_t i = 0; i < x.size(); ++i) scale = std::max(scale, k.diagonalBlock(static_cast<int>(i)).m[0]);
    // A material without bend or shear leaves modes without stiffness; the smallest share keeps the solve defined.
    k.addMass(1e-13 * scale, std::vector<double>(load.size(), 1));
    preconditioner.memory.forget();
    preconditioner.update(k, x);
    restart();
    assembled = true;
  }

  void restart() {
    multiply<double>(k, product, y, r);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = load[i] - r[i];
    free.apply(r);
    square = precondition();
    d = z;
  }

  double precondition() {
    preconditioner.apply(r, z);
    free.apply(z);
    return innerProduct<double>(r, z);
  }

  bool iterate() {
    multiply<double>(k, product, d, q);
    free.apply(q);
    const double curvature = innerProduct<double>(d, q), before = square;
    if (!(curvature > 0)) return false;
    addScaled<double>(before / curvature, d, y);
    addScaled<double>(-before / curvature, q, r);
    square = precondition();
    scaleAndAdd<double>(square / before, z, d);
    return ++iterations < kMaxIterations;
  }

  bool balanced() const {
    const double allowed = std::ldexp(kResidual, std::max(0, iterations - kPatience) / kDoubling);
    for (std::size_t i = 0; i < r.size(); ++i) {
      if (!(dot(r[i], r[i]) <= allowed * allowed * load[i].y * load[i].y)) return false;
    }
    return true;
  }
};

Material::Material(const HairMesh& mesh, const BlockPattern& pattern) : mesh_(&mesh), pattern_(&pattern) {}
Material::~Material() = default;

void Material::setMoving(std::span<const PinnedVertex> pins) {
  setMovingElements({*mesh_, params_, pins}, *pattern_, model);
}

void Material::rebuild() {
  model = makeElements({*mesh_, params_}, *pattern_, model);
  model.forEachOfMaterial(
      [&]<class Kind>(const Elements<Kind, double>& elements) { unloaded_[kIndex<Kind>] = elements.shift; });
  balance_ = coming_ = {};
  solving_ = false;
}

void Material::beginAnew(const SimParams& params) {
  params_ = params;
  if (!setStiffness({*mesh_, params}, model)) rebuild();
  solving_ = false;
  memory_ = {.known = true, .params = params, .balanced = params, .coming = params};
  balance_.load = 0;
  applyBalance();
  sag_.clear();
  if (wantedLoad() > 0) beginBalance();
}

void Material::set(const SimParams& params) {
  beginAnew(params);
  while (solving_) continueBalance(kMaxIterations);
  memory_.slices = 0;
  solve_.reset();
}

bool Material::start(const SimParams& params) {
  if (start_.empty()) return false;
  beginAnew(params);
  if (solving_) continueBalance(0), continueBalance(kFirst);  // the first call assembles
  if (!solving_) return memory_.slices = 0, true;
  takeChanges();
  coming_ = balance_;
  applyBalance();
  return true;
}

void Material::follow(const SimParams& params) {
  params_ = params;
  if (!setStiffness({*mesh_, params}, model)) return set(params);
  applyBalance();
  // Weight alone changes no more than the scale.
  const RestBalance& last = solving_ ? coming_ : balance_;
  bool same = last.load > 0;
  model.forEachOfMaterial([&]<class Kind>(const Elements<Kind, double>& elements) {
    same = same && last.stiffness[kIndex<Kind>] == elements.stiffness;
  });
  memory_.params = params;
  memory_.outdated = wantedLoad() > 0 && !same;
}

void Material::reshape() {
  solve_.reset();  // it knows the old shape
  solving_ = false;
  if (!memory_.known) return;
  RestBalance kept = std::move(balance_);
  rebuild();
  balance_ = std::move(kept);
  applyBalance();
  memory_.slices = -kReshapeWait;
  memory_.outdated = wantedLoad() > 0;
}

bool Material::work() {
  if (!solving_) {
    if (memory_.outdated && ++memory_.slices > 0) beginBalance();
    return false;
  }
  ++memory_.slices;
  const double share = std::min(1.0, static_cast<double>(kSmallHair) / mesh_->vertexCount());
  const bool changed = continueBalance(std::max(kLeastSlice, static_cast<int>(kSlice * share * std::sqrt(share))));
  if (!solving_) memory_.slices = 0;
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
  coming_.load = wantedLoad();
  model.forEachOfMaterial([&]<class Kind>(const Elements<Kind, double>& elements) {
    coming_.stiffness[kIndex<Kind>] = elements.stiffness;
  });
  if (!solve_) solve_ = std::make_unique<Solve>(*mesh_);
  solve_->begin(*mesh_, model, coming_.load, std::exchange(start_, {}));
  solving_ = true;
}

// Assembles, or makes so many iterations or those that are left. Returns whether a balance was found.
bool Material::continueBalance(int iterations) {
  bool goes_on = true;
  if (!solve_->assembled) {
    solve_->assemble();
    return false;
  }
  for (int i = 0; i < iterations && goes_on; ++i) {
    if (solve_->balanced()) solve_->restart();  // rounding has spoilt the residual
    goes_on = !solve_->balanced() && solve_->iterate();
  }
  if (goes_on) return false;
  solving_ = false;
  const bool finite = std::ranges::all_of(solve_->y, [](const V3<double>& y) { return std::isfinite(dot(y, y)); });
  if (finite) takeChanges();
  applyBalance();
  if (!memory_.outdated) solve_.reset();
  return finite;
}

void Material::takeChanges() {
  model.forEachOfMaterial([&]<class Kind>(const Elements<Kind, double>& elements) {
    std::vector<double>& changes = coming_.change[kIndex<Kind>];
    changes.resize(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const auto& v = elements.vertices[e];
      V3<double> p[Kind::kVertices];
      for (int k = 0; k < Kind::kVertices; ++k) p[k] = solve_->x[v[k]];
      const auto c = Kind::condition(p, elements.rest[e], 0.0);
      double change = 0;
      for (int k = 0; k < Kind::kVertices; ++k) change += dot(c.g[k], solve_->y[v[k]]);
      changes[e] = change;
    }
  });
  std::swap(balance_, coming_);
  sag_ = solve_->y;
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

}  // namespace sim
