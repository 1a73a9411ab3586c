// The list of force kinds: no part of a kind can be forgotten, and each runs everywhere.
#include "sim/forces/kinds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "sim/forces/rest_balance.h"
#include "sim/stabilization/state_validation.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace kinds_test {

using sim::ElementOf;
using sim::ForceKinds;
using sim::ForceSource;
using sim::SimParams;

// A kind with every part, and kinds that lack one each.
enum class Part { kNone, kName, kUnit, kRest, kModuli, kCollect, kCondition, kMaxShift, kCurved, kCurvature };
template <Part kMissing>
struct Name {
  static constexpr const char* kName = "toy";
};
template <>
struct Name<Part::kName> {};
template <Part kMissing>
struct Unit {
  static constexpr const char* kUnit = "m";
};
template <>
struct Unit<Part::kUnit> {};
template <Part kMissing>
struct Moduli {
  static constexpr std::array<sim::Modulus, 0> kModuli{};
};
template <>
struct Moduli<Part::kModuli> {};
template <Part kMissing>
struct Collect {
  static void collect(const ForceSource&, const auto&) {}
};
template <>
struct Collect<Part::kCollect> {};
template <Part kMissing>
struct Law {
  template <class T>
  static sim::Condition<T, 1> condition(const sim::V3<T>* x, const std::array<T, 1>& rest, T) {
    return {x[0].x - rest[0], {{1, 0, 0}}};
  }
};
template <>
struct Law<Part::kCondition> {};
template <Part kMissing>
struct MaxShift {
  static double maxShift(const std::array<double, 1>&) { return 1; }
};
template <>
struct MaxShift<Part::kMaxShift> {};
template <Part kMissing>
struct Curved {
  static constexpr bool kCurved = false;
};
template <>
struct Curved<Part::kCurved> {};
template <>
struct Curved<Part::kCurvature> {
  static constexpr bool kCurved = true;
};
template <Part kMissing>
struct Toy : Name<kMissing>,
             Unit<kMissing>,
             Moduli<kMissing>,
             Collect<kMissing>,
             Law<kMissing>,
             MaxShift<kMissing>,
             Curved<kMissing> {
  static constexpr int kVertices = 1, kRest = 1;
};
static_assert(sim::ForceKind<Toy<Part::kNone>>);
static_assert(!sim::ForceKind<Toy<Part::kName>>);
static_assert(!sim::ForceKind<Toy<Part::kUnit>>);
static_assert(!sim::ForceKind<Toy<Part::kModuli>>);
static_assert(!sim::ForceKind<Toy<Part::kCollect>>);
static_assert(!sim::ForceKind<Toy<Part::kCondition>>);
static_assert(!sim::ForceKind<Toy<Part::kMaxShift>>);
static_assert(!sim::ForceKind<Toy<Part::kCurved>>);
static_assert(!sim::ForceKind<Toy<Part::kCurvature>>, "curved, and does not say how");

sim::HairMesh mesh() {
  return sim::buildHairMesh(test::combedShape(test::mixedPatch(5, 0.2)));
}

template <class Kind>
std::vector<double> stiffnessesOf(const sim::HairMesh& of, const SimParams& params) {
  std::vector<double> all;
  Kind::collect(ForceSource{of, params}, [&](const ElementOf<Kind>& element) { all.push_back(element.stiffness); });
  return all;
}

// Else a change of the parameter would not reach the elements.
TEST(ForceKinds, EveryParameterThatAStiffnessFollowsIsAmongItsModuli) {
  const sim::HairMesh hair = mesh();
  ForceKinds::forEach([&]<class Kind>() {
    const SimParams usual;
    for (const sim::ParamField& field : sim::paramFields()) {
      SimParams params = usual;
      field.set(params, field.get(params) == field.minimum ? field.maximum : field.minimum);
      SimParams near = usual;
      if (field.kind == sim::FieldKind::kReal) field.set(near, field.get(near) * 0.9);
      if (sim::sameMaterial(params, usual)) {
        EXPECT_EQ(stiffnessesOf<Kind>(hair, params), stiffnessesOf<Kind>(hair, usual)) << Kind::kName << field.name;
      }
      if (sim::sameMaterial(near, usual)) {
        EXPECT_EQ(stiffnessesOf<Kind>(hair, near), stiffnessesOf<Kind>(hair, usual)) << Kind::kName << field.name;
      }
    }
    for (const sim::Modulus& modulus : Kind::kModuli) {
      SimParams params = usual;
      params.*modulus.param *= 0.9;
      EXPECT_FALSE(sim::sameMaterial(params, usual)) << Kind::kName;
      EXPECT_NE(stiffnessesOf<Kind>(hair, params), stiffnessesOf<Kind>(hair, usual)) << Kind::kName;
    }
  });
}

