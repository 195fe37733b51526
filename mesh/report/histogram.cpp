#include "mesh/report/histogram.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel_for.h"
#include "mesh/quality/measure.h"

namespace prismesh::mesh::report {

namespace {

using quality::kMetricCount;
using quality::Values;

constexpr std::size_t kShellsAtOnce = 4096;
constexpr double kBulk = 0.005;   ///< the share of shells at either end that the bulk leaves out
constexpr double kTooWide = 3.0;  ///< times the bulk: a wider range is cut there

/// Of all shells; those of a shell with a defect are no numbers.
std::vector<Values> values_of(const document::Generation& generation) {
  std::vector<Values> values(generation.model.shell_count());
  parallel_for(values.size(), kShellsAtOnce, [&](std::size_t begin, std::size_t end) {
    quality::measure_range(generation.model, begin, end, std::span(values).subspan(begin, end - begin));
    for (std::size_t shell = begin; shell < end; ++shell)
      if (generation.quality[shell].is_removed() || generation.quality[shell].has_defect()) values[shell].fill(std::nanf(""));
  });
  return values;
}

std::vector<float> of_metric(const std::vector<Values>& values, int metric) {
  std::vector<float> found;
  for (const Values& shell : values)
    if (std::isfinite(shell[metric])) found.push_back(shell[metric]);
  return found;
}

double at_share(std::vector<float>& values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Sets the range of the bins: all values, or the bulk with some room where the others would leave it too narrow.
void set_range(Histogram& histogram, std::vector<float> all) {
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  const double min = *least, max = *most;
  const double low = at_share(all, kBulk), high = at_share(all, 1 - kBulk);
  const double room = std::max((high - low) * kTooWide / 2, 1e-6 * std::max(std::abs(low), std::abs(high)));
  histogram.low = std::max(min, low - room);
  histogram.high = std::min(max, high + room);
  histogram.more_below = min < histogram.low;
  histogram.more_above = max > histogram.high;
  if (!(histogram.high - histogram.low > 1e-6 * std::max(1.0, std::abs(histogram.high)))) {
    const double half = 0.05 * std::max(1.0, std::abs(histogram.low));
    histogram.low -= half;
    histogram.high += half;
  }
}

std::vector<std::size_t> counted_in_bins(const Histogram& histogram, const std::vector<float>& values) {
  std::vector<std::size_t> bins(kHistogramBins);
  const double width = (histogram.high - histogram.low) / static_cast<double>(kHistogramBins);
  for (const float value : values) {
    const double bin = std::clamp((static_cast<double>(value) - histogram.low) / width, 0.0, static_cast<double>(kHistogramBins - 1));
    ++bins[static_cast<std::size_t>(bin)];
  }
  return bins;
}

}  // namespace

std::vector<Histogram> histograms(const document::Generation& before, const document::Generation& after) {
  const std::vector<Values> values_before = values_of(before), values_after = values_of(after);
  std::vector<Histogram> found;
  for (int metric = 0; metric < kMetricCount; ++metric) {
    const std::vector<float> in_a = of_metric(values_before, metric), in_b = of_metric(values_after, metric);
    if (in_a.empty() && in_b.empty()) continue;
    std::vector<float> all = in_a;
    all.insert(all.end(), in_b.begin(), in_b.end());
    Histogram histogram;
    histogram.metric = static_cast<quality::Metric>(metric);
    set_range(histogram, std::move(all));
    histogram.before = counted_in_bins(histogram, in_a);
    histogram.after = counted_in_bins(histogram, in_b);
    found.push_back(std::move(histogram));
  }
  return found;
}

}  // namespace prismesh::mesh::report
