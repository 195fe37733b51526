#include "kiosk/notices/deck_warnings.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace prismesh::kiosk::notices {
namespace {

/// Kinds of warnings after which the model isn't all that the deck and its edits say.
constexpr std::array<std::string_view, 13> kErrors{
    "missing-include",    "unread-include",  "deep-include",          "too-many-includes",         "undefined-node",
    "incomplete-element", "unread-instance", "bad-include-transform", "unresolved-transformation", "undefined-parameter",
    "damaged-journal",    "save-mixed",      "save-unknown"};

bool is_error(std::string_view kind) { return std::find(kErrors.begin(), kErrors.end(), kind) != kErrors.end(); }

std::string counted(std::size_t count, std::string_view what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

}  // namespace

std::vector<ToldWarning> told_warnings(std::span<const mesh::deck::Warning> warnings) {
  std::vector<ToldWarning> told;
  told.reserve(warnings.size());
  for (const mesh::deck::Warning& warning : warnings) {
    std::string place = warning.line > 0 ? fmt::format("{}:{}", warning.file, warning.line) : warning.file;
    std::string text = warning.count > 1 ? fmt::format("{} ({} times)", warning.message, warning.count) : warning.message;
    told.push_back({is_error(warning.kind), std::move(place), std::move(text)});
  }
  std::stable_partition(told.begin(), told.end(), [](const ToldWarning& each) { return each.is_error; });
  return told;
}

std::size_t error_count(std::span<const ToldWarning> warnings) {
  return static_cast<std::size_t>(std::count_if(warnings.begin(), warnings.end(), [](const ToldWarning& each) { return each.is_error; }));
}

std::string counts_of(std::span<const ToldWarning> warnings) {
  const std::size_t errors = error_count(warnings), others = warnings.size() - errors;
  if (errors == 0) return counted(others, "warning");
  return others == 0 ? counted(errors, "error") : counted(errors, "error") + " and " + counted(others, "warning");
}

}  // namespace prismesh::kiosk::notices
