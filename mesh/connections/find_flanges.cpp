#include "mesh/connections/find_flanges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "mesh/connections/band_shape.h"
#include "mesh/connections/sheet_stacks.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::connections {

namespace {

/// Shapes are measured on a sheet that has at least this share of the area of the band's largest sheet.
constexpr double kMinAreaOfReference = 0.5;
constexpr std::uint32_t kNoStack = 0xffffffffU;

/// Disjoint sets of stacks.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t of) {
    while (parent_[of] != of) of = parent_[of] = parent_[parent_[of]];
    return of;
  }
  /// The lower one stays the root, so that roots are in the order of the shells.
  void unite(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// An edge of a shell, from corner to corner.
struct DirectedEdge {
  NodeIndex from, to;
};

bool goes_along(const ShellNodes& nodes, const DirectedEdge& edge) {
  const auto corners = static_cast<std::size_t>(nodes.corners());
  for (std::size_t i = 0; i < corners; ++i)
    if (nodes.node[i] == edge.from && nodes.node[(i + 1) % corners] == edge.to) return true;
  return false;
}

/// A border edge of a sheet of a band, and whether the sheet ends or bends there.
struct Border {
  std::vector<BorderEdge> edges;
  double length = 0;
  double clear_length = 0;
};

class Bands {
 public:
  Bands(const Model& model, const FlangeOptions& options, std::vector<SheetStack> stacks)
      : model_(model),
        options_(options),
        stacks_(std::move(stacks)),
        stack_of_(model.shell_count(), kNoStack),
        sheets_(stacks_.size()),
        bands_(stacks_.size()),
        crossing_(stacks_.size(), 0),
        min_cos_(std::cos(kMaxCreaseOfFlange * std::numbers::pi / 180)) {
    for (std::size_t i = 0; i < stacks_.size(); ++i) stack_of_[stacks_[i].shell.value] = static_cast<std::uint32_t>(i);
  }

  std::vector<Flange> find() {
    for (std::uint32_t i = 0; i < stacks_.size(); ++i) {
      grow_over_edges(i);
      grow_over_stack(i);
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> members;  // of bands, by their root
    for (std::uint32_t i = 0; i < stacks_.size(); ++i) members.emplace_back(bands_.root(i), i);
    std::sort(members.begin(), members.end());
    std::vector<Flange> flanges;
    for (auto first = members.begin(); first != members.end();) {
      const auto last = std::find_if(first, members.end(), [&](const auto& each) { return each.first != first->first; });
      std::vector<std::uint32_t> band;
      for (; first != last; ++first) band.push_back(first->second);
      if (std::optional<Flange> flange = flange_of(band)) flanges.push_back(std::move(*flange));
    }
    std::stable_sort(flanges.begin(), flanges.end(), [](const Flange& a, const Flange& b) { return a.length > b.length; });
    return flanges;
  }

 private:
  template <class Visit>
  void each_edge(ShellIndex shell, Visit&& visit) const {
    const ShellNodes& nodes = model_.shell(shell);
    const auto corners = static_cast<std::size_t>(nodes.corners());
    for (std::size_t c = 0; c < corners; ++c) {
      const DirectedEdge edge{nodes.node[c], nodes.node[(c + 1) % corners]};
      if (edge.from != edge.to) visit(edge, model_.adjacency->shells_of(model_.adjacency->find_edge(edge.from, edge.to)));
    }
  }
  double length_of(const DirectedEdge& edge) const {
    return std::sqrt((model_.position(edge.to) - model_.position(edge.from)).squaredNorm());
  }
  /// Whether the sheet goes on from one shell to the other without a crease.
  bool goes_on(ShellIndex a, ShellIndex b, bool opposite) const {
    const double cosine = unit_normal(model_, a).dot(unit_normal(model_, b));
    return (opposite ? -cosine : cosine) >= min_cos_;
  }

  void grow_over_edges(std::uint32_t i) {
    const SheetStack& stack = stacks_[i];
    each_edge(stack.shell, [&](const DirectedEdge& edge, std::span<const ShellIndex> at_edge) {
      for (const ShellIndex other : at_edge) {
        const std::uint32_t j = stack_of_[other.value];
        if (j == kNoStack || j <= i || !stack.same_parts(stacks_[j])) continue;
        const bool opposite = goes_along(model_.shell(other), edge);  // neighbours alike go along it in opposite directions
        if (!goes_on(stack.shell, other, opposite)) continue;
        if (same_place(stack, stacks_[j], opposite)) {
          sheets_.unite(i, j);
          bands_.unite(i, j);
        } else {
          crossing_[i] += length_of(edge);
          crossing_[j] += length_of(edge);
        }
      }
    });
  }
  static bool same_place(const SheetStack& a, const SheetStack& b, bool opposite) {
    return a.same_order(b, opposite) && a.own == (opposite ? b.sheets - 1 - b.own : b.own);
  }

  void grow_over_stack(std::uint32_t i) {
    for (std::size_t s = 0; s < stacks_[i].sheets; ++s) {
      const std::uint32_t j = stack_of_[stacks_[i].hit[s].value];
      if (j != kNoStack && j != i && stacks_[i].same_parts(stacks_[j])) bands_.unite(i, j);
    }
  }

  std::optional<Flange> flange_of(const std::vector<std::uint32_t>& band) {
    Flange flange;
    double crossing = 0, area = 0;
    for (const std::uint32_t i : band) {
      const SheetStack& stack = stacks_[i];
      const double its_area = area_of(model_, stack.shell);
      flange.shells.push_back(stack.shell);
      flange.distance += its_area * stack.distance;
      crossing += crossing_[i];
      area += its_area;
    }
    if (!(area > 0)) return std::nullopt;
    flange.distance /= area;
    const SheetStack& first = stacks_[band.front()];
    flange.parts.assign(first.part.begin(), first.part.begin() + first.sheets);
    if (flange.parts.back() < flange.parts.front()) std::reverse(flange.parts.begin(), flange.parts.end());
    std::optional<BandShape> shape = shape_of(band, options_.max_width.value_or(usual_max_width(first)));
    // Each edge where they cross counts twice on each of the sheets, on either side of it.
    if (!shape || crossing > kMaxCrossingShare * shape->length * first.sheets) return std::nullopt;
    flange.nodes = nodes_of(model_, flange.shells);
    flange.middle = std::move(shape->middle);
    flange.sides = std::move(shape->sides);
    flange.closed = shape->closed;
    flange.length = shape->length;
    flange.mean_width = shape->mean_width;
    flange.min_width = shape->min_width;
    return flange;
  }
  double usual_max_width(const SheetStack& stack) const {
    double sum = 0;
    for (std::size_t s = 0; s < stack.sheets; ++s) sum += quality::thickness_of(model_, stack.hit[s].value);
    return kMaxWidthInThicknesses * (sum / stack.sheets + options_.gap);
  }

  /// Of the sheet with the clearest border; of equally clear ones the first.
  std::optional<BandShape> shape_of(const std::vector<std::uint32_t>& band, double max_width) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> members;  // of sheets, by their root
    for (const std::uint32_t i : band) members.emplace_back(sheets_.root(i), i);
    std::sort(members.begin(), members.end());
    struct Sheet {
      ShellSet shells;
      double area = 0;
    };
    std::vector<Sheet> sheets;
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (m == 0 || members[m].first != members[m - 1].first) sheets.emplace_back();
      sheets.back().shells.push_back(stacks_[members[m].second].shell);
      sheets.back().area += area_of(model_, sheets.back().shells.back());
    }
    double largest = 0, clearest = -1;
    for (const Sheet& sheet : sheets) largest = std::max(largest, sheet.area);
    const Sheet* reference = nullptr;
    Border border;
    for (const Sheet& sheet : sheets) {
      if (sheet.area < kMinAreaOfReference * largest) continue;
      Border its = border_of(sheet.shells);
      const double clear = its.length > 0 ? its.clear_length / its.length : 0;
      if (clear > clearest + 1e-9) clearest = clear, reference = &sheet, border = std::move(its);
    }
    if (reference == nullptr) return std::nullopt;
    std::optional<BandShape> shape = band_shape(model_, border.edges, reference->area, max_width, kMinLengthInWidths);
    const double size = std::sqrt(reference->area / static_cast<double>(reference->shells.size()));
    if (shape && shape->length < kMinLengthInShells * size) shape.reset();
    return shape;
  }

  Border border_of(const ShellSet& shells) {
    Border border;
    const std::uint32_t sheet = sheets_.root(stack_of_[shells.front().value]);
    for (const ShellIndex shell : shells)
      each_edge(shell, [&](const DirectedEdge& edge, std::span<const ShellIndex> at_edge) {
        bool inside = false, clear = true;
        for (const ShellIndex other : at_edge) {
          if (other == shell) continue;
          const std::uint32_t j = stack_of_[other.value];
          inside |= j != kNoStack && sheets_.root(j) == sheet;
          clear &= !goes_on(shell, other, goes_along(model_.shell(other), edge));
        }
        if (inside) return;
        border.edges.emplace_back(edge.from, edge.to);
        border.length += length_of(edge);
        if (clear) border.clear_length += length_of(edge);
      });
    return border;
  }

  const Model& model_;
  const FlangeOptions& options_;
  std::vector<SheetStack> stacks_;
  std::vector<std::uint32_t> stack_of_;  ///< one a shell
  Sets sheets_;                          ///< joined over edges
  Sets bands_;                           ///< and over stacks
  std::vector<double> crossing_;         ///< one a stack: the length of its edges at which the sheets change sides
  double min_cos_;
};

std::vector<PartIndex> parts_without_thickness(const Model& model, OutOfSight out_of_sight) {
  std::vector<std::uint8_t> without(model.parts->size(), 0);
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (const PartIndex part = model.shell_parts[s]; part.valid() && in_sight(model, ShellIndex(s), out_of_sight))
      if (!(quality::thickness_of(model, s) > 0)) without[part.value] = 1;
  std::vector<PartIndex> parts;
  for (std::size_t p = 0; p < without.size(); ++p)
    if (without[p] != 0) parts.emplace_back(p);
  return parts;
}

}  // namespace

Flanges find_flanges(const Model& model, const spatial::BoxTree& tree, const FlangeOptions& options, const Progress& progress) {
  std::vector<SheetStack> stacks = find_stacks(model, tree, options, progress);
  Flanges flanges{Bands(model, options, std::move(stacks)).find(), parts_without_thickness(model, options.out_of_sight)};
  if (progress && !progress(1)) return {};
  return flanges;
}

}  // namespace prismesh::mesh::connections