TEST(ForceKinds, EveryChangeOfAModulusIsFollowed) {
  const sim::HairMesh hair = mesh();
  const sim::BlockPattern pattern = sim::systemPattern(hair);
  ForceKinds::forEach([&]<class Kind>() {
    for (const sim::Modulus& modulus : Kind::kModuli) {
      SimParams params;
      sim::Material material(hair, pattern);
      material.set(params);
      params.*modulus.param *= 0.9;
      material.follow(params);
      EXPECT_TRUE(material.outdated()) << Kind::kName << ": the balance is another";
      for (int k = 0; k < 200 && material.outdated(); ++k) material.work();
      const sim::ForceModel<double> at_once = test::makeForceModel(hair, pattern, params);
      EXPECT_EQ(material.model.of<Kind>().stiffness, at_once.of<Kind>().stiffness) << Kind::kName;
      EXPECT_EQ(material.model.of<Kind>().shift, at_once.of<Kind>().shift) << Kind::kName;
    }
  });
}

TEST(ForceKinds, EveryKindHasElementsOfItsOwnThatPullAndAreNamed) {
  const sim::HairMesh hair = mesh();
  const sim::BlockPattern pattern = sim::systemPattern(hair);
  const SimParams params;
  const std::vector<sim::PinnedVertex> pins = test::pinnedWhereTheyAre(hair);
  const sim::ForceModel<double> all = sim::makeElements({hair, params, pins}, pattern);
  EXPECT_EQ(all.kindsLeftOut().skipped, 0);
  test::Random random(3);
  std::vector<sim::V3<double>> x = test::plain<double>(hair.shape.positions);
  for (sim::V3<double>& at : x) at += test::plain<double>(random.vector(0.005));
  std::vector<sim::V3<double>> folded = x;
  for (int i = 0; i < hair.vertexCount(); ++i) {
    if (hair.layer_of[i] % 2 == 0 && !hair.isRoot(i)) folded[i] = folded[i - 2];
  }
  ForceKinds::forEach([&]<class Kind>() {
    sim::ForceModel<double> only;
    only.of<Kind>() = all.of<Kind>();
    EXPECT_EQ(only.kindsLeftOut().skipped, ForceKinds::kCount - 1);
    EXPECT_GT(sim::evaluate<double>(only, folded, {}), 0) << Kind::kName;
    if constexpr (requires { Kind::kOneSided; }) {
      const std::vector<sim::V3<double>> rest = test::plain<double>(hair.shape.positions);
      EXPECT_EQ(sim::evaluate<double>(only, rest, {}), 0) << Kind::kName;
    }
    sim::FaultReport fault_report;
    fault_report.vertex = all.of<Kind>().vertices[0][0];
    sim::nameForce(only, x, fault_report);
    EXPECT_STREQ(fault_report.force, Kind::kName);
  });
}

std::string textOf(const std::string& path) {
  std::ifstream stream(std::string(HAIRMESH_SOURCE_DIR) + "/" + path);
  EXPECT_TRUE(stream.good()) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

int countOf(const std::string& what, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

std::string capitalized(std::string name) {
  name[0] = static_cast<char>(std::toupper(name[0]));
  return name;
}

// docs/recipes.md, "Adding a force": a header and its line in the list are all that every kind has. Outside of this
// folder kinds are reached through the list; a kind's header may include another's.
TEST(ForceKinds, EachIsAHeaderAndALineInTheListAsTheRecipeSays) {
  const std::string list = textOf("sim/forces/kinds.h");
  for (const std::string name : ForceKinds::kNames) {
    const std::string header = std::string("sim/forces/").append(name).append(".h");
    const std::string include = std::string("#include \"").append(header).append("\"");
    EXPECT_EQ(countOf(std::string("struct ").append(capitalized(name)).append(" {"), textOf(header)), 1);
    EXPECT_EQ(countOf(include, list), 1);
    const std::string kinds =
        list.substr(list.find("using ForceKinds"), list.find(">;") - list.find("using ForceKinds"));
    EXPECT_EQ(countOf(std::string(" ").append(capitalized(name)), kinds), 1) << kinds;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(HAIRMESH_SOURCE_DIR) + "/sim")) {
      if (!entry.is_regular_file() || entry.path().parent_path().filename() == "forces") continue;
      std::ifstream stream(entry.path());
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      EXPECT_EQ(countOf(include, text), 0) << entry.path() << ": kinds are reached through the list";
    }
  }
}

}  // namespace kinds_test
