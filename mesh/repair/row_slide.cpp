#include "mesh/repair/row_slide.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/quality/criteria.h"
#include "mesh/repair/placement.h"

namespace prismesh::mesh::repair {

namespace {

constexpr int kMaxRungs = 200;
constexpr double kLongEnough = 1.003;  ///< times the min length: the ends do not follow a curved line exactly
constexpr double kMaxLean = 1.0;       ///< tangent of the angle from the perpendicular: beyond it the quads' angles are bad

/// An edge across the row, between the lines; `first` is on the line that the start's next corner is on.
struct Rung {
  LocalNode first, second;
};

double shortest_allowed(const RepairContext& context, LocalShell shell) {
  const auto metric = static_cast<std::size_t>(quality::Metric::min_length);
  return static_cast<double>(context.limits.of(context.patch.shell(shell).part).quad.threshold[metric].warn_low);
}

double rung_length(const Patch& patch, const Rung& rung) { return (patch.position(rung.first) - patch.position(rung.second)).norm(); }

/// The edge `edge` of a quad as a rung.
Rung rung_of(const Corners& corners, int edge) {
  return {corners[static_cast<std::size_t>(edge % 4)], corners[static_cast<std::size_t>((edge + 1) % 4)]};
}
Rung turned(const Rung& rung) { return {rung.second, rung.first}; }

/// Whether a quad's edges beside `edge` are on lines, so that its row lies between them.
bool is_between_lines(const Patch& patch, const Corners& corners, int edge) {
  if (corner_count(corners) != 4) return false;
  for (const int side : {edge + 1, edge + 3}) {
    const Rung along = rung_of(corners, side);
    if (patch.line(along.first, along.second) == nullptr) return false;
  }
  return true;
}

/// The next rung of the row beyond the quad `from` at its edge `out`, and the quad between; nothing: the row ends.
struct Step {
  LocalShell quad;
  int entered = 0;
};
std::optional<Step> next_quad(const Patch& patch, LocalShell from, const Rung& out) {
  if (patch.line(out.first, out.second) != nullptr) return std::nullopt;
  for (const LocalShell shell : patch.shells_at(out.first, out.second)) {
    if (shell == from) continue;
    const Corners& corners = patch.shell(shell).corners;
    for (int edge = 0; edge < 4; ++edge) {
      const Rung own = rung_of(corners, edge);
      if (std::minmax(own.first, own.second) == std::minmax(out.first, out.second) && is_between_lines(patch, corners, edge))
        return Step{shell, edge};
    }
  }
  return std::nullopt;
}

/// The rungs beyond a quad's edge, that edge first, as far as they are short. `first` stays on one line.
std::vector<Rung> rungs_beyond(const Patch& patch, LocalShell start, const Rung& out, double short_length) {
  std::vector<Rung> rungs;
  LocalShell from = start;
  Rung rung = out;
  while (rungs.size() < kMaxRungs && rung_length(patch, rung) < short_length) {
    rungs.push_back(rung);
    const auto step = next_quad(patch, from, rung);
    if (!step || step->quad == start) break;
    const Rung opposite = rung_of(patch.shell(step->quad).corners, step->entered + 2);
    // The far edge runs the other way round the quad.
    const bool same_way = rung_of(patch.shell(step->quad).corners, step->entered).first == rung.first;
    rung = same_way ? turned(opposite) : opposite;
    from = step->quad;
  }
  return rungs;
}

/// All short rungs of the row, in order.
std::vector<Rung> short_rungs(const Patch& patch, const RowSlide& slide, double short_length) {
  const Corners& corners = patch.shell(slide.start).corners;
  const Rung out = rung_of(corners, slide.edge), back = turned(rung_of(corners, slide.edge + 2));
  std::vector<Rung> rungs = rungs_beyond(patch, slide.start, back, short_length);
  std::reverse(rungs.begin(), rungs.end());
  const std::vector<Rung> forward = rungs_beyond(patch, slide.start, out, short_length);
  rungs.insert(rungs.end(), forward.begin(), forward.end());
  return rungs;
}

/// Whether a node may slide along its line.
bool may_slide(const Patch& patch, LocalNode node) {
  const PatchNode& n = patch.node(node);
  return n.is_whole && (n.rules & kStays) == 0 && !n.is_off_surface && n.freedom == relax::Freedom::line && n.lines.size() == 2 &&
         !n.lines[0].is_rim && !n.lines[1].is_rim;
}

/// The direction of the line at a node, toward the side of `way`; zero: it has none.
Vec3 direction_of_line(const Patch& patch, LocalNode node, const Vec3& way) {
  const PatchNode& n = patch.node(node);
  if (n.lines.size() != 2) return Vec3::Zero();
  const Vec3 along = patch.position(n.lines[1].node) - patch.position(n.lines[0].node);
  const double length = along.norm();
  if (!(length > 0)) return Vec3::Zero();
  return along.dot(way) < 0 ? Vec3(-along / length) : Vec3(along / length);
}

/// Moves a node by `distance` along its line, at most 0.4 of the way to the next node.
void slide_node(const RepairContext& context, LocalNode node, const Vec3& way, double distance) {
  Patch& patch = context.patch;
  const Vec3 at = patch.position(node), direction = direction_of_line(patch, node, way);
  if (direction.isZero() || distance == 0) return;
  double room = 0;
  for (const LineEnd& end : patch.node(node).lines)
    if ((patch.position(end.node) - at).dot(direction) * distance > 0) room = std::max(room, 0.4 * (patch.position(end.node) - at).norm());
  const Vec3 wanted = at + std::clamp(distance, -room, room) * direction;
  const auto place = context.surface.project_on_line(wanted, std::abs(distance));
  if (place && place->allFinite() && within_limit(context, node, *place)) patch.move(node, *place);
}

}  // namespace

std::vector<RowSlide> row_slides(const RepairContext& context, LocalShell shell) {
  std::vector<RowSlide> found;
  const Corners& corners = context.patch.shell(shell).corners;
  const double shortest = shortest_allowed(context, shell);
  if (corner_count(corners) != 4 || !std::isfinite(shortest)) return found;
  for (int edge = 0; edge < 2; ++edge) {
    const double length =
        std::min(rung_length(context.patch, rung_of(corners, edge)), rung_length(context.patch, rung_of(corners, edge + 2)));
    if (length >= shortest || !is_between_lines(context.patch, corners, edge)) continue;
    for (const Lean lean : {Lean::forward, Lean::back, Lean::forward_and_back, Lean::back_and_forward})
      found.push_back({shell, edge, lean});
  }
  return found;
}

Refusal slide_row(const RepairContext& context, const RowSlide& slide) {
  const Patch& patch = context.patch;
  const double wanted = kLongEnough * shortest_allowed(context, slide.start);
  const std::vector<Rung> rungs = short_rungs(patch, slide, wanted);
  const Corners corners = patch.shell(slide.start).corners;
  const Rung out = rung_of(corners, slide.edge), back = rung_of(corners, slide.edge + 2);
  Vec3 way = patch.position(out.first) + patch.position(out.second) - patch.position(back.first) - patch.position(back.second);
  bool moved = false;
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    const auto& [first, second] = rungs[i];
    const Vec3 tangent = direction_of_line(patch, first, way);
    if (tangent.isZero()) continue;
    way = tangent;  // the lines may turn
    const Vec3 across = patch.position(first) - patch.position(second);
    const double lean_now = across.dot(tangent);
    const double width = (across - lean_now * tangent).norm();
    const double lean = std::min(std::sqrt(std::max(0.0, wanted * wanted - width * width)), kMaxLean * width);
    const bool odd = i % 2 != 0;
    const bool forward = slide.lean == Lean::forward || slide.lean == (odd ? Lean::back_and_forward : Lean::forward_and_back);
    const double change = (forward ? lean : -lean) - lean_now;
    const bool first_slides = may_slide(patch, first), second_slides = may_slide(patch, second);
    if (!first_slides && !second_slides) continue;
    const double share = first_slides && second_slides ? 0.5 : 1.0;
    if (first_slides) slide_node(context, first, tangent, share * change);
    if (second_slides) slide_node(context, second, tangent, -share * change);
    moved = true;
  }
  if (!moved) return "the row's nodes can't slide along their lines";
  return std::nullopt;
}

}  // namespace prismesh::mesh::repair
