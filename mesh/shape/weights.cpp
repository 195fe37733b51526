#include "mesh/shape/weights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/shape/free_edge.h"
#include "mesh/shape/weights_carried.h"
#include "mesh/spatial/cut_patch.h"
#include "mesh/spatial/geodesic.h"

namespace prismesh::mesh::shape {

namespace {

using spatial::kUnreached;
using spatial::Patch;

tl::unexpected<Error> refuse(std::string message) { return fail("", std::move(message)); }

std::vector<std::uint32_t> marked(const std::vector<std::uint8_t>& marks) {
  std::vector<std::uint32_t> nodes;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i] != 0) nodes.push_back(static_cast<std::uint32_t>(i));
  return nodes;
}

/// Computes the weights of one selection. Nodes are positions in the selection.
class Weighing {
 public:
  Weighing(const Model& model, const NodeSet& selection, const WeightOptions& options)
      : model_(model),
        selection_(selection),
        options_(options),
        patch_(spatial::cut_patch_between(model, selection)),
        free_(model, selection) {
    border_ = patch_.rim;
    if (!options.free_ends)
      for (std::uint32_t i = 0; i < border_.size(); ++i)
        if (free_.touches(i)) border_[i] = 1;
  }

  Result<Weights> run(std::optional<NodeIndex> grab) {
    if (grab)
      grab_ = static_cast<std::uint32_t>(std::lower_bound(selection_.begin(), selection_.end(), *grab) - selection_.begin());
    else
      grab_ = farthest_from_border();
    if (const auto found = find_origin(); !found) return fail(found.error());
    find_distances();
    Weights weights;
    weights.nodes = selection_;
    weights.grab = selection_[grab_];
    std::vector<std::uint8_t> reached(from_origin_.size());
    for (std::size_t i = 0; i < reached.size(); ++i) reached[i] = from_origin_[i] < kUnreached ? 1 : 0;
    const std::vector<double> share = options_.falloff.along ? shares_along(options_.falloff.along->normalized()) : shares_on_surface();
    const bool constant = options_.falloff.profile == Profile::constant;
    weights.weight.reserve(share.size());
    for (std::size_t i = 0; i < share.size(); ++i)
      weights.weight.push_back(reached[i] == 0 && !constant ? 0 : evaluate(options_.falloff, share[i]));
    if (options_.across_welds && !constant) carry_across_welds(model_, patch_, reached, weights.weight);
    weights.unreached = static_cast<std::size_t>(std::count(reached.begin(), reached.end(), 0));
    return weights;
  }

 private:
  /// Distances from the current border. They are kept, since the default grab and the shares often need the same.
  const std::vector<double>& from_border() {
    if (from_border_.empty()) from_border_ = spatial::geodesic_distance(patch_, marked(border_));
    return from_border_;
  }

