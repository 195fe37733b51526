#include "mesh/repair/candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "mesh/repair/collapse.h"
#include "mesh/repair/divide.h"
#include "mesh/repair/local_size.h"
#include "mesh/repair/node_moves.h"
#include "mesh/repair/patch_geometry.h"
#include "mesh/repair/redivide.h"
#include "mesh/repair/row_slide.h"
#include "mesh/repair/strips.h"

namespace prismesh::mesh::repair {

namespace {

struct EdgeOf {
  LocalNode a, b;
};

EdgeOf edge_of(const Corners& corners, int edge) {
  const int count = corner_count(corners);
  return {corners[static_cast<std::size_t>(edge % count)], corners[static_cast<std::size_t>((edge + 1) % count)]};
}

// Difference of cosines of two bends that counts as none.
constexpr double kBendNoise = 1e-9;
// Target sizes: a longer edge is worth dividing.
constexpr double kLong = 1.25;
// Target sizes: a narrower strip may be removed.
constexpr double kShort = 0.6;

double length_of(const Patch& patch, const EdgeOf& edge) { return (patch.position(edge.a) - patch.position(edge.b)).norm(); }

/// The mean length of a quad's edge and the opposite one.
double width_of(const Patch& patch, const Corners& corners, int edge) {
  return 0.5 * (length_of(patch, edge_of(corners, edge)) + length_of(patch, edge_of(corners, edge + 2)));
}

void add_redivisions(const RepairContext& context, LocalShell shell, std::vector<Candidate>& found) {
  const Patch& patch = context.patch;
  const Corners& corners = patch.shell(shell).corners;
  for (int e = 0; e < corner_count(corners); ++e) {
    const EdgeOf edge = edge_of(corners, e);
    if (patch.line(edge.a, edge.b) != nullptr) continue;
    for (const LocalShell other : patch.shells_at(edge.a, edge.b)) {
      if (other == shell) continue;
      const Loop loop = loop_of(patch, shell, other);
      for (std::vector<Loop>& pieces : divisions(loop, 2)) {
        const Operation operation = pieces.size() == 1 ? Operation::merge : Operation::swap;
        found.push_back(
            {operation, [&context, shell, other, pieces = std::move(pieces)] { return redivide(context, shell, other, pieces); }});
      }
    }
  }
}

void add_collapse(const RepairContext& context, LocalNode a, LocalNode b, std::vector<Candidate>& found) {
  if (const auto pair = collapse_of(context, a, b))
    found.push_back({Operation::collapse, [&context, pair = *pair] { return collapse_nodes(context, {pair}); }});
}

void add_collapses(const RepairContext& context, LocalShell shell, std::vector<Candidate>& found) {
  const Corners corners = context.patch.shell(shell).corners;
  const int count = corner_count(corners);
  double shortest = 1e300, longest = 0;
  for (int e = 0; e < count; ++e) {
    shortest = std::min(shortest, length_of(context.patch, edge_of(corners, e)));
    longest = std::max(longest, length_of(context.patch, edge_of(corners, e)));
  }
  for (int e = 0; e < count; ++e) {
    const EdgeOf edge = edge_of(corners, e);
    // Only short edges: collapsing others makes long shells nearby.
    if (length_of(context.patch, edge) <= std::max(1.5 * shortest, 0.5 * target_size_of(context, shell)))
      add_collapse(context, edge.a, edge.b, found);
  }
  if (count != 4) return;
  for (std::size_t i = 0; i < 2; ++i)
    if (length_of(context.patch, {corners[i], corners[i + 2]}) < 0.9 * longest) add_collapse(context, corners[i], corners[i + 2], found);
}

/// The number of quads after a row's end that are worth dividing with it: bad ones, and those with a long edge across.
int run_of(const Patch& patch, const Row& start, bool is_forward, double long_edge) {
  constexpr int kMax = 12;
  Row row = start;
  int& length = is_forward ? row.forward : row.back;
  LocalShell at = start.start;
  int edge = is_forward ? (start.edge + 2) % 4 : start.edge;
  for (int run = 0; run < kMax; ++run) {
    const EdgeOf out = edge_of(patch.shell(at).corners, edge);
    const std::vector<LocalShell> shells = patch.shells_at(out.a, out.b);
    if (shells.size() != 2) return run;
    const LocalShell next = shells[0] == at ? shells[1] : shells[0];
    const PatchShell& shell = patch.shell(next);
    if (corner_count(shell.corners) != 4) return run;
    int entered = 0;
    for (int e = 0; e < 4; ++e) {
      const EdgeOf theirs = edge_of(shell.corners, e);
      if (theirs.a == std::max(out.a, out.b) || theirs.b == std::max(out.a, out.b))
        if (theirs.a == std::min(out.a, out.b) || theirs.b == std::min(out.a, out.b)) entered = e;
    }
    const double beyond = length_of(patch, edge_of(shell.corners, entered + 2));
    if (shell.state.grade() == quality::Grade::ok && beyond < long_edge) return run;
    length = run + 1;
    at = next;
    edge = (entered + 2) % 4;
  }
  return kMax;
}

void add_row(const RepairContext& context, const Row& row, std::vector<Candidate>& found) {
  const auto ends = ends_of(context.patch, row);
  if (!ends) return;
  const auto ways = [](int corners) -> std::vector<RowEnd> {
    if (corners == 4) return {RowEnd::low_triangle, RowEnd::high_triangle};
    if (corners == 3) return {RowEnd::absorb, RowEnd::two_triangles};
    return {RowEnd::low_triangle};
  };
  for (const RowEnd forward : ways(ends->forward_corners))
    for (const RowEnd back : ways(ends->back_corners)) {
      Row way = row;
      way.forward_end = forward;
      way.back_end = back;
      found.push_back({Operation::split, [&context, way] { return divide_row(context, way); }});
    }
}

void add_rows(const RepairContext& context, LocalShell shell, std::vector<Candidate>& found) {
  const Patch& patch = context.patch;
  const Corners& corners = patch.shell(shell).corners;
  if (corner_count(corners) != 4) return;
  const double size = target_size_of(context, shell);
  for (int direction = 0; direction < 2; ++direction) {
    const double across = width_of(patch, corners, direction);
    // Halves of a short shell would be too short.
    if (across < 0.6 * size) continue;
    Row row{shell, direction};
    const double long_edge = std::max(kLong * size, 0.8 * across);
    const int forward = run_of(patch, row, true, long_edge), back = run_of(patch, row, false, long_edge);
    std::vector<std::pair<int, int>> lengths_tried = {
        {forward, back}, {forward + 1, back + 1}, {forward + 1, back}, {forward, back + 1}, {0, 0}};
    if (forward + back == 0) lengths_tried.pop_back();
    for (const auto& [f, b] : lengths_tried) {
      row.forward = f;
      row.back = b;
      add_row(context, row, found);
    }
  }
}

/// Rows from a triangle over quads to another triangle: both triangles become quads.
void add_rows_between_triangles(const RepairContext& context, LocalShell shell, std::vector<Candidate>& found) {
  constexpr int kMaxForward = 8;
  const Patch& patch = context.patch;
  const Corners corners = patch.shell(shell).corners;
  if (corner_count(corners) != 3) return;
  for (int e = 0; e < 3; ++e) {
    const EdgeOf edge = edge_of(corners, e);
    for (const LocalShell next : patch.shells_at(edge.a, edge.b)) {
      const Corners& theirs = patch.shell(next).corners;
      if (next == shell || corner_count(theirs) != 4) continue;
      Row row{next};
      for (int i = 0; i < 4; ++i)
        if (const EdgeOf entry = edge_of(theirs, i); std::minmax(entry.a, entry.b) == std::minmax(edge.a, edge.b)) row.edge = i;
      for (row.forward = 0; row.forward < kMaxForward; ++row.forward) {
        const auto ends = ends_of(patch, row);
        if (!ends) break;
        if (ends->forward_corners == 4) continue;
        row.forward_end = row.back_end = RowEnd::absorb;
        found.push_back({Operation::split, [&context, row] { return divide_row(context, row); }});
        break;
      }
    }
  }
}

/// Divides long edges between the shell and one with another number of corners, and both shells there. The triangle becomes a quad, or two
/// triangles; the quad a quad and a triangle.
void add_edges_between_triangle_and_quad(const RepairContext& context, LocalShell shell, std::vector<Candidate>& found) {
  const Patch& patch = context.patch;
  const Corners& corners = patch.shell(shell).corners;
  const double size = target_size_of(context, shell);
  for (int e = 0; e < corner_count(corners); ++e) {
    const EdgeOf edge = edge_of(corners, e);
    const std::vector<LocalShell> shells = patch.shells_at(edge.a, edge.b);
    if (shells.size() != 2 || length_of(patch, edge) < kLong * size) continue;
    const bool starts_with_triangle = corner_count(patch.shell(shells[0]).corners) == 3;
    if (starts_with_triangle == (corner_count(patch.shell(shells[1]).corners) == 3)) continue;
    for (const RowEnd triangle : {RowEnd::absorb, RowEnd::two_triangles})
      for (const RowEnd quad : {RowEnd::low_triangle, RowEnd::high_triangle}) {
        const RowEnd first = starts_with_triangle ? triangle : quad, second = starts_with_triangle ? quad : triangle;
        found.push_back(
            {Operation::split, [&context, edge, first, second] { return divide_edge(context, edge.a, edge.b, first, second); }});
      }
  }
}

}  // namespace

std::vector<Candidate> candidates_for(const RepairContext& context, LocalShell shell) {
  std::vector<Candidate> found;
  const Patch& patch = context.patch;
  const Corners corners = patch.shell(shell).corners;
  const int count = corner_count(corners);
  add_collapses(context, shell, found);
  add_redivisions(context, shell, found);
  add_rows(context, shell, found);
  add_rows_between_triangles(context, shell, found);
  add_edges_between_triangle_and_quad(context, shell, found);
  for (const RowSlide& slide : row_slides(context, shell))
    found.push_back({Operation::move, [&context, slide] { return slide_row(context, slide); }});
  found.push_back({std::nullopt, [&context, shell] { return mark_neighbourhood_changed(context, shell); }});
  for (int e = 0; e < count; ++e) {
    const LocalNode node = corners[static_cast<std::size_t>(e)];
    if (patch.node(node).lines.empty()) found.push_back({Operation::split, [&context, node] { return divide_about(context, node); }});
  }
  if (count == 4) {
    const double max_off = context.options.max_off_surface * target_size_of(context, shell);
    const auto warped = 1U << static_cast<unsigned>(quality::Metric::warpage);
    if ((patch.shell(shell).state.warn & warped) != 0)
      for (std::size_t c = 0; c < 4; ++c)
        for (const double distance : {max_off, -max_off})
          found.push_back({Operation::move, [&context, node = corners[c], distance] { return lift_node(context, node, distance); }});
    for (Candidate& split : splits_of(context, shell)) found.push_back(std::move(split));
  }
  return found;
}

std::vector<Candidate> splits_of(const RepairContext& context, LocalShell shell) {
  std::vector<Candidate> found;
  const Corners corners = context.patch.shell(shell).corners;
  if (corner_count(corners) != 4) return found;
  // The cosine of the angle between the halves' normals.
  const auto halves_agree = [&](std::size_t first) {
    const Vec3 one = area_normal(context.patch, triangle(corners[first], corners[first + 1], corners[first + 2]));
    const Vec3 other = area_normal(context.patch, triangle(corners[first], corners[first + 2], corners[(first + 3) % 4]));
    const double size = std::sqrt(one.squaredNorm() * other.squaredNorm());
    return size > 0 ? one.dot(other) / size : 1.0;
  };
  const int thicker = halves_agree(1) < halves_agree(0) - kBendNoise ? 1 : 0;
  for (const int first : {thicker, 1 - thicker})
    found.push_back({Operation::split, [&context, shell, first] { return split_quad(context, shell, first); }});
  return found;
}

std::vector<Candidate> single_operations_at(const RepairContext& context, LocalShell shell) {
  std::vector<Candidate> found = splits_of(context, shell);
  const Patch& patch = context.patch;
  const Corners corners = patch.shell(shell).corners;
  add_redivisions(context, shell, found);
  for (int e = 0; e < corner_count(corners); ++e) {
    const EdgeOf edge = edge_of(corners, e);
    add_collapse(context, edge.a, edge.b, found);
    if (patch.shells_at(edge.a, edge.b).size() != 2) continue;
    for (const RowEnd first : {RowEnd::low_triangle, RowEnd::high_triangle})
      for (const RowEnd second : {RowEnd::low_triangle, RowEnd::high_triangle})
        found.push_back(
            {Operation::split, [&context, edge, first, second] { return divide_edge(context, edge.a, edge.b, first, second); }});
  }
  return found;
}

std::vector<StripCandidates> strips_for(const RepairContext& context, LocalShell shell, int edge) {
  std::vector<StripCandidates> found;
  const Corners& corners = context.patch.shell(shell).corners;
  if (corner_count(corners) != 4) return found;
  const double width = width_of(context.patch, corners, edge), size = target_size_of(context, shell);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::vector<StripPath> courses;
  // Different length limits may give the same strip: each is tried once.
  const auto is_another = [&](const Strip& strip) {
    StripPath course = path_of(context.patch, strip);
    if (course.quads.empty() || std::find(courses.begin(), courses.end(), course) != courses.end()) return false;
    courses.push_back(std::move(course));
    return true;
  };
  for (const double max_length : {kInfinite, 0.75 * size, kShort * size}) {
    const Strip strip{shell, edge, 0, max_length};
    if (width > kShort * size || !is_another(strip)) continue;
    found.push_back(
        {Operation::collapse, courses.back().quads, {{Operation::collapse, [&context, strip] { return collapse_strip(context, strip); }}}});
  }
  if (width < kLong * size) return found;
  std::set<int> pieces = {2};
  for (int count = static_cast<int>(std::lround(width / size)); count > 2; count = count > 3 ? 3 : 2) pieces.insert(count);
  for (const double min_length : {0.0, size, kLong * size}) {
    const Strip strip{shell, edge, min_length, kInfinite};
    if (!is_another(strip)) continue;
    StripCandidates divided{Operation::split, courses.back().quads, {}};
    for (const int count : pieces)
      for (const bool absorbs : {true, false}) {
        if (!absorbs && (count > 2 || !courses.back().ends_in_triangle)) continue;
        divided.candidates.push_back(
            {Operation::split, [&context, strip, count, absorbs] { return divide_strip(context, strip, count, absorbs); }});
      }
    found.push_back(std::move(divided));
  }
  return found;
}

std::vector<Candidate> tidying_for(const RepairContext& context, LocalShell shell) {
  std::vector<Candidate> found;
  const Corners corners = context.patch.shell(shell).corners;
  bool is_paired = false;
  for (std::size_t i = 0; i < 3; ++i)
    for (const LocalShell other : context.patch.shells_at(corners[i], corners[(i + 1) % 3]))
      is_paired = is_paired || (other != shell && corner_count(context.patch.shell(other).corners) == 3);
  if (is_paired) add_redivisions(context, shell, found);
  add_rows_between_triangles(context, shell, found);
  return found;
}

}  // namespace prismesh::mesh::repair
