// Measures drawing a picture with many selected nodes, and selecting them. Say which renderer drew: llvmpipe draws on the processor, so its
// times contain the work of a graphics card as well.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <GLES3/gl31.h>
#include <benchmark/benchmark.h>
#include <unistd.h>

#include "base/clock.h"
#include "kiosk/display/headless.h"
#include "kiosk/levels_worker.h"
#include "kiosk/render/make_levels.h"
#include "kiosk/render/offscreen.h"
#include "kiosk/render/picture_file.h"
#include "kiosk/render/renderer.h"
#include "tests/kiosk/test_source.h"

namespace {

using namespace prismesh;
using namespace prismesh::kiosk;

constexpr int kWidth = 1600, kHeight = 900;
constexpr std::uint32_t kSide = 1000;

/// A curved sheet of side x side quads.
test::TestSource sheet_of(std::uint32_t side) {
  test::TestSource source;
  test::add_grid(source, side, side, 0,
                 [](double u, double v) { return mesh::Vec3(5000 * u, 5000 * v, 300 * std::sin(6 * u) * std::cos(5 * v)); });
  return source;
}

/// A million quads, so many of whose nodes are selected: a band across the sheet.
std::shared_ptr<test::TestSource> million(std::size_t selected) {
  static const test::TestSource sheet = sheet_of(kSide);
  auto source = std::make_shared<test::TestSource>(sheet);
  for (std::size_t n = 0; n < selected; ++n) source->node_marks[n + 400 * (kSide + 1)] = mesh::document::kSelected;
  source->key = selected + 1;
  return source;
}

struct Stage {
  display::Headless headless = std::move(*display::Headless::create());
  std::unique_ptr<render::Renderer> renderer = std::move(*render::Renderer::create({}));
  render::Offscreen target = std::move(*render::Offscreen::create(kWidth, kHeight));
  render::Picture picture;

