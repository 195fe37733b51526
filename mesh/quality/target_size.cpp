#include "mesh/quality/target_size.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <tuple>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::quality {

namespace {

constexpr std::size_t kEdgeGrain = 65536;  ///< nodes of a parallel range
constexpr double kElongated = 2;           ///< upper over lower quartile of the edges of elongated shells

/// A value with two significant digits.
double rounded_to_two_digits(double value) {
  // through text: powers of ten are exact there
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return std::strtod(text, nullptr);
}

/// The length of each edge of the adjacency; not finite where a coordinate isn't.
std::vector<float> edge_lengths(const Model& model) {
  const Adjacency& adjacency = *model.adjacency;
  std::vector<float> lengths(adjacency.edge_count());
  parallel_for(model.node_count(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t low = begin; low < end; ++low)
      for (std::size_t e = adjacency.edge_first[low]; e < adjacency.edge_first[low + 1]; ++e)
        lengths[e] = static_cast<float>((model.position(adjacency.edge_high[e]) - model.positions[low]).norm());
  });
  return lengths;
}

/// The length that so many quarters of the lengths are shorter than. Reorders them.
double quantile(std::vector<float>& lengths, std::size_t quarters) {
  const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(quarters * lengths.size() / 4);
  std::nth_element(lengths.begin(), place, lengths.end());
  return *place;
}

/// 0: there are none, or the median has no length.
double rounded_median(std::vector<float>& lengths) {
  const double median = lengths.empty() ? 0 : quantile(lengths, 2);
  return median > 0 ? rounded_to_two_digits(median) : 0;
}

/// The median, or, of elongated shells, whose sides have two lengths, the geometric mean of both: the median would be one of the two.
double rounded_middle(std::vector<float>& lengths) {
  if (lengths.empty()) return 0;
  const double lower = quantile(lengths, 1), upper = quantile(lengths, 3);
  if (!(lower > 0 && upper > kElongated * lower)) return rounded_median(lengths);
  return rounded_to_two_digits(std::sqrt(lower * upper));
}

/// The finite lengths of each part's edges.
std::vector<std::vector<float>> lengths_by_part(const Model& model) {
  const Adjacency& adjacency = *model.adjacency;
  const std::vector<float> lengths = edge_lengths(model);
  std::vector<std::vector<float>> of_part(model.parts->size());
  std::vector<PartIndex> counted;  // the edge's parts so far
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    if (!std::isfinite(lengths[e])) continue;
    counted.clear();
    for (const ShellIndex shell : adjacency.shells_of(EdgeIndex(e))) {
      const PartIndex part = model.shell_parts[shell.value];
      if (!part.valid() || std::find(counted.begin(), counted.end(), part) != counted.end()) continue;
      counted.push_back(part);
      of_part[part.value].push_back(lengths[e]);
    }
  }
  return of_part;
}

}  // namespace

double guess_target_size(const Model& model) {
  std::vector<float> lengths = edge_lengths(model);
  std::erase_if(lengths, [](float length) { return !std::isfinite(length); });
  const double median = rounded_median(lengths);
  return median > 0 ? median : 1.0;
}

std::vector<PartCriteria> guess_part_sizes(const Model& model, double deck_size) {
  std::vector<PartCriteria> sizes;
  for (std::vector<float>& lengths : lengths_by_part(model)) {
    const double median = lengths.size() < kMinEdgesOfPart ? 0 : rounded_middle(lengths);
    sizes.push_back({median > 0 ? median : deck_size, nullptr, median > 0 ? SizeFrom::part : SizeFrom::deck});
  }
  return sizes;
}

CriteriaByPart share_entries(const std::vector<PartCriteria>& of_parts) {
  CriteriaByPart shared;
  std::map<std::tuple<double, const Criteria*, SizeFrom>, std::uint32_t> known;
  for (const PartCriteria& each : of_parts) {
    const auto [entry, is_new] =
        known.try_emplace({each.target_size, each.criteria.get(), each.size_from}, static_cast<std::uint32_t>(shared.distinct.size()));
    if (is_new) shared.distinct.push_back(each);
    shared.of_part.push_back(entry->second);
  }
  return shared;
}

}  // namespace prismesh::mesh::quality
