#include "app/figure/character_roles.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

namespace app {

namespace {

constexpr double kMinBone = 1e-4;  // m: shorter segments only repeat a joint

using Children = std::vector<std::vector<int>>;

Children childrenOf(const Skeleton& skeleton) {
  Children children(skeleton.joints.size());
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
    if (skeleton.joints[j].parent >= 0) children[skeleton.joints[j].parent].push_back(static_cast<int>(j));
  return children;
}

bool contains(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return text.find(w) != std::string::npos; });
}

Vec3 at(const ReferencePose& reference, int joint) {
  return reference.world[joint].translation();
}

// Highest point of the figure minus its lowest, over joints and ends.
double heightOf(const ReferencePose& reference) {
  double low = 1e30, high = -1e30;
  for (std::size_t j = 0; j < reference.ends.size(); ++j) {
    for (double y : {reference.world[j].translation().y(), reference.ends[j].y()}) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  return high - low;
}

// The longest path below a joint: the joints along it, the joint itself first.
struct Reach {
  double length = 0;
  int next = -1;
};

std::vector<Reach> reaches(const Skeleton& skeleton, const ReferencePose& reference) {
  std::vector<Reach> reach(skeleton.joints.size());
  for (int j = static_cast<int>(skeleton.joints.size()) - 1; j >= 0; --j) {
    if (reach[j].next < 0) reach[j].length = (reference.ends[j] - at(reference, j)).norm();
    const int parent = skeleton.joints[j].parent;
    if (parent < 0) continue;
    const double length = reach[j].length + (at(reference, j) - at(reference, parent)).norm();
    if (reach[parent].next < 0 || length > reach[parent].length) reach[parent] = {length, j};
  }
  return reach;
}

std::vector<int> mainChain(const std::vector<Reach>& reach, int first) {
  std::vector<int> chain;
  for (int j = first; j >= 0; j = reach[j].next) chain.push_back(j);
  return chain;
}

int firstNamed(const std::vector<int>& chain, const std::vector<std::string>& names,
               std::initializer_list<const char*> words, std::initializer_list<const char*> but = {}) {
  for (int j : chain)
    if (contains(names[j], words) && !contains(names[j], but)) return j;
  return -1;
}

int after(const std::vector<int>& chain, int joint) {
  const auto it = std::find(chain.begin(), chain.end(), joint);
  return it == chain.end() || it + 1 == chain.end() ? -1 : *(it + 1);
}

// Two long consecutive segments make a limb: the best start of (upper, lower) by length, with a human ratio preferred.
std::size_t limbStart(const std::vector<int>& chain, const ReferencePose& reference, std::size_t first) {
  const auto point = [&](std::size_t i) {
    return i < chain.size() ? at(reference, chain[i]) : reference.ends[chain.back()];
  };
  std::size_t best = first;
  double best_score = -1;
  for (std::size_t i = first; i < chain.size(); ++i) {
    const double a = (point(i + 1) - point(i)).norm();
    const double b = i + 1 < chain.size() ? (point(i + 2) - point(i + 1)).norm() : 0;
    const double ratio = a / std::max(b, kMinBone);
    const double score = a * b * (ratio < 0.9 ? 0.6 : 1.0);
    if (score > best_score) {
      best_score = score;
      best = i;
    }
  }
  return best;
}

std::optional<ArmRoles> armOf(const std::vector<int>& chain, const std::vector<std::string>& names,
                              const ReferencePose& reference) {
  ArmRoles arm;
  arm.fore = firstNamed(chain, names, {"forearm", "lowerarm", "lowarm", "elbow"});
  arm.hand = firstNamed(chain, names, {"hand", "wrist"}, {"index", "thumb", "finger"});
  arm.upper = firstNamed(chain, names, {"upperarm", "uparm", "shldr"});
  if (arm.upper < 0) arm.upper = firstNamed(chain, names, {"arm"}, {"fore", "lower", "low", "armature", "collar"});
  if (arm.upper < 0 && arm.fore >= 0) arm.upper = firstNamed(chain, names, {"shoulder"});
  const int clavicle = firstNamed(chain, names, {"clav", "collar", "shoulder"});
  if (arm.upper < 0 || arm.upper == arm.fore) {
    const std::size_t first = clavicle >= 0 && clavicle == chain.front() && chain.size() > 3 ? 1 : 0;
    arm.upper = chain[limbStart(chain, reference, first)];
    arm.fore = -1;
  }
  if (arm.fore < 0) arm.fore = after(chain, arm.upper);
  if (arm.fore < 0) return std::nullopt;
  if (arm.hand < 0) arm.hand = after(chain, arm.fore);
  arm.tip = chain.back();
  if (clavicle >= 0 && clavicle != arm.upper) arm.clavicle = clavicle;
  if (arm.clavicle < 0 && arm.upper != chain.front()) arm.clavicle = chain.front();
  return arm;
}

std::optional<LegRoles> legOf(const std::vector<int>& chain, const std::vector<std::string>& names,
                              const ReferencePose& reference) {
  LegRoles leg;
  leg.foot = firstNamed(chain, names, {"foot", "ankle"});
  leg.toe = firstNamed(chain, names, {"toe", "ball"});
  leg.lower = firstNamed(chain, names, {"shin", "calf", "knee", "lowerleg", "lowleg"});
  leg.upper = firstNamed(chain, names, {"thigh", "upleg", "upperleg"});
  if (leg.upper < 0 && leg.lower >= 0)
    leg.upper = firstNamed(chain, names, {"hip", "leg", "buttock"}, {"hipjoint", "lower", "shin"});
  if (leg.lower < 0 && leg.upper >= 0) leg.lower = firstNamed(chain, names, {"leg"}, {"up"});
  if (leg.upper < 0 || leg.lower < 0 || leg.upper == leg.lower) {
    const std::size_t i = limbStart(chain, reference, 0);
    leg.upper = chain[i];
    leg.lower = i + 1 < chain.size() ? chain[i + 1] : -1;
  }
  if (leg.lower < 0) return std::nullopt;
  if (leg.foot < 0) leg.foot = after(chain, leg.lower);
  if (leg.toe < 0 && leg.foot >= 0) leg.toe = after(chain, leg.foot);
  return leg;
}

// A branch off the spine, and how it votes to be an arm or a leg.
struct Branch {
  std::vector<int> chain;
  std::size_t spine_index;
  double length;
  double arm_vote, leg_vote;
};

Branch branchAt(const BodyRoles& roles, const std::vector<Reach>& reach, const ReferencePose& reference,
                const std::vector<std::string>& names, int first) {
  Branch branch;
  branch.chain = mainChain(reach, first);
  branch.length = reach[first].length;
  branch.arm_vote = branch.leg_vote = 0;
  for (int j : branch.chain) {
    if (contains(names[j], {"arm", "hand", "shldr", "shoulder", "elbow", "wrist", "clav", "collar"}))
      branch.arm_vote += 2;
    if (contains(names[j], {"leg", "thigh", "knee", "shin", "calf", "foot", "ankle", "toe", "buttock"}))
      branch.leg_vote += 2;
  }
  const double root = at(reference, roles.spine.front()).y(), head = at(reference, roles.head).y();
  const double start = at(reference, first).y(), end = reference.ends[branch.chain.back()].y();
  const double rise = std::max(head - root, 1e-6);
  if (start < root + 0.3 * rise && end < start - 0.6 * branch.length) branch.leg_vote += 1;
  if (start > root + 0.45 * rise) branch.arm_vote += 1;
  return branch;
}

bool isEndName(const std::string& name) {
  return contains(name, {"end", "nub", "top", "tip", "site"});
}

// The joint above a neck that carries the head under another name: of those that rise and go on, the one that rises
// most. -1: none, the neck carries it.
int jointAboveNeck(const Skeleton& skeleton, const ReferencePose& reference, int neck) {
  const Children children = childrenOf(skeleton);
  int best = -1;
  double best_rise = 0;
  for (const int child : children[neck]) {
    const Vec3 way = at(reference, child) - at(reference, neck);
    const double rise = way.y() - std::hypot(way.x(), way.z());
    const bool goes_on = !children[child].empty() || (reference.ends[child] - at(reference, child)).norm() >= kMinBone;
    if (rise <= best_rise || !goes_on || isEndName(plainName(skeleton.joints[child].name))) continue;
    best = child;
    best_rise = rise;
  }
  return best;
}

}  // namespace

