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
#include "mesh/shape/free_ending.h"
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

constexpr double kAsFar = 0.98;  ///< share of a distance that counts as the same: above the error of distances

/// Computes the weights of one selection. Nodes are positions in the selection.
class Weighing {
 public:
  Weighing(const Model& model, const NodeSet& selection, const WeightOptions& options, const WeightPlaces& places)
      : model_(model),
        selection_(selection),
        options_(options),
        places_(places),
        patch_(spatial::cut_patch_between(model, selection)),
        free_(model, selection) {
    border_ = patch_.rim;
    if (options.free_ends == FreeEnds::held)
      for (std::uint32_t i = 0; i < border_.size(); ++i)
        if (free_.touches(i)) border_[i] = 1;
  }

  Result<Weights> run(std::optional<NodeIndex> grab) {
    grab_ = grab ? place_of(*grab) : farthest_from_border();
    whole_.assign(selection_.size(), 0);
    Weights weights;
    if (const auto found = find_origin(weights); !found) return fail(found.error());
    if (options_.free_ends == FreeEnds::rigid && options_.falloff.profile != Profile::constant) find_free_endings();
    find_distances();
    weights.nodes = selection_;
    weights.grab = selection_[grab_];
    for (std::uint32_t i = 0; i < whole_.size(); ++i)
      if (whole_[i] != 0 && !std::binary_search(origin_.begin(), origin_.end(), i)) ++weights.free_ending;
    std::vector<std::uint8_t> reached(from_origin_.size());
    for (std::size_t i = 0; i < reached.size(); ++i) reached[i] = from_origin_[i] < kUnreached ? 1 : 0;
    const std::vector<double> share = options_.falloff.along ? shares_along(options_.falloff.along->normalized()) : shares_on_surface();
    const bool constant = options_.falloff.profile == Profile::constant;
    weights.weight.reserve(share.size());
    for (std::size_t i = 0; i < share.size(); ++i)
      weights.weight.push_back(reached[i] == 0 && !constant ? 0 : evaluate(options_.falloff, share[i]));
    if (options_.across_welds && !constant && places_.joined != nullptr)
      carry_across_welds(model_, patch_, *places_.joined, reached, weights.weight);
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
          from_origin_ = distances_from_origin();
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

  std::uint32_t place_of(NodeIndex node) const {
    return static_cast<std::uint32_t>(std::lower_bound(selection_.begin(), selection_.end(), node) - selection_.begin());
  }

  /// Finds origin_ and removes it from the border. Tells in `told` on which free edge it is.
  Result<void> find_origin(Weights& told) {
    std::optional<std::uint32_t> edge, weighted_edge;  // a node on it, with these free ends and with weighted ones
    if (options_.origin == Origin::free_edge) {
      const std::uint32_t asked = places_.edge ? place_of(*places_.edge) : grab_;
      edge = weighted_edge = free_.touches(asked) ? asked : nearest_on_free_edge(asked);
      if (!edge)
        return refuse("the origin is to be a free edge, but the selection reaches none; select the free edge too or use origin grab");
      if (options_.free_ends == FreeEnds::rigid && !places_.edge && !free_.touches(grab_)) edge = free_edge_beyond_grab().value_or(*edge);
    } else if (options_.free_ends != FreeEnds::held && free_.touches(grab_)) {
      weighted_edge = grab_;
      if (options_.free_ends == FreeEnds::weighted || !is_side(grab_)) edge = grab_;
    }
    if (edge)
      origin_ = edge_through(*edge);
    else
      origin_ = weighted_edge ? side_beyond_grab() : std::vector<std::uint32_t>{grab_};
    if (edge) told.edge = selection_[*edge];
    if (weighted_edge && edge_through(*weighted_edge) != origin_) told.other_edge = selection_[*weighted_edge];
    for (const std::uint32_t i : origin_)
      if (border_[i] != 0) {
        border_[i] = 0;
        from_border_.clear();
      }
    return {};
  }

  /// The nodes of the free edge through a node, without those on the border.
  std::vector<std::uint32_t> edge_through(std::uint32_t node) const {
    // with free ends held the whole boundary is border, but only the rim ends the free edge
    const bool node_held = patch_.rim[node] != 0;
    const std::vector<std::uint8_t> nothing(selection_.size(), 0);
    std::vector<std::uint32_t> edge = free_.through(node, node_held ? nothing : patch_.rim);
    std::erase_if(edge, [&](std::uint32_t i) { return !node_held && patch_.rim[i] != 0; });
    return edge;
  }

  /// Whether one end of the free edge at a node is on the rim: the side of a strip, not its end and not the edge of a recess.
  bool is_side(std::uint32_t node) const { return patch_.rim[node] == 0 && free_.count_held_lines(node, patch_.rim) == 1; }

  /// The nodes of the side through the grab that are as far from the border as the grab.
  std::vector<std::uint32_t> side_beyond_grab() {
    const double distance = from_border()[grab_];
    std::vector<std::uint32_t> side = edge_through(grab_);
    std::erase_if(side, [&](std::uint32_t i) { return i != grab_ && !(from_border()[i] >= kAsFar * distance); });
    beyond_from_ = grab_;
    return side;
  }

  std::optional<std::uint32_t> nearest_on_free_edge(std::uint32_t from) const {
    const std::vector<double> distance = spatial::geodesic_distance(patch_, std::vector<std::uint32_t>{from});
    std::optional<std::uint32_t> nearest;
    for (std::uint32_t i = 0; i < distance.size(); ++i)
      if (free_.touches(i) && distance[i] < kUnreached && (!nearest || distance[i] < distance[*nearest])) nearest = i;
    return nearest;
  }

  /// The node nearest to the grab on a free edge that is the end of something: on one that lies beyond the grab as a whole; without such an
  /// edge on one that is no hole and doesn't end on the rim.
  std::optional<std::uint32_t> free_edge_beyond_grab() {
    const std::vector<double> distance = spatial::geodesic_distance(patch_, std::vector<std::uint32_t>{grab_});
    const std::vector<std::uint8_t> holes = free_.on_holes(patch_.rim);
    std::vector<std::uint32_t> candidates;
    for (std::uint32_t i = 0; i < distance.size(); ++i)
      if (free_.touches(i) && distance[i] < kUnreached && holes[i] == 0 && patch_.rim[i] == 0) candidates.push_back(i);
    std::stable_sort(candidates.begin(), candidates.end(), [&](std::uint32_t a, std::uint32_t b) { return distance[a] < distance[b]; });
    origin_ = {grab_};
    const std::vector<std::uint8_t> beyond = beyond_origin();
    std::vector<std::uint8_t> seen(distance.size(), 0);
    std::optional<std::uint32_t> nearest;
    for (const std::uint32_t node : candidates) {
      if (seen[node] != 0) continue;
      const std::vector<std::uint32_t> edge = edge_through(node);
      if (std::all_of(edge.begin(), edge.end(), [&](std::uint32_t i) { return beyond[i] != 0; })) return node;
      if (!nearest && free_.count_held_lines(node, patch_.rim) == 0) nearest = node;
      // a corner is on another edge too
      for (const std::uint32_t i : edge)
        if (!is_boundary_corner(model_, selection_[i])) seen[i] = 1;
    }
    return nearest;
  }

  /// Marks in whole_ the nodes of free endings, and finds the distances of the nodes before them.
  void find_free_endings() {
    if (!free_.any() || !(from_border()[grab_] < kUnreached)) return;
    bool grab_before_axis = true;
    if (places_.axis) {
      const std::vector<std::uint8_t> connected = connected_to(patch_, grab_);
      if (const std::optional<CutLine> line = cut_at_axis(patch_, from_border(), connected, *places_.axis)) {
        whole_ = shape::find_free_endings(patch_, free_, connected, border_, *line);
        before_ = distances_before(patch_, *line, whole_);
        grab_before_axis = line->before(grab_) || std::count(whole_.begin(), whole_.end(), 0) == std::ssize(whole_);
      }
    }
    // in one direction only, weights end where no border faces it
    if (grab_before_axis && !options_.falloff.along) add_beyond_origin();
  }

  void add_beyond_origin() {
    const std::vector<std::uint8_t> beyond = beyond_origin(&before_);
    for (std::size_t i = 0; i < beyond.size(); ++i) whole_[i] = whole_[i] | beyond[i];
  }

  /// Marks the free endings beyond the line at the origin's distance from the border; adds the distances of the nodes before it.
  std::vector<std::uint8_t> beyond_origin(std::vector<std::pair<std::uint32_t, double>>* before = nullptr) {
    const std::vector<double>& distance = from_border();
    const std::vector<std::uint8_t> none(distance.size(), 0);
    if (patch_.rim[grab_] != 0) return none;
    const auto nearer = [&](std::uint32_t a, std::uint32_t b) { return distance[a] < distance[b]; };
    const auto [nearest, farthest] = std::minmax_element(origin_.begin(), origin_.end(), nearer);
    // beyond a hole begins at its near side, beyond another edge where it ends
    const std::uint32_t of_edge = free_.on_holes(patch_.rim)[origin_.front()] != 0 ? *nearest : *farthest;
    const double at = distance[beyond_from_.value_or(of_edge)];
    if (!(at > 0 && at < kUnreached)) return none;
    const CutLine line = cut_at_distance(patch_, distance, at, origin_);
    std::vector<std::uint8_t> beyond = shape::find_free_endings(patch_, free_, connected_to(patch_, grab_), border_, line);
    if (before != nullptr) {
      const auto found = distances_before(patch_, line, beyond);
      before->insert(before->end(), found.begin(), found.end());
    }
    return beyond;
  }

  /// From the origin and the free endings. The nodes just before these have their own distances: the cut runs between the nodes.
  std::vector<double> distances_from_origin() const {
    std::vector<std::uint32_t> sources = origin_;
    for (std::uint32_t i = 0; i < whole_.size(); ++i)
      if (whole_[i] != 0 && !std::binary_search(origin_.begin(), origin_.end(), i)) sources.push_back(i);
    std::vector<double> start(sources.size(), 0);
    std::vector<std::pair<std::uint32_t, double>> before = before_;
    std::sort(before.begin(), before.end());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const std::uint32_t node = before[i].first;
      if ((i > 0 && before[i - 1].first == node) || whole_[node] != 0 || std::binary_search(origin_.begin(), origin_.end(), node)) continue;
      sources.push_back(node);
      start.push_back(before[i].second);
    }
    return spatial::geodesic_distance_from(patch_, sources, start);
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
    put_whole(share);
    return share;
  }

