#include "sim/forces/model.h"

#include <algorithm>

namespace sim {
namespace {

// `before`: elements of the same pattern, whose slots serve where their vertices are the same.
template <class Kind>
void addElement(const ElementOf<Kind>& element, const BlockPattern& pattern, const Elements<Kind, double>& before,
                Elements<Kind, double>& elements) {
  const auto& v = element.vertices;
  const std::size_t e = elements.size();
  elements.vertices.push_back(v);
  elements.stiffness.push_back(element.stiffness);
  elements.shift.push_back(element.shift);
  elements.rest.push_back(element.rest);
  auto& slots = elements.slots.emplace_back();
  if (e < before.size() && before.vertices[e] == v) return void(slots = before.slots[e]);
  int pair = 0;
  for (std::size_t p = 0; p < v.size(); ++p) {
    for (std::size_t q = p + 1; q < v.size(); ++q) {
      slots[pair++] = pattern.find(std::max(v[p], v[q]), std::min(v[p], v[q]));
    }
  }
}

// Calls f with every element of the kind that has a stiffness.
template <class Kind>
void collectStiff(const ForceSource& source, const auto& f) {
  Kind::collect(source, [&](const ElementOf<Kind>& element) {
    if (element.stiffness > 0) f(element);
  });
}

}  // namespace

BlockPattern systemPattern(const HairMesh& mesh) {
  std::vector<std::pair<int, int>> pairs;
  const SimParams any;
  ForceKinds::forEach([&]<class Kind>() {
    Kind::collect(ForceSource{mesh, any}, [&](const ElementOf<Kind>& element) {
      const auto& v = element.vertices;
      for (std::size_t p = 0; p < v.size(); ++p) {
        for (std::size_t q = p + 1; q < v.size(); ++q) pairs.emplace_back(v[p], v[q]);
      }
    });
  });
  return makePattern(mesh.vertexCount(), std::move(pairs));
}

ForceModel<double> makeElements(const ForceSource& source, const BlockPattern& pattern,
                                const ForceModel<double>& before) {
  ForceModel<double> model;
  model.forEach([&]<class Kind>(Elements<Kind, double>& elements) {
    const auto& known = before.of<Kind>();
    collectStiff<Kind>(source, [&](const ElementOf<Kind>& element) { addElement(element, pattern, known, elements); });
  });
  return model;
}

void setMovingElements(const ForceSource& source, const BlockPattern& pattern, ForceModel<double>& model) {
  model.forEach([&]<class Kind>(Elements<Kind, double>& elements) {
    if constexpr (MovingKind<Kind>) {
      elements.clear();
      collectStiff<Kind>(source, [&](const ElementOf<Kind>& element) { addElement(element, pattern, {}, elements); });
    }
  });
}

bool setStiffness(const ForceSource& source, ForceModel<double>& model) {
  bool same = true;
  model.forEachOfMaterial([&]<class Kind>(Elements<Kind, double>& elements) {
    std::size_t e = 0;
    collectStiff<Kind>(source, [&](const ElementOf<Kind>& element) {
      same = same && e < elements.size() && elements.vertices[e] == element.vertices;
      if (same) elements.stiffness[e++] = element.stiffness;
    });
    same = same && e == elements.size();
  });
  return same;
}

bool sameMaterial(const SimParams& a, const SimParams& b) {
  bool same = (a.solver == Solver::kPaper) == (b.solver == Solver::kPaper) && a.density == b.density &&
              a.sag_free == b.sag_free && (a.gravity == b.gravity || !a.sag_free);
  ForceKinds::forEach([&]<class Kind>() {
    for (const Modulus& modulus : Kind::kModuli) same = same && a.*modulus.param == b.*modulus.param;
  });
  return same;
}

}  // namespace sim