  Stage(std::size_t selected, const std::string& profile, double zoom) {
    (void)renderer->set_model(million(selected));
    picture.profile = *stereo::find_profile(profile);
    picture.view.rotation = *stereo::named_rotation("iso");
    picture.view.bounds = stereo::sphere_around(renderer->bounds());
    picture.view = renderer->fitted(picture.view, stereo::screen_size_mm(picture.profile, kWidth, kHeight));
    picture.view = stereo::zoom(picture.view, zoom, {0, 0});
    picture.moving = true;
  }
};

/// A picture of the sheet being turned. Arguments: selected nodes, zoom.
void turning(benchmark::State& state) {
  Stage stage(static_cast<std::size_t>(state.range(0)), "mono", static_cast<double>(state.range(1)));
  for (auto _ : state) {
    stage.picture.view = stereo::orbit(stage.picture.view, 0.001, 0);
    benchmark::DoNotOptimize(stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight));
    glFinish();
  }
  state.SetLabel(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}
BENCHMARK(turning)
    ->ArgNames({"selected", "zoom"})
    ->Args({0, 1})
    ->Args({200000, 1})
    ->Args({0, 40})
    ->Args({200000, 40})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// The same with levels of detail, for both eyes at 1920 x 1080. Argument: zoom.
void turning_with_levels(benchmark::State& state) {
  Stage stage(0, "side-by-side", static_cast<double>(state.range(0)));
  static const auto levels = render::make_levels(*million(0)).value();
  (void)stage.renderer->set_levels(levels);
  for (auto _ : state) {
    stage.picture.view = stereo::orbit(stage.picture.view, 0.001, 0);
    benchmark::DoNotOptimize(stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight));
    glFinish();
  }
  state.counters["triangles"] = static_cast<double>(stage.renderer->figures().moving_triangles);
  state.counters["pixels"] = stage.renderer->figures().moving_pixels;
  state.SetLabel(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}
BENCHMARK(turning_with_levels)
    ->ArgName("zoom")
    ->Arg(1)
    ->Arg(5)
    ->Arg(40)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// A film of the camera on its way through the levels: for each step of turning and zooming the picture at rest, the moving one, and how
/// far they differ (mid-grey: not at all, white: by 64 of 255). Written as PNG into the folder that PRISMESH_FILM names. Counters: the
/// largest shares of pixels whose brightness differs by more than 8 and 24 of 255.
void film(benchmark::State& state) {
  const char* const folder = std::getenv("PRISMESH_FILM");
  Stage stage(0, "mono", 1);
  (void)stage.renderer->set_levels(render::make_levels(*million(0)).value());
  const stereo::View begin = stage.picture.view;
  double more_than_8 = 0, more_than_24 = 0;
  for (auto _ : state)
    for (int k = 0; k < 16; ++k) {
      stage.picture.view = stereo::zoom(stereo::orbit(begin, 0.11 * k, 0.02 * k), std::pow(1.35, k), {0, 0});
      std::vector<render::Image> images;
      for (const bool moving : {true, false}) {  // the other way round the picture at rest would be shown again
        stage.picture.moving = moving;
        (void)stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight);
        images.push_back(stage.target.read());
      }
      images.push_back(images[0]);
      std::size_t over_8 = 0, over_24 = 0;
      for (std::size_t i = 0; i < images[0].rgb.size(); i += 3) {
        int apart = 0;
        for (std::size_t c = 0; c < 3; ++c) apart += images[0].rgb[i + c] - images[1].rgb[i + c];
        apart /= 3;
        over_8 += std::abs(apart) > 8 ? 1 : 0;
        over_24 += std::abs(apart) > 24 ? 1 : 0;
        for (std::size_t c = 0; c < 3; ++c) images[2].rgb[i + c] = static_cast<std::uint8_t>(std::clamp(128 + 2 * apart, 0, 255));
      }
      const double pixels = static_cast<double>(images[0].rgb.size()) / 3;
      more_than_8 = std::max(more_than_8, static_cast<double>(over_8) / pixels);
      more_than_24 = std::max(more_than_24, static_cast<double>(over_24) / pixels);
      if (folder == nullptr) continue;
      std::printf("%02d: %.1f%% of the pixels by more than 8, %.1f%% by more than 24; %zu triangles, off by %.1f\n", k,
                  100 * static_cast<double>(over_8) / pixels, 100 * static_cast<double>(over_24) / pixels,
                  stage.renderer->figures().moving_triangles, stage.renderer->figures().moving_pixels);
      const char* const names[] = {"moving", "rest", "apart"};
      for (std::size_t n = 0; n < 3; ++n)
        (void)render::write_png(std::string(folder) + "/" + (k < 10 ? "0" : "") + std::to_string(k) + "_" + names[n] + ".png", images[n]);
    }
  state.counters["over_8"] = more_than_8;
  state.counters["over_24"] = more_than_24;
}
BENCHMARK(film)->Iterations(1)->Unit(benchmark::kMillisecond);

/// A picture at rest of the million for both eyes, after one from another side. Argument: 0 in one go, else in pieces of so many
/// milliseconds. `longest_ms` is the longest wall time of a piece, and so between two looks at the input.
void at_rest(benchmark::State& state) {
  Stage stage(0, "side-by-side", 1);
  static const auto levels = render::make_levels(*million(0)).value();
  (void)stage.renderer->set_levels(levels);
  stage.picture.moving = false;
  MonotonicClock clock;
  double longest = 0;
  for (auto _ : state) {
    stage.picture.view = stereo::orbit(stage.picture.view, 0.1, 0);
    for (bool whole = state.range(0) == 0; !whole;) {
      const std::int64_t before = clock.now_ns();
      whole = stage.renderer->draw_piece(stage.picture, kWidth, kHeight, clock, state.range(0) * 1'000'000).value();
      longest = std::max(longest, static_cast<double>(clock.now_ns() - before) * 1e-6);
    }
    const std::int64_t before = clock.now_ns();
    benchmark::DoNotOptimize(stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight));
    glFinish();
    longest = std::max(longest, static_cast<double>(clock.now_ns() - before) * 1e-6);
  }
  state.counters["longest_ms"] = longest;
  state.counters["pieces"] = static_cast<double>(stage.renderer->figures().pieces_drawn);
  state.SetLabel(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}
