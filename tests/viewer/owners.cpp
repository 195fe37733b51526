#include "tests/viewer/owners.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prismesh::viewer {

namespace {

/// A run of stripes of one owner; ends in pixels from the panel's left border.
struct Run {
  double begin = 0, end = 0;
  double middle() const { return 0.5 * (begin + end); }
};

bool belongs(Owner owner, Owner eye) { return owner == eye || owner == Owner::both; }

std::vector<Run> runs_of(const Owners& owners, int row, Owner eye) {
  std::vector<Run> runs;
  for (int stripe = 0; stripe < 3 * owners.columns; ++stripe) {
    if (!belongs(owners.at(row, stripe), eye)) continue;
    if (runs.empty() || std::lround(3 * runs.back().end) != stripe) runs.push_back({stripe / 3.0, stripe / 3.0});
    runs.back().end = (stripe + 1) / 3.0;
  }
  return runs;
}

/// The run with the nearest middle; `runs` isn't empty.
const Run& nearest(const std::vector<Run>& runs, double at) {
  const auto after = std::lower_bound(runs.begin(), runs.end(), at, [](const Run& run, double place) { return run.middle() < place; });
  if (after == runs.begin()) return *after;
  if (after == runs.end()) return runs.back();
  return after->middle() - at < at - (after - 1)->middle() ? *after : *(after - 1);
}

double wrong_share(const Owners& owners, int row, Owner eye, double at) {
  const Owner other = eye == Owner::left ? Owner::right : Owner::left;
  double wrong = 0;
  for (auto stripe = static_cast<int>(3 * (at - 0.5)); stripe <= static_cast<int>(3 * (at + 0.5)); ++stripe)
    if (stripe < 3 * owners.columns && owners.at(row, stripe) == other)
      wrong += std::max(0.0, std::min(at + 0.5, (stripe + 1) / 3.0) - std::max(at - 0.5, stripe / 3.0));
  return wrong;
}

}  // namespace

Result<Owners> owners_of(const Panel& panel, const LightImage& left_lit, const LightImage& right_lit) {
  if (left_lit.width != right_lit.width || left_lit.height != right_lit.height)
    return fail("owners", "the two pictures that say whose a stripe is differ in size");
  Owners owners{left_lit.width, left_lit.height, {}};
  owners.stripes.reserve(left_lit.pixels.size() * 3);
  for (std::size_t i = 0; i < left_lit.pixels.size(); ++i)
    for (std::size_t stripe = 0; stripe < 3; ++stripe) {
      const std::size_t channel = panel.stripes == Stripes::bgr ? 2 - stripe : stripe;
      const bool left = left_lit.pixels[i][channel] > 0.5F, right = right_lit.pixels[i][channel] > 0.5F;
      owners.stripes.push_back(left ? right ? Owner::both : Owner::left : right ? Owner::right : Owner::nobody);
    }
  return owners;
}

std::vector<PhaseError> phase_errors(const MaskDisplay& display, const Owners& owners, Owner eye_is, const Point& eye, double mask_mm,
                                     const std::vector<int>& rows) {
  std::vector<PhaseError> errors;
  const Panel& panel = display.panel;
  const double side = 0.5 * panel.width_mm() - 0.5 * panel.pitch_mm;
  for (const int row : rows) {
    const double v = panel.row_height_mm(row);
    const std::vector<Run> runs = runs_of(owners, row, eye_is);
    const auto first = static_cast<int>(std::ceil(element_at(display, eye, mask_mm, -side, v)));
    const auto last = static_cast<int>(std::floor(element_at(display, eye, mask_mm, side, v)));
    for (int element = first; element <= last; ++element) {
      const double u = window_of(display, eye, mask_mm, element, v).u_mm;
      const double at = u / panel.pitch_mm + 0.5 * panel.columns;
      PhaseError error{element, row, u, std::numeric_limits<double>::quiet_NaN(), 0, wrong_share(owners, row, eye_is, at)};
      if (!runs.empty()) {
        const Run& run = nearest(runs, at);
        if (run.begin <= 0 || run.end >= panel.columns) continue;
        error.off_pixels = run.middle() - at;
        error.run_pixels = run.end - run.begin;
      }
      errors.push_back(error);
    }
  }
  return errors;
}

PhaseSummary phase_summary(const MaskDisplay& display, const Owners& owners, const Eyes& eyes, double mask_mm,
                           const std::vector<int>& rows) {
  std::vector<double> off;
  PhaseSummary summary;
  for (const Owner owner : {Owner::left, Owner::right})
    for (const PhaseError& error : phase_errors(display, owners, owner, owner == Owner::left ? eyes.left : eyes.right, mask_mm, rows)) {
      off.push_back(std::isnan(error.off_pixels) ? std::numeric_limits<double>::infinity() : std::abs(error.off_pixels));
      summary.mean_pixels += off.back();
      summary.worst_wrong_share = std::max(summary.worst_wrong_share, error.wrong_share);
      summary.mean_wrong_share += error.wrong_share;
    }
  summary.windows = off.size();
  if (off.empty()) return summary;
  const auto count = static_cast<double>(off.size());
  summary.mean_pixels /= count;
  summary.mean_wrong_share /= count;
  std::sort(off.begin(), off.end());
  summary.worst_pixels = off.back();
  summary.p99_pixels = off[static_cast<std::size_t>(0.99 * (count - 1))];
  return summary;
}

}  // namespace prismesh::viewer
