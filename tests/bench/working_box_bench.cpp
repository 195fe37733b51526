// Computes the working box of the example display, as counters: from where each eye sees its own picture all over the panel. Measures
// mapping the phases of a picture.
#include <benchmark/benchmark.h>

#include "drivers/display/working_box.h"

namespace prismesh::drivers::display {
namespace {

/// A 17 inch panel of 1280 x 1024 pixels, 0.2805 mm each.
constexpr PanelArea kPanel{0, 0, 1280, 1024, 1280, 1024};

void depths(benchmark::State& state, Composing composing, double limit) {
  std::optional<DepthSpan> span;
  for (auto _ : state) span = working_depths({.panel = kPanel, .composing = composing}, static_cast<double>(state.range(0)), limit);
  state.counters["x_mm"] = static_cast<double>(state.range(0));
  state.counters["nearest_mm"] = span ? span->min_mm : 0;
  state.counters["farthest_mm"] = span ? span->max_mm : 0;
}
const auto at_places = [](benchmark::internal::Benchmark* bench) {
  for (const int x : {0, 50, 100, 150, 200, 300}) bench->Arg(x);
  bench->Iterations(1)->Unit(benchmark::kMillisecond);
};
BENCHMARK_CAPTURE(depths, quarter_pixel_fixed_columns, Composing::fixed_columns, 0.25)->Apply(at_places);
BENCHMARK_CAPTURE(depths, quarter_pixel_pixels, Composing::pixels, 0.25)->Apply(at_places);
BENCHMARK_CAPTURE(depths, quarter_pixel_subpixels, Composing::subpixels, 0.25)->Apply(at_places);
BENCHMARK_CAPTURE(depths, own_light_fixed_columns, Composing::fixed_columns, 0.5)->Apply(at_places);
BENCHMARK_CAPTURE(depths, own_light_pixels, Composing::pixels, 0.5)->Apply(at_places);
BENCHMARK_CAPTURE(depths, own_light_subpixels, Composing::subpixels, 0.5)->Apply(at_places);

/// Worst phase errors with the head straight before the panel.
void errors_at(benchmark::State& state) {
  const Eigen::Vector3d head(0, 0, static_cast<double>(state.range(0)));
  const auto error = [&](Composing composing) { return worst_phase_error({.panel = kPanel, .composing = composing}, head); };
  for (auto _ : state) {
    state.counters["fixed_columns"] = error(Composing::fixed_columns);
    state.counters["pixels"] = error(Composing::pixels);
    state.counters["subpixels"] = error(Composing::subpixels);
  }
}
BENCHMARK(errors_at)->DenseRange(450, 1000, 50)->Iterations(1);

/// How far aside the head may be at the design distance.
void sideways(benchmark::State& state, Composing composing, double limit) {
  double x = 0;
  for (auto _ : state)
    while (x < 600 && worst_phase_error({.panel = kPanel, .composing = composing}, {x, 0, 650}) <= limit) x += 2;
  state.counters["x_mm"] = x - 2;
}
BENCHMARK_CAPTURE(sideways, quarter_pixel_fixed_columns, Composing::fixed_columns, 0.25)->Iterations(1);
BENCHMARK_CAPTURE(sideways, quarter_pixel_subpixels, Composing::subpixels, 0.25)->Iterations(1);
BENCHMARK_CAPTURE(sideways, own_light_fixed_columns, Composing::fixed_columns, 0.5)->Iterations(1);
BENCHMARK_CAPTURE(sideways, own_light_subpixels, Composing::subpixels, 0.5)->Iterations(1);

void map_phases(benchmark::State& state) {
  MaskOptics optics;
  optics.lean = state.range(0) == 0 ? 0 : 1.0 / 6;
  const PanelArea panel{0, 0, 1920, 1080, 1920, 1080};
  const EyePair eyes = eyes_from({40, 20, 600}, kMeanEyeSeparationMm);
  for (auto _ : state) benchmark::DoNotOptimize(phase_map(optics, eyes, 0.2, panel));
}
BENCHMARK(map_phases)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void one_window_number(benchmark::State& state) {
  const MaskOptics optics;
  double u = -250;
  for (auto _ : state) {
    benchmark::DoNotOptimize(window_number(optics, {40, 20, 600}, 0.2, u, 90));
    u += 0.01;
  }
}
BENCHMARK(one_window_number);

}  // namespace
}  // namespace prismesh::drivers::display
