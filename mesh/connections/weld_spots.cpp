#include "mesh/connections/weld_spots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "mesh/connections/sheet_reach.h"
#include "mesh/connections/sheet_stacks.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::connections {

namespace {

/// Sheets closer than this share of a side are at one place: an edge of one sheet was hit, which belongs to several shells.
constexpr double kSamePlace = 1e-6;
/// A length within this share of a whole number of pitches counts as that number.
constexpr double kWholePitch = 1e-9;

struct SpotHit {
  double height = 0;
  PartIndex part;
  ShellIndex shell;
};

double known_thickness(const Model& model, ShellIndex shell) {
  const double known = quality::thickness_of(model, shell.value);
  return std::isfinite(known) && known > 0 ? known : 0;
}

bool share_a_node(const ShellNodes& a, const ShellNodes& b) {
  return std::any_of(a.node.begin(), a.node.end(),
                     [&](NodeIndex node) { return std::find(b.node.begin(), b.node.end(), node) != b.node.end(); });
}

/// All sheets on the line between two heights, from below, each once.
std::vector<SpotHit> hits_on_line(const Model& model, const spatial::BoxTree& tree, const Vec3& place, const Vec3& normal, double from,
                                  double to) {
  std::vector<SpotHit> hits;
  const Vec3 first = place + from * normal, last = place + to * normal;
  tree.near_box(first.cwiseMin(last), first.cwiseMax(last), kSamePlace * (to - from), [&](ShellIndex shell, const spatial::FloatBox&) {
    if (model.is_removed(shell)) return true;
    if (const std::optional<double> height = height_of(tree, shell, place, normal); height && *height >= from && *height <= to)
      hits.push_back({*height, model.shell_parts[shell.value], shell});
    return true;
  });
  std::sort(hits.begin(), hits.end(),
            [](const SpotHit& a, const SpotHit& b) { return std::tie(a.height, a.shell) < std::tie(b.height, b.shell); });
  std::vector<SpotHit> sheets;
  for (const SpotHit& hit : hits) {
    const double same = kSamePlace * mean_side(model, hit.shell);
    const bool again = std::any_of(sheets.begin(), sheets.end(), [&](const SpotHit& other) {
      return hit.height - other.height <= same && share_a_node(model.shell(hit.shell), model.shell(other.shell));
    });
    if (!again) sheets.push_back(hit);
  }
  return sheets;
}

}  // namespace

double length_of(std::span<const Vec3> line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

std::vector<Vec3> spots_along(std::span<const Vec3> line, bool closed, const SpotSpacing& spacing) {
  const double length = length_of(line);
  std::vector<double> at;
  if (closed) {
    const double count = std::max(1.0, std::round(length / spacing.pitch));
    for (double i = 0; i < count; ++i) at.push_back(i * length / count);
  } else {
    const double between = std::max(0.0, length - 2 * spacing.end_distance);
    const double steps = std::floor(between / spacing.pitch + 0.5 + kWholePitch);
    if (steps < 1) at.push_back(length / 2);
    for (double i = 0; steps >= 1 && i <= steps; ++i) at.push_back(spacing.end_distance + i * between / steps);
  }
  std::vector<Vec3> spots;
  double passed = 0;
  std::size_t next = 0;
  for (std::size_t i = 1; i < line.size() && next < at.size(); ++i) {
    const double step = (line[i] - line[i - 1]).norm();
    const bool last = i + 1 == line.size();
    for (; next < at.size() && (last || at[next] <= passed + step); ++next)
      spots.push_back(step > 0 ? Vec3(line[i - 1] + std::min(1.0, (at[next] - passed) / step) * (line[i] - line[i - 1])) : line[i]);
    passed += step;
  }
  return spots;
}

double distance_to(std::span<const Vec3> line, const Vec3& point) {
  double least = line.empty() ? std::numeric_limits<double>::infinity() : (line.front() - point).norm();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3 along = line[i] - line[i - 1];
    const double size2 = along.squaredNorm();
    const double share = size2 > 0 ? std::clamp((point - line[i - 1]).dot(along) / size2, 0.0, 1.0) : 0;
    least = std::min(least, (line[i - 1] + share * along - point).norm());
  }
  return least;
}

SpotStack stack_at(const Model& model, const spatial::BoxTree& tree, const Vec3& place, const SpotOptions& options) {
  SpotStack stack;
  const std::optional<spatial::SurfacePoint> nearest = tree.closest(place);
  if (!nearest) return stack;
  if (nearest->distance > sheet_reach(model, nearest->shell, Attachment::placed) + options.gap) {
    stack.nearest = nearest->distance;
    return stack;
  }
  const Vec3 normal = unit_normal(model, nearest->shell);
  if (!(normal.squaredNorm() > 0)) return stack;
  const auto limit = [&](const SpotHit& a, const SpotHit& b) {
    return options.thickness_factor * (known_thickness(model, a.shell) + known_thickness(model, b.shell)) / 2 + options.gap;
  };
  // As far as a stack of the greatest number of sheets may be high, all as thick as the nearest; thicker ones are found beyond it.
  double reach = nearest->distance +
                 static_cast<double>(kMaxSheets) * (2 * options.thickness_factor * known_thickness(model, nearest->shell) + options.gap) +
                 kSamePlace * mean_side(model, nearest->shell);
  const std::vector<SpotHit> hits = hits_on_line(model, tree, place, normal, -reach, reach);
  const auto own = std::min_element(hits.begin(), hits.end(),
                                    [](const SpotHit& a, const SpotHit& b) { return std::abs(a.height) < std::abs(b.height); });
  if (own == hits.end()) return stack;
  auto first = own, last = own;
  const auto neighbours = [&](const SpotHit& a, const SpotHit& b) { return b.height - a.height <= limit(a, b) * (1 + kSamePlace); };
  while (first != hits.begin() && neighbours(*(first - 1), *first)) --first;
  while (last + 1 != hits.end() && neighbours(*last, *(last + 1))) ++last;
  for (auto hit = first; hit <= last; ++hit) stack.sheets.push_back({hit->shell, place + hit->height * normal});
  return stack;
}

}  // namespace prismesh::mesh::connections
