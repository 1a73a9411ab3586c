// Handles: a slot's number and the serial number of what was put there, so that a stale one is found out.
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
  explicit HandleTable(const char* word) : word_(word) {}

  std::uint64_t add(Value value) {
    const std::lock_guard lock(lock_);
    std::size_t at = 0;
    while (at < slots_.size() && slots_[at].serial != 0) ++at;
    if (at == slots_.size()) slots_.emplace_back();
    if (++serial_ == 0) ++serial_;
    slots_[at].value = std::move(value);
    slots_[at].serial = serial_;
    ++used_;
    return std::uint64_t{serial_} << 32 | (at + 1);
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
    const std::uint64_t at = (id & 0xffffffffu) - 1;
    const auto serial = static_cast<std::uint32_t>(id >> 32);
    if (id == 0 || at >= slots_.size() || serial == 0 || slots_[at].serial != serial)
      throw Fault{HM_ERROR_HANDLE, std::string("no such ") + word_ + "; it was destroyed, or never made"};
    return slots_[at];
  }

  const char* word_;
  std::mutex lock_;
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
  std::uint32_t serial_ = 0;
};

}  // namespace app::library
