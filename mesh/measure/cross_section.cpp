#include "mesh/measure/cross_section.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>

#include "base/parallel_for.h"

namespace prismesh::mesh::measure {

namespace {

constexpr std::size_t kNodesOfRange = 8192;
constexpr std::size_t kShellsOfRange = 8192;
constexpr std::uint32_t kNone = 0xffffffffU;

/// An end of a piece: the edge or diagonal that the plane goes through, from its lower node to its higher one.
struct End {
  std::uint32_t low = 0, high = 0;
  bool operator==(const End&) const = default;
  auto operator<=>(const End&) const = default;  // NOLINT(modernize-use-nullptr): the check mistakes the operator
};

/// The cut of a triangle.
struct Piece {
  std::uint32_t shell = 0;
  PartIndex part;
  std::array<End, 2> end;
};

class Cut {
 public:
  Cut(const Model& model, const Vec3& point, const Vec3& unit) : model_(model), point_(point), unit_(unit), height_(model.node_count()) {
    parallel_for(height_.size(), kNodesOfRange, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) height_[n] = (model.positions[n] - point_).dot(unit_);
    });
  }

  std::vector<Piece> pieces(OutOfSight out_of_sight) const {
    const std::size_t count = model_.shell_count();
    std::vector<std::vector<Piece>> of_range((count + kShellsOfRange - 1) / kShellsOfRange);
    parallel_for(count, kShellsOfRange, [&](std::size_t begin, std::size_t end) {
      // A range may span several multiples of the grain.
      std::vector<Piece>& found = of_range[begin / kShellsOfRange];
      for (std::size_t s = begin; s < end; ++s) {
        const ShellNodes& nodes = model_.shell_nodes[s];
        if (!nodes.node[0].valid() || !is_crossed(nodes) || !in_sight(model_, ShellIndex(s), out_of_sight)) continue;
        cut_triangle(s, {nodes.node[0], nodes.node[1], nodes.node[2]}, found);
        if (!nodes.is_triangle()) cut_triangle(s, {nodes.node[0], nodes.node[2], nodes.node[3]}, found);
      }
    });
    std::vector<Piece> all;
    for (const std::vector<Piece>& each : of_range) all.insert(all.end(), each.begin(), each.end());
    return all;
  }

  Vec3 place(const End& end) const {
    const double low = height_[end.low], high = height_[end.high];
    const Vec3 &a = model_.positions[end.low], &b = model_.positions[end.high];
    return a + (low / (low - high)) * (b - a);
  }

 private:
  bool is_above(NodeIndex node) const { return height_[node.value] >= 0; }
  bool is_crossed(const ShellNodes& nodes) const {
    const bool first = is_above(nodes.node[0]);
    return is_above(nodes.node[1]) != first || is_above(nodes.node[2]) != first || is_above(nodes.node[3]) != first;
  }
  bool is_finite(NodeIndex node) const { return model_.position(node).allFinite(); }

  void cut_triangle(std::size_t shell, const std::array<NodeIndex, 3>& corner, std::vector<Piece>& found) const {
    const std::array<bool, 3> above{is_above(corner[0]), is_above(corner[1]), is_above(corner[2])};
    if (above[0] == above[1] && above[1] == above[2]) return;
    if (!is_finite(corner[0]) || !is_finite(corner[1]) || !is_finite(corner[2])) return;
    Piece piece{static_cast<std::uint32_t>(shell), model_.shell_parts[shell], {}};
    std::size_t ends = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const NodeIndex a = corner[i], b = corner[(i + 1) % 3];
      if (above[i] == above[(i + 1) % 3]) continue;
      piece.end[ends] = {std::min(a.value, b.value), std::max(a.value, b.value)};
      if (!place(piece.end[ends]).allFinite()) return;
      ++ends;
    }
    if (ends == 2) found.push_back(piece);
  }

  const Model& model_;
  Vec3 point_, unit_;
  std::vector<double> height_;  ///< of each node above the plane
};

/// For each end of each piece the end that it goes on to, at 2 * piece + end; kNone: the curve ends there.
std::vector<std::uint32_t> links_of(const std::vector<Piece>& pieces) {
  std::vector<std::uint32_t> order(2 * pieces.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  const auto key = [&](std::uint32_t at) {
    const Piece& piece = pieces[at / 2];
    return std::make_tuple(piece.part.value, piece.end[at % 2]);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
  std::vector<std::uint32_t> link(order.size(), kNone);
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && key(order[end]) == key(order[begin])) ++end;
    if (end - begin != 2) continue;
    link[order[begin]] = order[begin + 1];
    link[order[begin + 1]] = order[begin];
  }
  return link;
}

/// The ends in the order of a curve that begins at this one: of each piece where the curve comes in, then the last one's other end.
std::vector<std::uint32_t> follow(const std::vector<std::uint32_t>& link, std::uint32_t first, std::vector<std::uint8_t>& done) {
  std::vector<std::uint32_t> ends{first};
  for (std::uint32_t in = first;;) {
    done[in / 2] = 1;
    const std::uint32_t out = in ^ 1U;
    in = link[out];
    if (in == kNone) {
      ends.push_back(out);
      return ends;
    }
    if (in == first) return ends;
    ends.push_back(in);
  }
}

}  // namespace

Result<CrossSection> cross_section(const Model& model, const Plane& plane, OutOfSight out_of_sight) {
  if (!plane.point.allFinite() || !plane.normal.allFinite()) return fail("", "the plane has a number that isn't finite");
  const double largest = plane.normal.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return fail("", "the plane's normal has no length");
  const Cut cut(model, plane.point, (plane.normal / largest).normalized());
  const std::vector<Piece> pieces = cut.pieces(out_of_sight);
  const std::vector<std::uint32_t> link = links_of(pieces);

  CrossSection section;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    if (p == 0 || pieces[p].shell != pieces[p - 1].shell) ++section.shells;

  std::vector<std::uint8_t> done(pieces.size(), 0);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (done[p] != 0) continue;
    // Back to the curve's beginning, or once around.
    auto first = static_cast<std::uint32_t>(2 * p);
    bool closed = false;
    while (link[first] != kNone && !closed) {
      first = link[first] ^ 1U;
      closed = first / 2 == p;
    }
    if (closed) first = static_cast<std::uint32_t>(2 * p);
    SectionCurve curve{pieces[p].part, closed, {}, 0};
    for (const std::uint32_t end : follow(link, first, done)) {
      const Vec3 place = cut.place(pieces[end / 2].end[end % 2]);
      if (!curve.points.empty() && curve.points.back() == place) continue;
      if (!curve.points.empty()) curve.length += (place - curve.points.back()).norm();
      curve.points.push_back(place);
    }
    if (closed) {
      if (curve.points.size() > 1 && curve.points.front() == curve.points.back()) curve.points.pop_back();
      curve.length += (curve.points.front() - curve.points.back()).norm();
    }
    if (curve.points.size() < 2) continue;  // the sheet only touches the plane
    section.length += curve.length;
    section.curves.push_back(std::move(curve));
  }
  return section;
}

}  // namespace prismesh::mesh::measure
