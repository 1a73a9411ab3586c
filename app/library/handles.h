// Handles: a slot's number, from a first one of each kind on, and the serial number of what was put there, so that one
// that is stale or of another kind is found out.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/library/fault.h"

namespace app::library {

// A table of values, each under a handle of its own. No serial number is given out twice before 2^32 others have been.
template <class Value>
class HandleTable {
 public:
  // `first`: number of the first slot, above 0; no other kind's come up to it, or begin within 2^31 of it.
  HandleTable(const char* word, std::uint32_t first) : word_(word), first_(first) {}

  std::uint64_t add(Value value) {
    const std::lock_guard lock(lock_);
    std::size_t at = 0;
    while (at < slots_.size() && slots_[at].serial != 0) ++at;
    if (at == slots_.size()) slots_.emplace_back();
    if (++serial_ == 0) ++serial_;
    slots_[at].value = std::move(value);
    slots_[at].serial = serial_;
    ++used_;
    return std::uint64_t{serial_} << 32 | (first_ + at);
  }

  // Runs `body` on the value, alone in the table. Throws Fault for a stale handle.
  template <class Body>
  auto with(std::uint64_t id, Body&& body) {
    const std::lock_guard lock(lock_);
    return body(slot(id).value);
  }

  // Takes the value out where `body` does not throw; the handle is stale from then on.
  template <class Body>
  Value remove(std::uint64_t id, Body&& body) {
    const std::lock_guard lock(lock_);
    Slot& from = slot(id);
    body(from.value);
    Value value = std::move(from.value);
    from.value = Value{};
    from.serial = 0;
    if (--used_ == 0) slots_ = std::vector<Slot>();  // the caller's memory goes back
    return value;
  }

 private:
  struct Slot {
    Value value{};
    std::uint32_t serial = 0;  // 0: empty
  };

  Slot& slot(std::uint64_t id) {
    const std::uint64_t at = (id & 0xffffffffu) - first_;  // beyond all slots of one before the first
    const auto serial = static_cast<std::uint32_t>(id >> 32);
    if (id == 0 || at >= slots_.size() || serial == 0 || slots_[at].serial != serial)
      throw Fault{HM_ERROR_HANDLE,
                  std::string("no such ") + word_ + "; it was destroyed, never made, or is of another kind"};
    return slots_[at];
  }

  const char* word_;
  const std::uint64_t first_;
  std::mutex lock_;
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
  std::uint32_t serial_ = 0;
};

}  // namespace app::library
