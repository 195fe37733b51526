#include "kiosk/link/notice_words.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/progress.h"
#include "ipc/wire/failure.h"
#include "mesh/document/edit_kinds.h"

namespace prismesh::kiosk::link {
namespace {

using notices::Notice;

constexpr std::string_view kRepair = "repair";  ///< the work that can be stopped and kept

std::string text_of(const ipc::Failed& failed) { return ipc::error_from(failed).text(); }

}  // namespace

bool was_stopped(const ipc::Failed& failed) { return is_cancelled(ipc::error_from(failed)); }

Notice notice_of_error(const Error& error) { return {Notice::Kind::error, error.text()}; }

Notice notice_of_missing_server() {
  return {Notice::Kind::error, "The model server is not running: nothing was done. It will be tried again."};
}

Notice notice_of_failure(const ipc::Failed& failed, const std::string& if_stopped) {
  if (was_stopped(failed)) return {Notice::Kind::information, "Stopped: " + if_stopped + "."};
  return {Notice::Kind::error, text_of(failed)};
}

Notice notice_of_failed_opening(const ipc::Failed& failed, const std::filesystem::path& deck) {
  const std::string name = deck.filename().string();
  if (was_stopped(failed)) return notice_of_failure(failed, name + " was not opened");
  return {Notice::Kind::error, fmt::format("{} was not opened. {}", name, text_of(failed))};
}

Notice notice_of_kept_edits(const std::string& deck) {
  return {Notice::Kind::information, fmt::format("The unsaved edits of {} are kept: they come back when it is opened again.", deck)};
}

Notice notice_of_saving(const ipc::Saved& saved, const std::string& remark) {
  std::string text = fmt::format("Saved {}: {} lines changed.", saved.path, saved.lines_changed);
  if (!remark.empty()) text += " " + remark;
  for (const std::string& note : saved.notes) text += "\n" + note;
  return {saved.notes.empty() ? Notice::Kind::information : Notice::Kind::warning, std::move(text)};
}

Notice notice_of_ended_drag(const ipc::DragEnded& ended) { return {Notice::Kind::warning, "The drag has ended: " + ended.why}; }

std::optional<Notice> notice_of_recovery(const ipc::DocumentState& state) {
  // Without a change these are steps that a save has carried over, such as the selection.
  if (state.recovered_edits == 0 || !state.changed) return std::nullopt;
  // A warning stays until it is closed, and comes before those of the deck.
  return Notice{
      Notice::Kind::warning,
      fmt::format("{} edit{} of {} that had not been saved {} recovered.", state.recovered_edits, state.recovered_edits == 1 ? "" : "s",
                  std::filesystem::path(state.path).filename().string(), state.recovered_edits == 1 ? "was" : "were")};
}

std::optional<Notice> notice_of_warnings(std::span<const notices::ToldWarning> warnings) {
  if (warnings.empty()) return std::nullopt;
  const notices::ToldWarning& worst = warnings.front();
  Notice notice{worst.is_error ? Notice::Kind::error : Notice::Kind::warning, worst.place + ": " + worst.text};
  notice.lists_warnings = warnings.size() > 1;
  if (notice.lists_warnings) notice.text += fmt::format("\n{} about this deck: Ctrl+I lists them.", notices::counts_of(warnings));
  return notice;
}

std::optional<Notice> notice_of_notes(const mesh::document::EditReport& report, const std::string& result) {
  // The first note of an undo or redo says what it undid: the result has it.
  const mesh::document::EditKind* kind = mesh::document::find_edit_kind(report.edit);
  const bool step = kind != nullptr && kind->group == mesh::document::EditGroup::step;
  std::string text;
  for (std::size_t i = step ? 1 : 0; i < report.notes.size(); ++i) text += (text.empty() ? "" : "\n") + report.notes[i];
  if (text.empty()) return std::nullopt;
  return Notice{Notice::Kind::information, result.empty() ? std::move(text) : result + "\n" + text};
}

std::string words_of_opening(const std::string& deck) { return words_of_progress({"Opening " + deck}, true); }

std::string words_of_progress(const ipc::ProgressMade& progress, bool can_stop) {
  const std::string& what = progress.what;
  std::string words = what == "open" ? "opening" : what == "relax" ? "relaxing" : what == kRepair ? "repairing" : what;
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  if (!progress.doing.empty()) words += fmt::format(": {}, {} s", progress.doing, progress.seconds);
  if (!can_stop) return words + " ..";
  return words + (what == kRepair ? "\nEsc stops and discards it, Shift+Esc stops and keeps it" : " ..   Esc stops it");
}

}  // namespace prismesh::kiosk::link