std::string plainName(std::string_view name) {
  if (const auto colon = name.rfind(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string plain;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (u >= 128 || std::isalnum(u)) plain += static_cast<char>(std::tolower(u));
  }
  for (const char* prefix : {"mixamorig", "bip01", "bip001", "def"})
    if (plain.rfind(prefix, 0) == 0 && plain.size() > std::string_view(prefix).size())
      plain.erase(0, std::string_view(prefix).size());
  return plain;
}

int findHeadJoint(const Skeleton& skeleton, const ReferencePose& reference, bool& is_neck) {
  is_neck = false;
  const int count = static_cast<int>(skeleton.joints.size());
  int named = -1, neck = -1;
  for (int j = count - 1; j >= 0; --j) {
    const std::string name = plainName(skeleton.joints[j].name);
    if (name == "head" || name == "skull") return j;
    const bool is_end = isEndName(name);
    if (contains(name, {"head", "skull"}) && !is_end) named = j;
    if (contains(name, {"neck"}) && !is_end && neck < 0) neck = j;
  }
  if (named >= 0) return named;
  if (neck >= 0) {
    const int above = jointAboveNeck(skeleton, reference, neck);
    is_neck = above < 0;
    return is_neck ? neck : above;
  }
  if (count < 3) return -1;
  const double height = heightOf(reference);
  const Vec3 root = at(reference, 0);
  int best = -1;
  double best_score = 0.12 * height;
  std::vector<bool> has_child(count, false);
  for (const Joint& joint : skeleton.joints)
    if (joint.parent >= 0) has_child[joint.parent] = true;
  std::vector<double> scores(count, 0);
  for (int j = 1; j < count; ++j) {
    if (has_child[j]) continue;
    const Vec3 reach = reference.ends[j] - root;
    scores[j] = reach.y() - std::hypot(reach.x(), reach.z());
    if (scores[j] > best_score) {
      best_score = scores[j];
      best = j;
    }
  }
  if (best < 0) return -1;
  // A leaf without an end site of its own is the crown, and one beside another is an eye or ear: the joint before it
  // turns the head.
  const bool bare = (reference.ends[best] - at(reference, best)).norm() < kMinBone;
  const int parent = skeleton.joints[best].parent;
  bool twin = false;
  for (int j = 1; j < count; ++j)
    twin |= j != best && skeleton.joints[j].parent == parent && scores[j] > 0.9 * best_score;
  return (bare || twin) && parent > 0 ? parent : best;
}

BodyRoles inferRoles(const Skeleton& skeleton, const ReferencePose& reference, int head, bool head_is_neck) {
  BodyRoles roles;
  roles.head = head;
  roles.head_is_neck = head_is_neck;
  for (int j = head; j >= 0; j = skeleton.joints[j].parent) roles.spine.insert(roles.spine.begin(), j);

  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints) names.push_back(plainName(joint.name));
  const Children children = childrenOf(skeleton);
  const std::vector<Reach> reach = reaches(skeleton, reference);
  const double height = heightOf(reference);

  std::vector<Branch> branches;
  for (std::size_t s = 0; s + 1 < roles.spine.size(); ++s) {
    for (int child : children[roles.spine[s]]) {
      if (child == roles.spine[s + 1]) continue;
      branches.push_back(branchAt(roles, reach, reference, names, child));
      branches.back().spine_index = s;
    }
  }
  std::stable_sort(branches.begin(), branches.end(), [](const Branch& a, const Branch& b) {
    return std::max(a.arm_vote, a.leg_vote) > std::max(b.arm_vote, b.leg_vote);
  });
  int arms = 0, legs = 0;
  for (const Branch& branch : branches) {
    if (branch.leg_vote > branch.arm_vote && legs < 2 && branch.length > 0.15 * height) {
      if (const auto leg = legOf(branch.chain, names, reference)) {
        roles.legs[legs++] = *leg;
        continue;
      }
    } else if (branch.arm_vote > 0 && arms < 2 && branch.length > 0.12 * height) {
      if (const auto arm = armOf(branch.chain, names, reference)) {
        roles.arms[arms++] = *arm;
        roles.chest = roles.spine[branch.spine_index];
        continue;
      }
    }
    if (branch.length > 0.12 * height) roles.appendages.push_back(branch.chain.front());
  }
  if (roles.chest < 0) {
    // No arms: the last spine joint before the neck.
    const std::size_t above = head_is_neck ? 1 : 2;
    roles.chest = roles.spine[roles.spine.size() > above ? roles.spine.size() - 1 - above : 0];
  }
  return roles;
}