/// Shells of 0.9, each a part of its own, in a grid of 1. Argument: 0 turning as they are, 1 turning with levels of detail, 2 at rest.
void many_parts(benchmark::State& state) {
  constexpr std::uint32_t kPartsAcross = 317;
  const auto source = std::make_shared<test::TestSource>();
  for (std::uint32_t part = 0; part < kPartsAcross * kPartsAcross; ++part) {
    const mesh::Vec3 at(part % kPartsAcross, part / kPartsAcross, 0);
    const std::uint32_t first = source->add_node(at);
    for (const mesh::Vec3& to : {mesh::Vec3(0.9, 0, 0), mesh::Vec3(0.9, 0.9, 0), mesh::Vec3(0, 0.9, 0)}) source->add_node(at + to);
    source->add_shell(first, first + 1, first + 2, first + 3, part);
  }
  Stage stage(0, "side-by-side", 1);
  (void)stage.renderer->set_model(source);
  stage.picture.view.bounds = stereo::sphere_around(stage.renderer->bounds());
  stage.picture.view = stage.renderer->fitted(stage.picture.view, stereo::screen_size_mm(stage.picture.profile, kWidth, kHeight));
  if (state.range(0) > 0) (void)stage.renderer->set_levels(render::make_levels(*source).value());
  stage.picture.moving = state.range(0) < 2;
  for (auto _ : state) {
    stage.picture.view = stereo::orbit(stage.picture.view, 0.01, 0);
    benchmark::DoNotOptimize(stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight));
    glFinish();
  }
  state.counters["triangles"] = static_cast<double>(stage.renderer->figures().moving_triangles);
  state.counters["off_by"] = stage.renderer->figures().moving_pixels;
}
BENCHMARK(many_parts)->ArgName("how")->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

BENCHMARK(at_rest)->ArgName("budget_ms")->Arg(0)->Arg(50)->Arg(25)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

std::size_t resident_bytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t pages = 0;
  in >> pages >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Turns a sheet once around and dives to its middle and back: 120 pictures for both eyes at 1920 x 1080. Argument: quads along a side. For
