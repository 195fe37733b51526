#include "mesh/connections/seat_weld.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/readable_number.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/connections/weld_spots.h"

namespace prismesh::mesh::connections {

namespace {

constexpr double kSameHeight = 1e-6;  ///< of the stack's height: nodes so near to each other along it have no order

std::string sheet_words(const Model& model, ShellIndex shell) {
  const PartIndex part = model.shell_parts[shell.value];
  return part.valid() ? "part:" + std::to_string((*model.parts)[part.value].id) : "a shell of no part";
}

/// A node of the weld, and the sheet that it lies on now.
struct PlacedEnd {
  Vec3 at = Vec3::Zero();
  bool fixed = false;
  spatial::SurfacePoint nearest;
  bool lies = false;
};

/// Whether the node stands for this sheet of the stack where it is.
bool lies_on(const Model& model, const PlacedEnd& end, const SheetAtSpot& sheet, bool one_part, double limit) {
  if (!end.lies || (end.at - sheet.point).norm() > limit) return false;
  // Two sheets of one part: only the shell tells them apart.
  return one_part ? end.nearest.shell == sheet.shell : model.shell_parts[end.nearest.shell.value] == model.shell_parts[sheet.shell.value];
}

/// One way to put the nodes onto sheets.
struct Trial {
  WeldSeat seat;
  double sum = 0, farthest = 0;
  bool possible = true;
};

}  // namespace

WeldSeat seat_weld(const Model& model, const spatial::BoxTree& tree, std::span<const WeldEnd> ends, const SeatOptions& options) {
  WeldSeat none;
  none.to.resize(ends.size());
  const auto refused = [&](std::string why) {
    none.why = std::move(why);
    return none;
  };
  std::vector<PlacedEnd> weld;
  for (const WeldEnd& end : ends) {
    if (!end.at.allFinite()) return refused(" has an end without a position");
    const auto nearest = tree.closest(end.at);
    if (!nearest) return refused(": there is no sheet");
    weld.push_back({end.at, end.fixed, *nearest, nearest->distance <= sheet_reach(model, nearest->shell, Attachment::placed)});
  }
  // From the node that is nearest to a sheet.
  const PlacedEnd& from = *std::min_element(weld.begin(), weld.end(),
                                            [](const PlacedEnd& a, const PlacedEnd& b) { return a.nearest.distance < b.nearest.distance; });
  const ShellIndex ground = from.nearest.shell;
  const double limit = options.max_move.value_or(max_joint_length(model, ground)), joint = max_joint_length(model, ground);
  if (from.nearest.distance > limit) return refused(": the nearest sheet is " + readable(from.nearest.distance, 3) + " away");
  SpotStack stack = stack_at(model, tree, from.nearest.point, {options.thickness_factor, options.gap});
  if (options.is_tied)
    std::erase_if(stack.sheets, [&](const SheetAtSpot& sheet) { return !options.is_tied(model.shell_parts[sheet.shell.value]); });
  if (stack.sheets.size() < weld.size()) {
    const std::string tied = options.is_tied ? " of those that a contact ties it to" : "";
    if (stack.sheets.size() > 1) return refused(": only " + std::to_string(stack.sheets.size()) + " sheets are there" + tied);
    if (stack.sheets.empty()) return refused(": no sheet" + (tied.empty() ? std::string() : tied) + " is there");
    return refused(": only a sheet of " + sheet_words(model, stack.sheets.front().shell) + " is there" + tied);
  }
  // Which way the nodes stand along the stack: a weld isn't turned over.
  const Vec3 up = stack.sheets.back().point - stack.sheets.front().point;
  const double rise = (weld.back().at - weld.front().at).dot(up);
  const bool ordered = std::abs(rise) > kSameHeight * up.squaredNorm();

  std::optional<Trial> best;
  for (std::size_t s = 0; s + weld.size() <= stack.sheets.size(); ++s)
    for (const bool turned : {false, true}) {
      if (ordered && turned != (rise < 0)) continue;
      const auto sheet_of = [&](std::size_t e) -> const SheetAtSpot& { return stack.sheets[s + (turned ? weld.size() - 1 - e : e)]; };
      Trial trial;
      trial.seat.to.resize(weld.size());
      bool moves = false;
      for (std::size_t e = 0; e < weld.size(); ++e) {
        const std::size_t other = e + 1 < weld.size() ? e + 1 : e - 1;
        const bool one_part = model.shell_parts[sheet_of(e).shell.value] == model.shell_parts[sheet_of(other).shell.value];
        if (lies_on(model, weld[e], sheet_of(e), one_part, joint)) continue;
        trial.seat.to[e] = sheet_of(e).point;
        const double by = (sheet_of(e).point - weld[e].at).norm();
        trial.farthest = std::max(trial.farthest, by);
        trial.sum += by;
        trial.possible = trial.possible && !weld[e].fixed;
        moves = true;
      }
      const bool near = trial.farthest <= limit;
      if (!moves)
        trial.seat.why = ": its ends lie on sheets that share nodes, or too far from each other";
      else if (!near)
        trial.seat.why = ": an end would have to move by " + readable(trial.farthest, 3) + ", farther than " + readable(limit, 3);
      else if (!trial.possible)
        trial.seat.why = ": the end that would have to move can't: another weld, a shell or a card has it";
      trial.possible = trial.possible && near && moves;
      // One that can be done is better than any that can't.
      if (!best || (trial.possible && !best->possible) || (trial.possible == best->possible && trial.sum < best->sum))
        best = std::move(trial);
    }
  if (!best->seat.why.empty()) return refused(best->seat.why);
  return std::move(best->seat);
}

}  // namespace prismesh::mesh::connections
