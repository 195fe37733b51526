#include "kiosk/link/result_words.h"

#include <cmath>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/document/edit_kinds.h"

namespace prismesh::kiosk::link {
namespace {

using namespace mesh::document;

constexpr int kShownDigits = 3;

std::string length(double value, std::string_view unit) { return fmt::format("{} {}", readable(value, kShownDigits), unit); }
std::string angle(double degrees) { return readable(degrees, kShownDigits) + "\u00b0"; }

std::string of_operation(mesh::repair::Operation operation) {
  using mesh::repair::Operation;
  switch (operation) {
    case Operation::split: return "Split";
    case Operation::collapse: return "Collapsed";
    case Operation::merge: return "Merged";
    case Operation::swap: return "Swapped";
    default: return "Changed the mesh";
  }
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

/// "+0.8 %"; empty: it stays the same as far as anyone would see.
std::string change_of_mass(const EditReport& report) {
  if (!report.mass_before || !report.mass_after || !(*report.mass_before > 0)) return {};
  const double percent = 100 * (*report.mass_after / *report.mass_before - 1);
  if (std::abs(percent) < 0.005) return {};
  return fmt::format("mass {:+.{}f} %", percent, std::abs(percent) < 0.1 ? 2 : 1);
}

}  // namespace

std::string words_of_edit(const Edit& edit, std::string_view unit) {
  return std::visit(
      [&](const auto& each) -> std::string {
        using E = std::decay_t<decltype(each)>;
        if constexpr (std::is_same_v<E, Translate>) return "Moved " + length(each.by.norm(), unit);
        if constexpr (std::is_same_v<E, Slide>) return "Slid " + length(each.by.norm(), unit);
        if constexpr (std::is_same_v<E, Lift>) return "Lifted " + length(std::abs(each.distance), unit);  // the sign is the deck's
        if constexpr (std::is_same_v<E, Rotate>) return "Turned " + angle(each.degrees);
        if constexpr (std::is_same_v<E, Move>)
          return "Moved " + length(each.by.norm(), unit) + (each.degrees == 0 ? "" : ", turned " + angle(each.degrees));
        if constexpr (std::is_same_v<E, Relax>) return "Relaxed";
        if constexpr (std::is_same_v<E, Repair>) return "Repaired";
        if constexpr (std::is_same_v<E, Restructure>) return of_operation(each.operation);
        if constexpr (std::is_same_v<E, Separate>) return "Separated";
        if constexpr (std::is_same_v<E, Weld>) return "Welded";
        if constexpr (std::is_same_v<E, Bond>) return "Bonded";
        if constexpr (std::is_same_v<E, RepairWelds>) return "Welds repaired";
        return {};
      },
      edit);
}

std::string result_words(const std::string& what, const EditReport& report, std::string_view unit) {
  const EditKind* kind = find_edit_kind(report.edit);
  const bool step = kind != nullptr && kind->group == EditGroup::step;
  if (what.empty() && !step) return {};
  std::string words = !what.empty() ? what : report.notes.empty() ? capital(report.edit) : capital(report.notes.front());
  // An undo of a selection or of hiding changes no figures.
  if (step && report.nodes_moved + report.elements_added + report.elements_removed == 0) return words;
  const bool improves = kind != nullptr && kind->group == EditGroup::mending;
  if (improves && report.nodes_moved + report.elements_added + report.elements_removed == 0) {
    words += ": nothing was changed";
    return report.after.warn + report.after.fail == 0 ? words
                                                      : words + fmt::format("; warn {}; fail {}", report.after.warn, report.after.fail);
  }
  words += ": " + counted(report.nodes_moved, "node");
  if (report.largest_move) words += ", at most " + length(*report.largest_move, unit);
  if (report.elements_added + report.elements_removed > 0)
    words += fmt::format("; {} made, {} removed", counted(report.elements_added, "element"), report.elements_removed);
  if (improves || report.before.warn != report.after.warn)
    words += fmt::format("; warn {} \u2192 {}", report.before.warn, report.after.warn);
  words += fmt::format("; fail {} \u2192 {}", report.before.fail, report.after.fail);
  if (report.clusters_before != report.clusters_after)
    words += fmt::format("; clusters of triangles {} \u2192 {}", report.clusters_before, report.clusters_after);
  if (const std::string mass = change_of_mass(report); !mass.empty()) words += "; " + mass;
  return words;
}

}  // namespace prismesh::kiosk::link
