// The list of force kinds. Model, plain evaluation, balance of gravity, change of parameters, energy limit, naming of
// faults and the finite-difference tests loop over it.
#pragma once

#include <string_view>
#include <tuple>
#include <vector>

#include "sim/forces/bend.h"
#include "sim/forces/fold.h"
#include "sim/forces/force_kind.h"
#include "sim/forces/pin.h"
#include "sim/forces/shear.h"
#include "sim/forces/stretch.h"
#include "sim/forces/volume.h"

namespace sim {

// Elements of one kind: vertices, stiffness, constants and shift of each. `slots`: the matrix block of each vertex pair
// (p, q), p < q, in lexicographic order.
template <class Kind, class T>
struct Elements {
  static constexpr int kPairs = Kind::kVertices * (Kind::kVertices - 1) / 2;
  std::vector<std::array<int, Kind::kVertices>> vertices;
  std::vector<std::array<int, kPairs>> slots;
  std::vector<T> stiffness, shift;
  std::vector<std::array<T, Kind::kRest>> rest;
  std::size_t size() const { return vertices.size(); }
  void clear() { vertices.clear(), slots.clear(), stiffness.clear(), shift.clear(), rest.clear(); }
};

template <ForceKind... Kinds>
struct KindList {
  static constexpr int kCount = sizeof...(Kinds);
  static constexpr std::array<const char*, kCount> kNames{Kinds::kName...};
  template <class T>
  using Tables = std::tuple<Elements<Kinds, T>...>;

  // Calls f.operator()<Kind>() for each kind in turn.
  static void forEach(auto&& f) { (f.template operator()<Kinds>(), ...); }
  template <class Kind>
  static constexpr bool contains() {
    return (std::same_as<Kind, Kinds> || ...);
  }
  template <class Kind>
  static constexpr int indexOf() {
    int at = 0;
    static_cast<void>(((std::same_as<Kind, Kinds> || (++at, false)) || ...));
    return at;
  }
};

using ForceKinds = KindList<  //
    Stretch,                  //
    Shear,                    //
    Bend,                     //
    Volume,                   //
    Fold,                     //
    Pin>;

static_assert(
    [] {
      for (std::size_t a = 0; a < ForceKinds::kNames.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          if (std::string_view(ForceKinds::kNames[a]) == ForceKinds::kNames[b]) return false;
        }
      }
      return true;
    }(),
    "two force kinds of one name");

}  // namespace sim
