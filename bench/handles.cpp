// SPDX-License-Identifier: BSD-3-Clause
// A landmark that is added, moved or removed, and the next frame, on the leg of 606 vertices (argument: handles there
// already): with the factorisation kept (`factorised_*`: ResponseModel, new R included), and with the Green's functions
// of all vertices (`handles_*`: Handles, the frame included). In turns: --benchmark_enable_random_interleaving=true.
#include <benchmark/benchmark.h>

#include <cstdlib>

#include <skinbem/frame/handles.hpp>
#include <skinbem/mesh/mesh_io.hpp>

namespace {

using namespace skinbem;

const TriangleMesh& leg() {
  static const TriangleMesh mesh = read_mesh(SKINBEM_LEG);
  return mesh;
}

ResponseModel& body() {
  static ResponseModel model(leg());
  return model;
}

const HandleModel& every_vertex() {
  static const HandleModel model(body());
  return model;
}

/// Vertices spread over the skin, the same for both ways.
std::vector<std::int32_t> places(Index count) {
  std::vector<std::int32_t> result;
  for (Index k = 0; k < count; ++k) result.push_back(static_cast<std::int32_t>((2 * k + 1) * 600 / (2 * count)));
  return result;
}

/// The vertex to grab: no one's place.
constexpr std::int32_t kFree = 601;

void require(bool good) {
  if (!good) std::abort();
}

void green_functions_of_all_vertices(benchmark::State& state) {
  for (auto _ : state) {
    const HandleModel model(body());
    state.counters["megabytes"] = 1e-6 * static_cast<double>(model.bytes());
  }
}
BENCHMARK(green_functions_of_all_vertices)->Unit(benchmark::kMillisecond)->UseRealTime();

void set_landmarks(Index count) {
  while (!body().landmarks().empty()) body().remove(0);
  std::vector<Landmark> landmarks;
  for (const std::int32_t v : places(count)) landmarks.push_back({.name = std::to_string(v), .vertex = v});
  body().add(landmarks);
}

void factorised_add(benchmark::State& state) {
  set_landmarks(state.range(0));
  for (auto _ : state) {
    body().add(std::vector{Landmark{.name = "new", .vertex = kFree}});
    benchmark::DoNotOptimize(body().response());
    state.PauseTiming();
    body().remove(state.range(0));
    state.ResumeTiming();
  }
}
void factorised_move(benchmark::State& state) {
  set_landmarks(state.range(0));
  std::int32_t vertex = kFree;
  for (auto _ : state) {
    body().move(0, {.name = "moved", .vertex = vertex++});
    if (vertex == 606) vertex = kFree;
    benchmark::DoNotOptimize(body().response());
  }
}
void factorised_remove(benchmark::State& state) {
  set_landmarks(state.range(0));
  for (auto _ : state) {
    state.PauseTiming();
    body().add(std::vector{Landmark{.name = "new", .vertex = kFree}});
    state.ResumeTiming();
    body().remove(state.range(0));
    benchmark::DoNotOptimize(body().response());
  }
}

/// One character, the leg's skin and a buffer for it.
struct Grabbed {
  explicit Grabbed(Index count) : handles(every_vertex(), places(count), count + 1), positions(3 * 606) {}
  void frame() { require(handles.evaluate(VertexTarget{positions})); }

  Handles handles;
  std::vector<float> positions;
};

void handles_grab_and_release(benchmark::State& state) {
  Grabbed skin(state.range(0));
  for (auto _ : state) {
    require(skin.handles.grab(kFree));
    skin.frame();
    require(skin.handles.release(state.range(0)));
    skin.frame();
  }
}
void handles_move(benchmark::State& state) {
  Grabbed skin(state.range(0));
  std::int32_t vertex = kFree;
  for (auto _ : state) {
    require(skin.handles.move(0, vertex++));
    if (vertex == 606) vertex = kFree;
    skin.frame();
  }
}
/// A vertex is grabbed, pulled and let go, and two frames are drawn; every vertex in turn, so that its Green's
/// functions come from wherever they are.
void handles_grab_pull_release(benchmark::State& state) {
  Grabbed skin(state.range(0));
  std::int32_t vertex = 0;
  for (auto _ : state) {
    if (skin.handles.grab(vertex)) {
      require(skin.handles.pull(state.range(0), Vec3(0, 0, 10)));
      skin.frame();
      require(skin.handles.release(state.range(0)));
    }
    skin.frame();
    vertex = (vertex + 97) % 606;
  }
}
void handles_pull(benchmark::State& state) {
  Grabbed skin(state.range(0));
  double z = 0;
  for (auto _ : state) {
    require(skin.handles.pull(0, Vec3(0, 0, z += 0.01)));
    skin.frame();
  }
}
BENCHMARK(factorised_add)->Arg(6)->Arg(100)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(factorised_move)->Arg(6)->Arg(100)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(factorised_remove)->Arg(6)->Arg(100)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(handles_grab_and_release)->Arg(6)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(handles_move)->Arg(6)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(handles_grab_pull_release)->Arg(6)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(handles_pull)->Arg(6)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
