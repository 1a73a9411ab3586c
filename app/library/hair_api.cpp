// Hairs of the C interface: life, parameters, states and views. Steps are in step_api.cpp.
#include <algorithm>
#include <chrono>
#include <cstring>

#include "app/library/convert.h"
#include "app/library/objects.h"
#include "app/library/parameter_rows.h"
#include "sim/mesh/state_bytes.h"

namespace app::library {
namespace {

double secondsNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Puts a state in place; positions and velocities stay where they lie, for views.
void replaceState(sim::HairState next, sim::HairState& state) {
  std::ranges::copy(next.positions, state.positions.begin());
  std::ranges::copy(next.velocities, state.velocities.begin());
  next.positions.swap(state.positions);
  next.velocities.swap(state.velocities);
  state = std::move(next);
}

hm_view viewOf(const std::vector<Vec3>& points) {
  return {points.data()->data(), sizeof(Vec3), points.size()};
}

void readPoints(const std::vector<Vec3>& points, const hm_target& target) {
  checkTarget(target, points.size(), 3, "target");
  for (std::size_t i = 0; i < points.size(); ++i) writeElement(target, i, 3, points[i].data());
}

}  // namespace
}  // namespace app::library

using namespace app::library;

void hm_default_hair_settings(hm_hair_settings* settings) {
  if (settings) *settings = {kNoPose, 0, 0};
}

hm_result hm_hair_create(hm_mesh mesh, const hm_hair_settings* settings, hm_hair* hair) {
  return guarded("hm_hair_create", [&] {
    needs(hair, "hair");
    const hm_hair_settings given = settings ? *settings : hm_hair_settings{kNoPose, 0, 0};
    auto made = std::make_unique<Hair>(meshOf(mesh), given.measure_stages ? secondsNow : nullptr);
    made->context.refreshGradually(given.gradual != 0);
    made->state = sim::restState(made->mesh(), poseOf(given.head, {"head"}));
    made->roots.resize(static_cast<std::size_t>(made->mesh().columnCount()));
    *hair = {hairs().add(std::move(made))};
  });
}

hm_result hm_hair_destroy(hm_hair hair) {
  return guarded("hm_hair_destroy", [&] {
    hairs().remove(hair.id, [](const std::unique_ptr<Hair>& one) {
      if (one->busy) throw Fault{HM_ERROR_BUSY, "another thread is working on this hair; destroy it when it is done"};
    });
  });
}

int32_t hm_parameter_count(void) {
  return static_cast<int32_t>(parameterRows().size());
}

hm_result hm_parameter_at(int32_t index, hm_parameter* parameter) {
  return guarded("hm_parameter_at", [&] {
    needs(parameter, "parameter");
    if (index < 0 || index >= hm_parameter_count())
      throw Fault{HM_ERROR_ARGUMENT, "there is no parameter " + std::to_string(index) + "; the last one is " +
                                         std::to_string(hm_parameter_count() - 1)};
    *parameter = describe(parameterRows()[static_cast<std::size_t>(index)]);
  });
}

hm_result hm_parameter_find(const char* name, hm_parameter* parameter) {
  return guarded("hm_parameter_find", [&] {
    needs(name, "name");
    needs(parameter, "parameter");
    *parameter = describe(rowOf(name));
  });
}

hm_result hm_hair_set(hm_hair hair, const char* name, double value) {
  return guarded("hm_hair_set", [&] {
    const HairUse use(hair);
    needs(name, "name");
    setValue(rowOf(name), value, *use);
  });
}

hm_result hm_hair_set_text(hm_hair hair, const char* name, const char* value) {
  return guarded("hm_hair_set_text", [&] {
    const HairUse use(hair);
    needs(name, "name");
    needs(value, "value");
    setText(rowOf(name), value, *use);
  });
}

hm_result hm_hair_get(hm_hair hair, const char* name, double* value) {
  return guarded("hm_hair_get", [&] {
    const HairUse use(hair);
    needs(name, "name");
    needs(value, "value");
    *value = valueOf(rowOf(name), *use);
  });
}

hm_result hm_hair_reset_parameters(hm_hair hair) {
  return guarded("hm_hair_reset_parameters", [&] {
    const HairUse use(hair);
    use->params = {};
    use->look = {};
  });
}

hm_result hm_hair_reset(hm_hair hair, const hm_pose* head) {
  return guarded("hm_hair_reset", [&] {
    const HairUse use(hair);
    needs(head, "head");
    replaceState(sim::restState(use->mesh(), poseOf(*head, {"head"})), use->state);
  });
}

hm_result hm_hair_carry(hm_hair hair, const hm_pose* from, const hm_pose* to) {
  return guarded("hm_hair_carry", [&] {
    const HairUse use(hair);
    needs(from, "from");
    needs(to, "to");
    sim::carryAlong(poseOf(*from, {"from"}), poseOf(*to, {"to"}), use->state);
  });
}

hm_result hm_hair_save(hm_hair hair, void* buffer, size_t capacity, size_t* size) {
  return guarded("hm_hair_save", [&] {
    const HairUse use(hair);
    needs(size, "size");
    const std::vector<std::byte> bytes = sim::saveState(use->mesh(), use->state);
    *size = bytes.size();
    if (!buffer) return;
    if (capacity < bytes.size())
      throw Fault{HM_ERROR_SIZE, "the buffer has " + std::to_string(capacity) + " bytes; the state needs " +
                                     std::to_string(bytes.size())};
    std::memcpy(buffer, bytes.data(), bytes.size());
  });
}

hm_result hm_hair_restore(hm_hair hair, const void* bytes, size_t size) {
  return guarded("hm_hair_restore", [&] {
    const HairUse use(hair);
    needs(bytes, "bytes");
    sim::HairState restored;
    const std::string fault = sim::loadState(use->mesh(), {static_cast<const std::byte*>(bytes), size}, restored);
    if (!fault.empty()) throw Fault{HM_ERROR_STATE, fault};
    replaceState(std::move(restored), use->state);
  });
}

hm_result hm_hair_positions(hm_hair hair, hm_view* view) {
  return guarded("hm_hair_positions", [&] {
    const HairUse use(hair);
    needs(view, "view");
    *view = viewOf(use->state.positions);
  });
}

hm_result hm_hair_velocities(hm_hair hair, hm_view* view) {
  return guarded("hm_hair_velocities", [&] {
    const HairUse use(hair);
    needs(view, "view");
    *view = viewOf(use->state.velocities);
  });
}

hm_result hm_hair_read_positions(hm_hair hair, const hm_target* target) {
  return guarded("hm_hair_read_positions", [&] {
    const HairUse use(hair);
    needs(target, "target");
    readPoints(use->state.positions, *target);
  });
}

hm_result hm_hair_read_velocities(hm_hair hair, const hm_target* target) {
  return guarded("hm_hair_read_velocities", [&] {
    const HairUse use(hair);
    needs(target, "target");
    readPoints(use->state.velocities, *target);
  });
}
