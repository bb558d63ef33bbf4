// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Memory that vector loads and cache lines like.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace skinbem::detail {

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;
inline constexpr std::size_t kHugeFrom = 4 * kHugePage;

/// Asks for huge pages where the storage is large and the system has them: a stream through it then misses fewer
/// translations. No more than a wish.
inline void prefer_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef __linux__
  if (bytes >= kHugeFrom) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
}

/// Allocator of std::vector for storage that begins on a cache line, or on a huge page where it fills some.
template <class T>
struct CacheLineAllocator {
  using value_type = T;

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) noexcept {}
  T* allocate(std::size_t n) {
    void* memory = ::operator new(n * sizeof(T), alignment(n));
    prefer_huge_pages(memory, n * sizeof(T));
    return static_cast<T*>(memory);
  }
  void deallocate(T* p, std::size_t n) noexcept { ::operator delete(p, alignment(n)); }
  static constexpr std::align_val_t alignment(std::size_t n) {
    return std::align_val_t{n * sizeof(T) >= kHugeFrom ? kHugePage : 64};
  }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) noexcept { return true; }
};

/// Storage that nobody has written to yet: its pages come with the first write, from the thread that writes. They are
/// small ones: it is read a few times only, and where the machine is virtual the first touch of huge pages took four
/// times as long (600 MB: 1.6 s against 0.4 s).
template <class T>
class Uninitialised {
 public:
  Uninitialised() = default;
  explicit Uninitialised(std::size_t size)
      : size_(size), data_(static_cast<T*>(::operator new(size * sizeof(T), kAlignment))) {}
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Free {
    void operator()(T* p) const noexcept { ::operator delete(p, kAlignment); }
  };
  std::size_t size_ = 0;
  std::unique_ptr<T, Free> data_;
};

/// Memory in small pieces that was freed goes back to the system, where the allocator is one that would keep it.
inline void return_freed_memory() noexcept {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

}  // namespace skinbem::detail
