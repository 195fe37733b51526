// The figures and the picture of docs/prediction.md: `prismesh-phase-error` prints tables; `prismesh-phase-error FILE.svg` also plots the
// phase error over time.
#include <cmath>
#include <cstdio>
#include <string>

#include "base/file.h"
#include "tests/phase_error/plot.h"
#include "tests/phase_error/sweeps.h"

namespace prismesh::phase_error {
namespace {

VirtualStationSettings sweeping(const Sweep& sweep, bool predicts, const std::string& profile) {
  VirtualStationSettings settings;
  settings.head = to_and_fro(sweep);
  settings.predicts = predicts;
  settings.profile = on_panel(profile);
  return settings;
}

struct Way {
  const char* name;
  bool predicts;
  const char* profile;
};
constexpr Way kWays[] = {{"predicted, phase map", true, "prism-mask"},
                         {"predicted, fixed columns", true, "prism-mask-columns"},
                         {"as measured, phase map", false, "prism-mask"},
                         {"as measured, fixed columns", false, "prism-mask-columns"}};

void print_header(const char* first) {
  std::printf("\n| %s |", first);
  for (const Way& way : kWays) std::printf(" %s: moved / middle / panel |", way.name);
  std::printf("\n|---|---|---|---|---|\n");
}

void print_row(const Sweep& sweep, double shown) {
  std::printf("| %.0f |", shown);
  for (const Way& way : kWays) {
    const Figures figures = figures_of(sweeping(sweep, way.predicts, way.profile), 2);
    std::printf(" %.3f / %.3f / %.3f |", quantile(figures.moved, 0.99), quantile(figures.middle, 0.99), quantile(figures.panel, 0.99));
    std::fflush(stdout);
  }
  std::printf("\n");
}

Curve curve(bool predicts, const char* name, const char* colour) {
  constexpr double kFrom = 4, kUntil = 8.05;
  Curve drawn{name, colour, {}};
  const VirtualStationSettings settings = sweeping({}, predicts, "prism-mask");
  run(settings, kUntil, [&](const Moment& moment) {
    const double seconds = static_cast<double>(moment.time_ns) * 1e-9;
    if (seconds >= kFrom && moment.drawn.depth_share == 1)
      drawn.points.push_back({seconds - kFrom, phase_of(moment, settings.profile).middle_pixels});
  });
  return drawn;
}

int report(const char* svg_file) {
  std::printf("99th percentiles of phase errors, in pixels, 2 seeds of 20 s each; a head that goes 80 mm to either side.\n");
  print_header("peak speed, mm/s, 650 mm away");
  for (const double speed : {0.0, 50.0, 100.0, 250.0, 412.0, 500.0}) print_row({.peak_mm_s = speed}, speed);
  print_header("distance, mm, at 250 mm/s");
  for (const double distance : {450.0, 550.0, 650.0, 750.0, 900.0}) print_row({.distance_mm = distance}, distance);
  if (svg_file == nullptr) return 0;
  Plot plot;
  plot.title = "Phase error at the screen's middle, head to and fro at 250 mm/s, 650 mm away";
  plot.across = "seconds";
  plot.up = "pixels";
  plot.right = 4;
  plot.top = 0.3;
  plot.limit = 0.15;
  plot.curves = {curve(false, "as measured", "#d55e00"), curve(true, "predicted", "#0072b2")};
  const std::string text = svg(plot);
  const PendingFile file{svg_file, {text}};
  const Result<void> written = replace_files({&file, 1});
  if (written) return 0;
  std::fprintf(stderr, "%s\n", written.error().text().c_str());
  return 1;
}

}  // namespace
}  // namespace prismesh::phase_error

int main(int count, char** words) { return prismesh::phase_error::report(count > 1 ? words[1] : nullptr); }
