#include "tests/phase_error/sweeps.h"

#include <cmath>

#include "tests/support/head_trials.h"

namespace prismesh::phase_error {

drivers::eye_tracker::HeadSource to_and_fro(const Sweep& sweep) {
  return [sweep](double seconds) {
    drivers::eye_tracker::SimulatedHead head;
    const double x = sweep.peak_mm_s > 0 ? sweep.reach_mm * std::sin(sweep.peak_mm_s / sweep.reach_mm * seconds) : 40;
    head.between_eyes_mm = {x, 0, sweep.distance_mm};
    return head;
  };
}

Figures figures_of(VirtualStationSettings settings, int seeds, double seconds) {
  Figures figures;
  for (int seed = 1; seed <= seeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    run(settings, seconds, [&](const Moment& moment) {
      ++figures.moments;
      if (moment.drawn.depth_share < 1) return;
      const Phase phase = phase_of(moment, settings.profile);
      figures.moved.push_back(phase.moved_pixels);
      figures.middle.push_back(phase.middle_pixels);
      figures.panel.push_back(phase.panel_pixels);
      figures.head_mm.push_back(std::abs(moment.drawn.between_eyes_mm.x() - moment.head_mm.x()));
    });
  }
  return figures;
}

double quantile(std::vector<double> values, double share) {
  return values.empty() ? NAN : drivers::eye_tracker::trials::quantile(std::move(values), share);
}

}  // namespace prismesh::phase_error
