#include "mesh/connections/seat_weld.h"

#include <algorithm>
#include <cstddef>

#include "base/readable_number.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/connections/weld_spots.h"

namespace prismesh::mesh::connections {

namespace {

std::string sheet_words(const Model& model, ShellIndex shell) {
  const PartIndex part = model.shell_parts[shell.value];
  return part.valid() ? "part:" + std::to_string((*model.parts)[part.value].id) : "a shell of no part";
}

/// An end, and the sheet that it lies on now.
struct WeldEnd {
  Vec3 at = Vec3::Zero();
  std::optional<spatial::SurfacePoint> nearest;
  bool lies = false;
};

/// Whether the end lies on this sheet of the stack, and on no other that is as near.
bool lies_on(const Model& model, const WeldEnd& end, const SheetAtSpot& sheet, const SheetAtSpot& other) {
  if (!end.lies) return false;
  const PartIndex of = model.shell_parts[end.nearest->shell.value];
  const PartIndex part = model.shell_parts[sheet.shell.value], others = model.shell_parts[other.shell.value];
  if (part != others) return of == part;
  return end.nearest->shell == sheet.shell;  // two sheets of one part: only the shell tells them apart
}

}  // namespace

WeldSeat seat_weld(const Model& model, const spatial::BoxTree& tree, const std::array<Vec3, 2>& ends, const std::array<bool, 2>& fixed,
                   const SeatOptions& options) {
  WeldSeat seat;
  std::array<WeldEnd, 2> weld;
  for (std::size_t e = 0; e < 2; ++e) {
    weld[e].at = ends[e];
    if (!ends[e].allFinite()) return seat.why = " has an end without a position", seat;
    weld[e].nearest = tree.closest(ends[e]);
    if (!weld[e].nearest) return seat.why = ": there is no sheet", seat;
    weld[e].lies = weld[e].nearest->distance <= sheet_reach(model, weld[e].nearest->shell, Attachment::placed);
  }
  // From an end that is where it belongs, else from the sheet that is nearest to the weld.
  const std::size_t from = weld[0].nearest->distance <= weld[1].nearest->distance ? 0 : 1;
  const ShellIndex ground = weld[from].nearest->shell;
  const double limit = options.max_move.value_or(max_joint_length(model, ground));
  if (weld[from].nearest->distance > limit)
    return seat.why = ": the nearest sheet is " + readable(weld[from].nearest->distance, 3) + " away", seat;
  const SpotStack stack = stack_at(model, tree, weld[from].nearest->point, {options.thickness_factor, options.gap});
  if (stack.sheets.size() < 2) return seat.why = ": only a sheet of " + sheet_words(model, ground) + " is there", seat;

  double least = -1;
  bool can = false;
  for (std::size_t s = 0; s + 1 < stack.sheets.size(); ++s)
    for (const bool turned : {false, true}) {
      const std::array<const SheetAtSpot*, 2> on{&stack.sheets[turned ? s + 1 : s], &stack.sheets[turned ? s : s + 1]};
      WeldSeat trial;
      double farthest = 0, sum = 0;
      bool possible = true;
      for (std::size_t e = 0; e < 2; ++e) {
        if (lies_on(model, weld[e], *on[e], *on[1 - e])) continue;
        trial.to[e] = on[e]->point;
        const double by = (on[e]->point - weld[e].at).norm();
        farthest = std::max(farthest, by);
        sum += by;
        possible = possible && !fixed[e];
      }
      possible = possible && farthest <= limit;
      // One that can be done is better than any that can't.
      if (least >= 0 && (can > possible || (can == possible && sum >= least))) continue;
      least = sum;
      can = possible;
      if (!possible)
        trial.why = farthest > limit ? ": an end would have to move by " + readable(farthest, 3) + ", farther than " + readable(limit, 3)
                                     : std::string(": the end that would have to move can't: another weld, a shell or a card has it");
      seat = trial;
    }
  if (!seat.why.empty()) seat.to = {};
  return seat;
}

}  // namespace prismesh::mesh::connections