/// each picture wall time; memory is that of the whole program.
void path(benchmark::State& state) {
  constexpr int kPathWidth = 1920, kPathHeight = 1080, kTurns = 80, kDives = 40;
  display::Headless headless = std::move(*display::Headless::create());
  const auto renderer = std::move(*render::Renderer::create({}));
  const render::Offscreen target = std::move(*render::Offscreen::create(kPathWidth, kPathHeight));
  const auto source = std::make_shared<test::TestSource>(sheet_of(static_cast<std::uint32_t>(state.range(0))));
  (void)renderer->set_model(source);
  if (source->shell_nodes.size() > kiosk::LevelsWorker::kFewestShells) (void)renderer->set_levels(render::make_levels(*source).value());
  render::Picture picture;
  picture.profile = *stereo::find_profile("side-by-side");
  picture.view.rotation = *stereo::named_rotation("iso");
  picture.view.bounds = stereo::sphere_around(renderer->bounds());
  picture.view = renderer->fitted(picture.view, stereo::screen_size_mm(picture.profile, kPathWidth, kPathHeight));
  picture.moving = source->shell_nodes.size() > kiosk::LevelsWorker::kFewestShells;
  std::vector<double> times;
  std::size_t triangles = 0;
  double pixels = 0;
  const auto draw = [&] {
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(renderer->draw(picture, target.framebuffer(), kPathWidth, kPathHeight));
    glFinish();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    triangles = std::max(triangles, renderer->figures().moving_triangles);
    pixels = std::max(pixels, renderer->figures().moving_pixels);
  };
  for (auto _ : state) {
    const stereo::View begin = picture.view;
    for (int k = 1; k <= kTurns; ++k) {
      picture.view = stereo::orbit(begin, 2 * 3.14159265358979 * k / kTurns, 0.3 * std::sin(2 * 3.14159265358979 * k / kTurns));
      draw();
    }
    for (int k = 1; k <= kDives; ++k) {
      picture.view = stereo::zoom(begin, std::pow(40.0, std::sin(3.14159265358979 * k / kDives)), {0, 0});
      draw();
    }
    picture.view = begin;
  }
  std::sort(times.begin(), times.end());
  state.counters["p50_ms"] = times[times.size() / 2];
  state.counters["p99_ms"] = times[times.size() * 99 / 100];
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["pixels"] = pixels;
  state.counters["MB"] = static_cast<double>(resident_bytes()) / 1e6;
  state.SetLabel(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}
BENCHMARK(path)
    ->ArgName("side")
    ->Arg(100)
    ->Arg(316)
    ->Arg(1000)
    ->Arg(2236)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// From a snapshot in which an edit has moved 10,000 nodes of a million shells with levels of detail to the moving picture that shows them.
/// `taking_ms`: wall time until the renderer has the snapshot; `picture_ms`: of the picture for both eyes. Argument: 0: neighbours, else
/// every so many nodes.
void nodes_moved(benchmark::State& state) {
  Stage stage(0, "side-by-side", 1);
  static const auto levels = render::make_levels(*million(0)).value();
  const std::shared_ptr<test::TestSource> source = million(0);
  (void)stage.renderer->set_levels(levels);
  const std::size_t step = std::max<std::size_t>(static_cast<std::size_t>(state.range(0)), 1);
  MonotonicClock clock;
  double taking = 0, drawing = 0;
  std::size_t turn = 0;
  for (auto _ : state) {
    state.PauseTiming();
    std::vector<std::uint8_t> touched(source->positions.size() / mesh::kChunkSize + 1);
    const double up = ++turn % 2 == 0 ? -3 : 3;
    for (std::size_t k = 0; k < 10'000; ++k) {
      const std::size_t node = (step == 1 ? 400'000 : 0) + k * step;
      source->positions[node].z() += up;
      touched[node / mesh::kChunkSize] = 1;
    }
    for (std::size_t c = 0; c < touched.size(); ++c)
      if (touched[c] != 0) source->touch(ipc::SnapshotArray::positions, c);
    const auto next = std::make_shared<test::TestSource>(*source);
    state.ResumeTiming();
    const std::int64_t start = clock.now_ns();
    benchmark::DoNotOptimize(stage.renderer->set_model(next));
    const std::int64_t taken = clock.now_ns();
    benchmark::DoNotOptimize(stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight));
    glFinish();
    taking += static_cast<double>(taken - start) * 1e-6;
    drawing += static_cast<double>(clock.now_ns() - taken) * 1e-6;
  }
  state.counters["taking_ms"] = benchmark::Counter(taking, benchmark::Counter::kAvgIterations);
  state.counters["picture_ms"] = benchmark::Counter(drawing, benchmark::Counter::kAvgIterations);
  state.counters["triangles"] = static_cast<double>(stage.renderer->figures().moving_triangles);
  state.SetLabel(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}
BENCHMARK(nodes_moved)->ArgName("step")->Arg(0)->Arg(100)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// A picture at rest of a million shells with their thickness, after an edit of 10,000 neighbouring nodes. `first_ms`: the processor's time
/// for the plates and the first picture. Argument: 0: as surfaces, 1: as plates.
void plates(benchmark::State& state) {
  Stage stage(0, "mono", 1);
  const std::shared_ptr<test::TestSource> source = million(0);
  source->thickness = {{5, 5}};
  stage.picture.moving = false;
  stage.picture.thickness = state.range(0) == 1;
  MonotonicClock clock;
  const std::int64_t start = clock.now_ns();
  (void)stage.renderer->set_model(std::make_shared<test::TestSource>(*source));
  benchmark::DoNotOptimize(stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight));
  glFinish();
  state.counters["first_ms"] = static_cast<double>(clock.now_ns() - start) * 1e-6;
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t k = 0; k < 10'000; ++k) source->positions[400'000 + k].z() += 1;
    for (std::size_t c = 400'000 / mesh::kChunkSize; c <= 410'000 / mesh::kChunkSize; ++c) source->touch(ipc::SnapshotArray::positions, c);
    const auto next = std::make_shared<test::TestSource>(*source);
    state.ResumeTiming();
    benchmark::DoNotOptimize(stage.renderer->set_model(next));
    benchmark::DoNotOptimize(stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight));
    glFinish();
  }
  state.SetLabel(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}