  /// Computes both in parallel where both are needed: they are independent.
  void find_distances() {
    const bool border_too = !options_.falloff.along && options_.falloff.profile != Profile::constant && from_border_.empty();
    parallel_for(border_too ? 2 : 1, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (i == 0)
          from_origin_ = spatial::geodesic_distance(patch_, origin_);
        else
          from_border_ = spatial::geodesic_distance(patch_, marked(border_));
      }
    });
  }

  std::uint32_t farthest_from_border() {
    const std::vector<double>& distance = from_border();
    double max_distance = -1;
    for (const double d : distance)
      if (d < kUnreached) max_distance = std::max(max_distance, d);
    if (max_distance < 0) return lowest_on_a_shell();
    // distances that differ by rounding only count as equal
    for (std::uint32_t i = 0; i < distance.size(); ++i)
      if (distance[i] < kUnreached && distance[i] >= max_distance * (1 - 1e-9)) return i;
    return 0;
  }

  std::uint32_t lowest_on_a_shell() const {
    for (std::uint32_t i = 0; i < selection_.size(); ++i)
      if (patch_.node_first[i] != patch_.node_first[i + 1]) return i;
    return 0;
  }

  /// Finds origin_ and removes it from the border.
  Result<void> find_origin() {
    std::uint32_t on_edge = grab_;
    bool whole_edge = options_.free_ends && free_.touches(grab_);
    if (options_.origin == Origin::free_edge) {
      whole_edge = true;
      if (!free_.touches(grab_)) {
        const auto nearest = nearest_on_free_edge();
        if (!nearest)
          return refuse("the origin is to be a free edge, but the selection reaches none; select the free edge too or use origin grab");
        on_edge = *nearest;
      }
    }
    origin_ = {grab_};
    if (whole_edge) {
      // without free ends the whole boundary is border, but only the rim ends the free edge
      const bool grab_held = patch_.rim[on_edge] != 0;
      const std::vector<std::uint8_t> nothing(selection_.size(), 0);
      origin_ = free_.through(on_edge, grab_held ? nothing : patch_.rim);
      std::erase_if(origin_, [&](std::uint32_t i) { return !grab_held && patch_.rim[i] != 0; });
    }
    for (const std::uint32_t i : origin_)
      if (border_[i] != 0) {
        border_[i] = 0;
        from_border_.clear();
      }
    return {};
  }

  std::optional<std::uint32_t> nearest_on_free_edge() const {
    const std::vector<double> distance = spatial::geodesic_distance(patch_, std::vector<std::uint32_t>{grab_});
    std::optional<std::uint32_t> nearest;
    for (std::uint32_t i = 0; i < distance.size(); ++i)
      if (free_.touches(i) && distance[i] < kUnreached && (!nearest || distance[i] < distance[*nearest])) nearest = i;
    return nearest;
  }

  /// d_border / (d_origin + d_border) along the surface.
  std::vector<double> shares_on_surface() {
    const std::vector<double>& from_border = this->from_border();
    std::vector<double> share(selection_.size(), 0);
    for (std::size_t i = 0; i < share.size(); ++i) {
      if (from_border[i] == kUnreached)
        share[i] = 1;
      else if (from_border[i] > 0)
        share[i] = from_border[i] / (from_origin_[i] + from_border[i]);
    }
    for (const std::uint32_t i : origin_) share[i] = 1;
    return share;
  }

  /// The same with distances along one direction, from the origin's extent to the border that faces this direction.
  std::vector<double> shares_along(const Vec3& direction) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto place = [&](std::uint32_t i) { return direction.dot(patch_.positions[i]); };
    double origin_low = kInfinity;
    double origin_high = -kInfinity;
    for (const std::uint32_t i : origin_) {
      origin_low = std::min(origin_low, place(i));
      origin_high = std::max(origin_high, place(i));
    }
    double border_low = kInfinity;
    double border_high = -kInfinity;
    for (std::uint32_t i = 0; i < border_.size(); ++i) {
      if (border_[i] == 0 || !patch_.positions[i].allFinite()) continue;
      const double faces = facing(i, direction);
      if (faces <= 0 && place(i) < origin_low) border_low = std::min(border_low, place(i));
      if (faces >= 0 && place(i) > origin_high) border_high = std::max(border_high, place(i));
    }
    std::vector<double> share(selection_.size(), 1);
    for (std::uint32_t i = 0; i < share.size(); ++i) {
      const double at = place(i);
      if (at > origin_high && border_high > origin_high) share[i] = fraction(border_high - at, at - origin_high);
      if (at < origin_low && border_low < origin_low) share[i] = fraction(at - border_low, origin_low - at);
    }
    return share;
  }

  static double fraction(double to_border, double from_origin) { return to_border > 0 ? to_border / (from_origin + to_border) : 0; }

  /// Where the surface continues outside the selection: +1 in the direction, -1 against it, both within 45 degrees; NaN: sideways; 0: at
  /// the part's own boundary, which counts for both.
  double facing(std::uint32_t i, const Vec3& direction) const {
    if (patch_.rim[i] == 0) return 0;
    Vec3 outward = Vec3::Zero();
    for (const ShellIndex shell : model_.adjacency->shells_of(selection_[i])) {
      const ShellNodes& nodes = model_.shell(shell);
      for (int c = 0; c < nodes.corners(); ++c)
        if (!std::binary_search(selection_.begin(), selection_.end(), nodes.node[c]))
          outward += model_.position(nodes.node[c]) - patch_.positions[i];
    }
    const double with = outward.dot(direction);
    if (2 * with * with < outward.squaredNorm()) return std::numeric_limits<double>::quiet_NaN();
    return with < 0 ? -1 : 1;
  }

  const Model& model_;
  const NodeSet& selection_;
  const WeightOptions& options_;
  Patch patch_;
  FreeEdges free_;
  std::vector<std::uint8_t> border_;
  std::uint32_t grab_ = 0;
  std::vector<std::uint32_t> origin_;
  std::vector<double> from_border_;
  std::vector<double> from_origin_;
};

}  // namespace

Result<Weights> compute_weights(const Model& model, const NodeSet& selection, std::optional<NodeIndex> grab, const WeightOptions& options) {
  if (selection.empty()) return refuse("nothing is selected");
  if (grab && !std::binary_search(selection.begin(), selection.end(), *grab)) {
    if (grab->value >= model.node_count()) return refuse("the grabbed node doesn't exist");
    return refuse("the grabbed node:" + std::to_string(model.node_ids[grab->value]) + " isn't selected");
  }
  const Falloff& falloff = options.falloff;
  if (!(falloff.flat >= 0 && falloff.flat <= 1)) return refuse("the falloff's flat share must lie between 0 and 1");
  if (falloff.along) {
    const double length = falloff.along->norm();
    if (!(length > 0 && std::isfinite(length))) return refuse("the falloff's direction \"along\" has no length");
  }
  return Weighing(model, selection, options).run(grab);
}

}  // namespace prismesh::mesh::shape
