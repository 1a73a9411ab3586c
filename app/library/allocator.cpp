// Memory from the caller. In the shared library the linker leads every call of malloc and its kin, of this code, of
// Eigen and of the C++ runtime linked into it, to the functions below (--wrap). Compiled once for each kind of library.
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <mutex>

#include "app/library/fault.h"
#include "app/library/objects.h"
#include "app/library/parameter_rows.h"

#ifdef HAIRMESH_WRAPS_MALLOC

extern "C" {
void* __real_malloc(std::size_t size);
void __real_free(void* block);
}

namespace {

std::mutex allocator_lock;
hm_allocator current{};  // no functions: malloc

// Stands before every block, so that it goes back to where it came from.
struct alignas(16) Header {
  void* base;
  std::size_t total, size;  // bytes: of all, of the caller's part
  void (*release)(void*, std::size_t, void*);
  void* user;
};

Header* headerOf(void* block) {
  return reinterpret_cast<Header*>(static_cast<char*>(block) - sizeof(Header));
}

void* take(std::size_t size, std::size_t alignment) noexcept {
  alignment = std::max(alignment, alignof(Header));
  const std::size_t before = (sizeof(Header) + alignment - 1) / alignment * alignment;
  if (size > SIZE_MAX - before - alignment) return nullptr;
  hm_allocator from;
  {
    const std::lock_guard lock(allocator_lock);
    from = current;
  }
  // malloc aligns to a header's alignment; what is wanted beyond that is made room for.
  const std::size_t total = before + size + (from.allocate ? 0 : alignment - alignof(Header));
  void* base = from.allocate ? from.allocate(total, alignment, from.user) : __real_malloc(total);
  if (!base) return nullptr;
  const auto start = reinterpret_cast<std::uintptr_t>(base);
  const std::uintptr_t aligned = (start + alignment - 1) / alignment * alignment;
  auto* block = reinterpret_cast<char*>(aligned) + before;
  *headerOf(block) = {base, total, size, from.release, from.user};
  return block;
}

}  // namespace

extern "C" {

void* __wrap_malloc(std::size_t size) {
  return take(size, 0);
}

void __wrap_free(void* block) {
  if (!block) return;
  const Header of = *headerOf(block);
  if (of.release) {
    of.release(of.base, of.total, of.user);
  } else {
    __real_free(of.base);
  }
}

void* __wrap_calloc(std::size_t count, std::size_t size) {
  if (size != 0 && count > SIZE_MAX / size) return nullptr;
  void* block = take(count * size, 0);
  if (block) std::memset(block, 0, count * size);
  return block;
}

void* __wrap_realloc(void* block, std::size_t size) {
  if (!block) return take(size, 0);
  void* moved = take(size, 0);
  if (!moved) return nullptr;
  std::memcpy(moved, block, std::min(size, headerOf(block)->size));
  __wrap_free(block);
  return moved;
}

void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  return take(size, alignment);
}
void* __wrap_memalign(std::size_t alignment, std::size_t size) {
  return take(size, alignment);
}

int __wrap_posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  *block = take(size, alignment);
  return *block ? 0 : ENOMEM;
}

}  // extern "C"

#endif

using namespace app::library;

hm_result hm_set_allocator(const hm_allocator* allocator) {
  return guarded("hm_set_allocator", [&] {
#ifdef HAIRMESH_WRAPS_MALLOC
    if (allocator && (!allocator->allocate || !allocator->release))
      throw Fault{HM_ERROR_ARGUMENT, "allocate or release is NULL; give both"};
    // Tables that stay until the library is unloaded are made before.
    parameterRows();
    meshes();
    hairs();
    const std::lock_guard lock(allocator_lock);
    current = allocator ? *allocator : hm_allocator{};
#else
    (void)allocator;
    throw Fault{HM_ERROR_UNSUPPORTED, "this build shares malloc with its program; use the shared library"};
#endif
  });
}
