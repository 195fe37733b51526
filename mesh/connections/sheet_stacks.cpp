#include "mesh/connections/sheet_stacks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::connections {

namespace {

constexpr std::size_t kStackGrain = 1024;
constexpr std::size_t kStacksOfBatch = 64 * kStackGrain;
/// A share of the lengths compared, by which they may be off.
constexpr double kStackRounding = 1e-6;

/// Where a shell's normal goes through a sheet.
struct Hit {
  double height = 0;
  std::int64_t level = 0;  ///< the height without its rounding
  PartIndex part;
  ShellIndex shell;
};

bool have_common_node(const ShellNodes& a, const ShellNodes& b) {
  return std::any_of(a.node.begin(), a.node.end(),
                     [&](NodeIndex node) { return std::find(b.node.begin(), b.node.end(), node) != b.node.end(); });
}

Vec3 double_area(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  const auto at = [&](std::size_t i) -> const Vec3& { return model.position(nodes.node[i]); };
  if (nodes.is_triangle()) return (at(1) - at(0)).cross(at(2) - at(0));
  return (at(2) - at(0)).cross(at(3) - at(1));
}

}  // namespace

std::optional<double> height_of(const spatial::BoxTree& tree, ShellIndex shell, const Vec3& point, const Vec3& normal) {
  static const double min_cos = std::cos(kMaxAngleOfFlange * std::numbers::pi / 180);
  std::optional<double> height;
  tree.each_triangle(shell, [&](const Vec3& a, const Vec3& b, const Vec3& c, bool) {
    const Vec3 face = (b - a).cross(c - a);
    const double size = std::sqrt(face.squaredNorm()), along = face.dot(normal);
    if (height || !(size > 0) || std::abs(along) < min_cos * size) return;
    const double at = (a - point).dot(face) / along;
    const Vec3 on = point + at * normal;
    const auto inside = [&](const Vec3& from, const Vec3& to) {
      return (to - from).cross(on - from).dot(face) >= -kStackRounding * size * size;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a)) height = at;
  });
  return height;
}

namespace {

class StackFinder {
 public:
  StackFinder(const Model& model, const spatial::BoxTree& tree, const FlangeOptions& options)
      : model_(model), tree_(tree), options_(options) {
    for (std::size_t s = 0; s < model.shell_count(); ++s)
      if (in_sight(model, ShellIndex(s), options.out_of_sight)) max_thickness_ = std::max(max_thickness_, thickness(ShellIndex(s)));
  }

  std::optional<SheetStack> at(ShellIndex shell, std::vector<Hit>& hits) const {
    if (!in_sight(model_, shell, options_.out_of_sight) || !tree_.contains(shell)) return std::nullopt;
    const Vec3 normal = unit_normal(model_, shell);
    if (!(normal.squaredNorm() > 0)) return std::nullopt;
    const double reach = limit(thickness(shell), max_thickness_);
    if (!(reach > 0)) return std::nullopt;
    // Each search goes as far as a neighbour of the sheets found so far may be.
    double below = 0, above = 0;
    std::optional<SheetStack> stack;
    while (true) {
      find_hits(shell, normal, below - reach, above + reach, hits);
      const std::optional<Range> range = stack_range(shell, hits);
      if (!range) return std::nullopt;
      if (stack && stack->sheets == range->size()) return stack;
      stack = stack_of(shell, *range);
      below = range->front().height;
      above = range->back().height;
    }
  }

 private:
  double thickness(ShellIndex shell) const {
    const double known = quality::thickness_of(model_, shell.value);
    return std::isfinite(known) && known > 0 ? known : 0;
  }
  double limit(double a, double b) const { return options_.thickness_factor * (a + b) / 2 + options_.gap; }

  using Range = std::span<const Hit>;