  void put_whole(std::vector<double>& share) const {
    for (const std::uint32_t i : origin_) share[i] = 1;
    for (std::size_t i = 0; i < whole_.size(); ++i)
      if (whole_[i] != 0) share[i] = 1;
  }

  /// The same with distances along one direction, from the origin's extent to the border that faces this direction.
  std::vector<double> shares_along(const Vec3& direction) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto place = [&](std::uint32_t i) { return direction.dot(patch_.positions[i]); };
    double origin_low = kInfinity;
    double origin_high = -kInfinity;
    for (std::uint32_t i = 0; i < whole_.size(); ++i) {
      if (whole_[i] == 0 && !std::binary_search(origin_.begin(), origin_.end(), i)) continue;
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
    put_whole(share);
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
  const WeightPlaces& places_;
  Patch patch_;
  FreeEdges free_;
  std::vector<std::uint8_t> border_;
  std::uint32_t grab_ = 0;
  std::vector<std::uint32_t> origin_;                     ///< ascending
  std::optional<std::uint32_t> beyond_from_;              ///< the node at whose distance beyond the origin begins; without: see there
  std::vector<std::uint8_t> whole_;                       ///< of each node: 1 in a free ending
  std::vector<std::pair<std::uint32_t, double>> before_;  ///< nodes just before a free ending, and their distances from it
  std::vector<double> from_border_;
  std::vector<double> from_origin_;
};

}  // namespace

Result<Weights> compute_weights(const Model& model, const NodeSet& selection, std::optional<NodeIndex> grab, const WeightOptions& options,
                                const WeightPlaces& places) {
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
  if (places.edge && !std::binary_search(selection.begin(), selection.end(), *places.edge))
    return refuse("the node of the free edge isn't selected");
  return Weighing(model, selection, options, places).run(grab);
}

}  // namespace prismesh::mesh::shape
