// SPDX-License-Identifier: BSD-3-Clause
// Every allocation of this program is counted: malloc is replaced, and operator new and Eigen end there.
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "frame/every_frame.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SKINBEM_COUNTS_ALLOCATIONS

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {
std::atomic<long> allocations = 0;
}

extern "C" {
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace skinbem {
namespace {

TEST(Frame, AllocatesNothing) {
#ifndef SKINBEM_COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations are counted with glibc and without sanitizers only";
#else
  testing_support::EveryFrame frames;

  const long before_vector = allocations;
  const std::vector<float> counted(10);
  ASSERT_GT(allocations, before_vector) << "the counter does not count";

  ResponseModel body(testing_support::slender_ellipsoid(2));
  const HandleModel handle_model(body, 1);
  Handles handles(handle_model, std::vector<std::int32_t>{0, 9, 30, 50}, 40);
  std::vector<float> ellipsoid(3 * static_cast<std::size_t>(handle_model.vertex_count()));
  const Points pulls = Points::Random(5, 3);

  const long before = allocations;
  bool good = true;
  for (int i = 0; i < 100; ++i) good = frames.run() && good;
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(good);
#endif
}

}  // namespace
}  // namespace skinbem