Vec3 inferForward(const Skeleton& skeleton, const ReferencePose& reference, const BodyRoles& roles, std::string& how) {
  const auto flat = [](Vec3 v) {
    v.y() = 0;
    return v;
  };
  Vec3 toes = Vec3::Zero();
  double feet = 0;
  for (const LegRoles& leg : roles.legs) {
    if (leg.foot < 0) continue;
    const Vec3 end = leg.toe >= 0 ? reference.ends[leg.toe] : reference.ends[leg.foot];
    const Vec3 step = flat(end - at(reference, leg.foot));
    toes += step;
    feet += step.norm();
  }
  if (feet > 0.04 && toes.norm() > 0.6 * feet) {
    how = "the toes";
    return toes.normalized();
  }
  Vec3 left = Vec3::Zero();
  const auto addPair = [&](int a, int b) {
    if (a < 0 || b < 0) return;
    const std::string name = plainName(skeleton.joints[a].name), other = plainName(skeleton.joints[b].name);
    const bool a_left = contains(name, {"left"}) || contains(other, {"right"}) ||
                        (!name.empty() && name != other && (name[0] == 'l' || name.back() == 'l'));
    const Vec3 across = flat(at(reference, a) - at(reference, b));
    left += a_left ? across : Vec3(-across);
  };
  addPair(roles.arms[0].upper, roles.arms[1].upper);
  addPair(roles.legs[0].upper, roles.legs[1].upper);
  if (left.norm() > 0.02) {
    how = "left and right joints";
    return left.cross(Vec3::UnitY()).normalized();
  }
  how = "nothing in the skeleton: +z was taken";
  return Vec3::UnitZ();
}

void orderSides(const ReferencePose& reference, const Vec3& forward, BodyRoles& roles) {
  const Vec3 left = Vec3::UnitY().cross(forward);
  const double middle = at(reference, roles.spine.front()).dot(left);
  const auto side = [&](int joint) { return joint < 0 ? 0.0 : at(reference, joint).dot(left) - middle; };
  const auto swapIfCrossed = [&](auto& pair) {
    const double a = side(pair[0].upper), b = side(pair[1].upper);
    const bool lone = pair[1].upper < 0;
    if (lone ? a < 0 : a < b) std::swap(pair[0], pair[1]);
  };
  swapIfCrossed(roles.arms);
  swapIfCrossed(roles.legs);
}

BodyRoles rolesAtRest(const Skeleton& skeleton) {
  ReferencePose rest{restPose(skeleton).world, {}};
  for (const Rigid& joint : rest.world) rest.ends.push_back(joint.translation());
  bool is_neck = false;
  const int head = findHeadJoint(skeleton, rest, is_neck);
  return head < 0 ? BodyRoles{} : inferRoles(skeleton, rest, head, is_neck);
}

}  // namespace app
