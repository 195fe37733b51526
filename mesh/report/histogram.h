// Histograms of quality metrics before and after a change.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/document/generation.h"
#include "mesh/quality/metrics.h"

namespace prismesh::mesh::report {

inline constexpr std::size_t kHistogramBins = 30;

/// Shells by the value of a metric. The first and the last bin also hold what lies beyond them, where `more_below` and `more_above` say so:
/// a few extreme shells would else leave all others in one bin.
struct Histogram {
  quality::Metric metric = quality::Metric::warpage;
  double low = 0, high = 1;  ///< of the bins, which are of one width
  bool more_below = false, more_above = false;
  std::vector<std::size_t> before, after;  ///< shells in each bin
};

/// Of the metrics that some shell of the two has, in the order of the metrics. Shells with a defect don't count, nor removed ones.
/// The same whatever the number of threads.
std::vector<Histogram> histograms(const document::Generation& before, const document::Generation& after);

}  // namespace prismesh::mesh::report
