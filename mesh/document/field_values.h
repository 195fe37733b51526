// Fills a field's values and computes its figures. Private to mesh/document.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel_for.h"
#include "mesh/document/field.h"
#include "mesh/model/chunked_array.h"

namespace prismesh::mesh::document {

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// `measure(begin, end, out)` writes a double for each entry into `out`, for whole chunks, on any thread. Figures are added up by chunk.
template <class Measure>
void fill(Field& field, std::size_t count, const Measure& measure) {
  struct Partial {
    FieldFigures figures;
    double sum = 0;
  };
  field.values.assign(count, std::numeric_limits<float>::quiet_NaN());
  std::vector<Partial> partials((count + kChunkSize - 1) / kChunkSize);
  parallel_for(count, kChunkSize, [&](std::size_t from, std::size_t to) {
    std::vector<double> values(kChunkSize);
    for (std::size_t begin = from; begin < to; begin += kChunkSize) {
      const std::size_t end = std::min(begin + kChunkSize, to);
      std::fill(values.begin(), values.end(), kNoValue);
      measure(begin, end, values.data());
      Partial& partial = partials[begin / kChunkSize];
      FieldFigures& figures = partial.figures;
      for (std::size_t i = begin; i < end; ++i) {
        const double value = values[i - begin];
        if (!std::isfinite(value)) continue;
        field.values[i] = static_cast<float>(value);
        const auto at = static_cast<std::uint32_t>(i);
        if (figures.measured++ == 0) figures = {1, value, 0, value, at, at};
        if (value < figures.min) figures.min = value, figures.min_at = at;
        if (value > figures.max) figures.max = value, figures.max_at = at;
        partial.sum += value;
      }
    }
  });
  double sum = 0;
  FieldFigures& all = field.figures = {};
  for (const Partial& partial : partials) {
    const FieldFigures& figures = partial.figures;
    if (figures.measured == 0) continue;
    const bool first = all.measured == 0;
    if (first || figures.min < all.min) all.min = figures.min, all.min_at = figures.min_at;
    if (first || figures.max > all.max) all.max = figures.max, all.max_at = figures.max_at;
    all.measured += figures.measured;
    sum += partial.sum;
  }
  if (all.measured > 0) all.mean = sum / static_cast<double>(all.measured);
}

/// Limits that differ even if the values don't.
inline FieldLimits apart(double clear, double full) {
  if (clear != full) return {clear, full};
  return {clear, full + std::max(1e-6, 1e-3 * std::abs(full))};
}

}  // namespace prismesh::mesh::document