  /// All between two heights, the shell itself included, from below.
  void find_hits(ShellIndex shell, const Vec3& normal, double from, double to, std::vector<Hit>& hits) const {
    const ShellNodes& nodes = model_.shell(shell);
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < nodes.corners(); ++i) centre += model_.position(nodes.node[static_cast<std::size_t>(i)]);
    centre /= nodes.corners();
    const double step = kStackRounding * std::sqrt(area_of(model_, shell));
    hits.assign(1, {0, 0, model_.shell_parts[shell.value], shell});
    const double more = kStackRounding * (to - from);
    const Vec3 first = centre + (from - more) * normal, last = centre + (to + more) * normal;
    tree_.near_box(first.cwiseMin(last), first.cwiseMax(last), step, [&](ShellIndex other, const spatial::FloatBox&) {
      if (other == shell || !in_sight(model_, other, options_.out_of_sight) || have_common_node(nodes, model_.shell(other))) return true;
      const std::optional<double> height = height_of(tree_, other, centre, normal);
      if (height && *height >= from - more && *height <= to + more)
        hits.push_back({*height, std::llround(*height / step), model_.shell_parts[other.value], other});
      return true;
    });
    // Sheets at the same place are in the order of their parts, so that neighbouring shells have the same order.
    std::sort(hits.begin(), hits.end(),
              [](const Hit& a, const Hit& b) { return std::tie(a.level, a.part, a.shell) < std::tie(b.level, b.part, b.shell); });
    // The line may go through an edge of a sheet: its shells count once.
    const auto repeats = [&](const Hit& a, const Hit& b) {
      return b.level - a.level <= 1 && a.part == b.part && have_common_node(model_.shell(a.shell), model_.shell(b.shell));
    };
    hits.erase(std::unique(hits.begin(), hits.end(), repeats), hits.end());
  }

  /// The hits of the stack; nothing if it has one sheet or too many.
  std::optional<Range> stack_range(ShellIndex shell, const std::vector<Hit>& hits) const {
    const auto own = std::find_if(hits.begin(), hits.end(), [&](const Hit& hit) { return hit.shell == shell; });
    if (own == hits.end()) return std::nullopt;
    const auto neighbours = [&](const Hit& a, const Hit& b) {
      return b.height - a.height <= limit(thickness(a.shell), thickness(b.shell)) * (1 + kStackRounding);
    };
    auto first = own, last = own;
    while (first != hits.begin() && neighbours(*(first - 1), *first)) --first;
    while (last + 1 != hits.end() && neighbours(*last, *(last + 1))) ++last;
    const auto sheets = static_cast<std::size_t>(last - first) + 1;
    if (sheets < 2 || sheets > kMaxSheets) return std::nullopt;
    return Range(first, last + 1);
  }

  static SheetStack stack_of(ShellIndex shell, Range range) {
    SheetStack stack;
    stack.shell = shell;
    for (const Hit& hit : range) {
      if (hit.shell == shell) stack.own = stack.sheets;
      stack.hit[stack.sheets] = hit.shell;
      stack.part[stack.sheets++] = hit.part;
    }
    stack.distance = (range.back().height - range.front().height) / static_cast<double>(range.size() - 1);
    return stack;
  }

  const Model& model_;
  const spatial::BoxTree& tree_;
  const FlangeOptions& options_;
  double max_thickness_ = 0;
};

}  // namespace

bool SheetStack::same_order(const SheetStack& other, bool opposite) const {
  if (sheets != other.sheets) return false;
  for (std::size_t i = 0; i < sheets; ++i)
    if (part[i] != other.part[opposite ? sheets - 1 - i : i]) return false;
  return true;
}

Vec3 unit_normal(const Model& model, ShellIndex shell) {
  const Vec3 normal = double_area(model, shell);
  const double size = std::sqrt(normal.squaredNorm());
  return std::isfinite(size) && size > 0 ? Vec3(normal / size) : Vec3(Vec3::Zero());
}

double area_of(const Model& model, ShellIndex shell) { return std::sqrt(double_area(model, shell).squaredNorm()) / 2; }

std::vector<SheetStack> find_stacks(const Model& model, const spatial::BoxTree& tree, const FlangeOptions& options,
                                    const Progress& progress) {
  const StackFinder finder(model, tree, options);
  const std::size_t count = model.shell_count();
  std::vector<SheetStack> stacks;
  for (std::size_t first = 0; first < count; first += kStacksOfBatch) {
    const std::size_t shells = std::min(kStacksOfBatch, count - first);
    std::vector<std::vector<SheetStack>> of_range((shells + kStackGrain - 1) / kStackGrain);
    parallel_for(shells, kStackGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<Hit> hits;
      for (std::size_t s = begin; s < end; ++s)
        if (const std::optional<SheetStack> stack = finder.at(ShellIndex(first + s), hits)) of_range[begin / kStackGrain].push_back(*stack);
    });
    for (const std::vector<SheetStack>& some : of_range) stacks.insert(stacks.end(), some.begin(), some.end());
    if (progress && !progress(0.8 * static_cast<double>(first + shells) / static_cast<double>(count))) return {};
  }
  return stacks;
}

}  // namespace prismesh::mesh::connections
