// SPDX-License-Identifier: BSD-3-Clause
// Every allocation of this program is counted: malloc is replaced, and operator new and Eigen end there.
#include <skinbem/frame/frame_model.hpp>
#include <skinbem/frame/handles.hpp>

#include <gtest/gtest.h>

#include <atomic>

#include "frame/models.hpp"
#include "meshes.hpp"

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
  const testing_support::SyntheticSkin skin = testing_support::synthetic_skin(1000, 6);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  std::vector<FrameState> states(5, FrameState(model));
  std::vector<float> positions(3000);
  std::vector<float> batch(15000);
  const Points displacement = Points::Random(6, 3);
  FrameThreads threads(2, 0);

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
  for (int i = 0; i < 100; ++i) {
    good = good && states[0].set_landmarks(displacement) && states[0].evaluate(positions);
    good = good && evaluate_batch(states, batch);
    good = good && states[1].evaluate(VertexTarget{positions}, threads);
    good = good && handles.grab(70 + i % 50) && handles.pull(pulls) && handles.move(4, 120 + i % 40);
    good = good && handles.evaluate(VertexTarget{ellipsoid}) && handles.release(4) && handles.pull(0, Vec3(0, 0, 1));
  }
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(good);
#endif
}

}  // namespace
}  // namespace skinbem