BENCHMARK(plates)->ArgName("plates")->Arg(0)->Arg(1)->Iterations(3)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// From a snapshot in which an edit has changed the quality of 10,000 shells to the picture with their glyphs, with the view unchanged.
/// `taking_s` is the processor time until the renderer has the snapshot, the rest is drawing. Arguments: percentage of shells that warn;
/// whether the edit made and removed shells (1), or moved nodes (0).
void glyphs_after_an_edit(benchmark::State& state) {
  Stage stage(0, "mono", 1);
  stage.picture.moving = false;
  const std::shared_ptr<test::TestSource> source = million(0);
  const auto bad = static_cast<std::size_t>(state.range(0));
  mesh::quality::ShellState warns;
  warns.warn = 1;
  for (std::size_t s = 0; s < source->shell_nodes.size(); ++s)
    if (s % 100 < bad) source->shell_quality[s] = warns;
  source->key = 77;
  (void)stage.renderer->set_model(source);
  std::size_t turn = 0, drawn = 0;
  double taking = 0;
  for (auto _ : state) {
    for (std::size_t s = 400'000; s < 410'000; ++s) source->shell_quality[s] = ++turn % 3 == 0 ? warns : mesh::quality::ShellState{};
    for (std::size_t chunk = 97; chunk < 101; ++chunk) {
      source->touch(ipc::SnapshotArray::shell_quality, chunk);
      if (state.range(1) != 0) source->touch(ipc::SnapshotArray::shell_nodes, chunk);
    }
    const auto start = std::clock();
    benchmark::DoNotOptimize(stage.renderer->set_model(source));
    taking += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const auto report = stage.renderer->draw(stage.picture, stage.target.framebuffer(), kWidth, kHeight);
    glFinish();
    drawn = report ? report->glyphs : 0;
  }
  state.counters["glyphs"] = static_cast<double>(drawn);
  state.counters["taking_s"] = benchmark::Counter(taking, benchmark::Counter::kAvgIterations);
}
BENCHMARK(glyphs_after_an_edit)
    ->ArgNames({"bad", "topology"})
    ->Args({0, 0})
    ->Args({10, 0})
    ->Args({10, 1})
    ->Args({100, 0})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// From a snapshot with another selected node to the renderer that knows it.
void another_node_selected(benchmark::State& state) {
  Stage stage(static_cast<std::size_t>(state.range(0)), "mono", 1);
  const std::shared_ptr<test::TestSource> source = million(static_cast<std::size_t>(state.range(0)));
  (void)stage.renderer->set_model(source);
  for (auto _ : state) {
    source->node_marks[0] ^= mesh::document::kSelected;
    source->touch(ipc::SnapshotArray::node_marks, 0);
    benchmark::DoNotOptimize(stage.renderer->set_model(source));
  }
}
BENCHMARK(another_node_selected)->ArgName("selected")->Arg(0)->Arg(200000)->Unit(benchmark::kMillisecond);

}  // namespace
