#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <variant>

#include "base/file.h"
#include "mesh/document/branches.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/journal.h"
#include "mesh/document/journal_records.h"

namespace prismesh::mesh::document {

namespace {

/// Reads a script: one edit a line; empty lines are skipped.
Result<JournalIntents> read_script(std::string_view text, const std::string& file, bool* syntax_error) {
  JournalIntents intents;
  long line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view edit_text = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (edit_text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    Result<Edit> edit = parse_edit(edit_text, syntax_error);
    if (!edit) return fail(file, line, edit.error().message);
    intents.edits.push_back(std::move(*edit));
    intents.lines.push_back(line);
  }
  return intents;
}

}  // namespace

Result<JournalIntents> read_intents(const std::filesystem::path& path, bool* syntax_error) {
  if (syntax_error != nullptr) *syntax_error = false;
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const std::string file = path.string();
  if (!looks_like_journal(bytes->text())) return read_script(bytes->text(), file, syntax_error);

  JournalIntents intents;
  const auto on_header = [&](const JournalHeader& header) -> Result<void> {
    intents.deck_path = header.deck.path;
    intents.deck_hash = header.deck.hash;
    return {};
  };
  const auto on_record = [&](const JournalRecord& record) -> Result<void> {
    Result<Edit> edit = parse_edit(record.intent);
    if (!edit) return fail(file, record.line, edit.error().message);
    intents.edits.push_back(std::move(*edit));
    intents.lines.push_back(record.line);
    return {};
  };
  const Result<JournalEnd> end = read_journal(bytes->text(), file, on_header, on_record);
  if (!end) return fail(end.error());
  intents.torn_tail = end->torn_tail;
  intents.damage = end->damage;
  return intents;
}

namespace {

/// The history as it would be if every edit had been applied. With it an undo of an edit that couldn't be applied doesn't take back another
/// edit, and no edit acts on an old selection where the intended one couldn't be made.
class IntendedHistory {
 public:
  /// Whether the selection isn't the intended one.
  bool selection_lost() const { return cursor_ > 0 && steps_[cursor_ - 1].selection_lost; }

  /// `left`: the branch that the document made of what was undone, if it made one.
  void push(bool applied, const EditKind& kind, SelectionUse use, std::optional<std::uint64_t> left) {
    const bool lost = use.writes ? !applied : selection_lost();
    put_newer_aside(left);
    steps_.push_back({next_step_++, applied, lost, kind.group == EditGroup::selection});
    ++cursor_;
  }
  /// The document's branch that an intended one stands for; absent: it isn't there as intended.
  std::optional<std::uint64_t> branch(std::uint64_t number) const {
    const auto found = branches_.find(number);
    if (found == branches_.end() || found->second.fork != here()) return std::nullopt;
    return found->second.stands_for;
  }
  /// The steps of the branch become those that redo leads to. `taken`: in the document too.
  void take(std::uint64_t number, bool taken, std::optional<std::uint64_t> left) {
    const auto found = branches_.find(number);
    if (found == branches_.end() || found->second.fork != here()) return;
    std::vector<Step> steps = std::move(found->second.steps);
    branches_.erase(found);
    put_newer_aside(left);
    if (!taken)
      for (Step& step : steps) step.applied = false, step.selection_lost = true;
    steps_.insert(steps_.end(), steps.begin(), steps.end());
  }
  /// Moves over an edit by undo (or redo); returns whether that edit wasn't applied.
  bool skips(bool back) {
    if (back ? cursor_ == 0 : cursor_ == steps_.size()) return false;
    const std::size_t edit = back ? --cursor_ : cursor_++;
    return !steps_[edit].applied;
  }

 private:
  struct Step {
    std::uint64_t number = 0;
    bool applied = false;
    bool selection_lost = false;  ///< after it
    bool selects = false;
  };
  struct Aside {
    std::uint64_t fork = 0;  ///< Step::number; 0: the beginning
    std::vector<Step> steps;
    std::optional<std::uint64_t> stands_for;
  };

  std::uint64_t here() const { return cursor_ == 0 ? 0 : steps_[cursor_ - 1].number; }

  /// As put_newer_aside of a document in which every edit was applied.
  void put_newer_aside(std::optional<std::uint64_t> left) {
    const std::span<const Step> newer = std::span(steps_).subspan(cursor_);
    const auto is_fork = [&](const auto& each) { return std::ranges::find(newer, each.second.fork, &Step::number) != newer.end(); };
    if (!std::ranges::all_of(newer, &Step::selects) || std::ranges::any_of(branches_, is_fork)) {
      // Where an edit of it wasn't applied, the document may have put other states aside, or none.
      if (!std::ranges::all_of(newer, &Step::applied)) left.reset();
      branches_[next_branch_++] = {here(), {newer.begin(), newer.end()}, left};
    }
    steps_.resize(cursor_);
  }

  std::vector<Step> steps_;
  std::size_t cursor_ = 0;
  std::uint64_t next_step_ = 1;
  std::map<std::uint64_t, Aside> branches_;
  std::uint64_t next_branch_ = 1;
};

}  // namespace

std::vector<ReplayStep> replay(Document& document, const JournalIntents& intents, const Progress& progress, Clock* clock) {
  std::vector<ReplayStep> steps;
  IntendedHistory intended;
  for (std::size_t i = 0; i < intents.edits.size(); ++i) {
    if (progress && !progress(static_cast<double>(i) / static_cast<double>(intents.edits.size()))) break;
    const Edit& edit = intents.edits[i];
    ReplayStep step;
    step.line = i < intents.lines.size() ? intents.lines[i] : 0;
    step.edit = name(edit);
    const bool back = std::holds_alternative<Undo>(edit);
    const bool is_step = kind_of(edit).group == EditGroup::step;
    if (is_step && !std::holds_alternative<TakeBranch>(edit) && intended.skips(back)) {
      step.message = "the edit that it stands for wasn't applied";
      steps.push_back(std::move(step));
      continue;
    }
    const std::uint64_t next_branch = document.next_branch;
    const auto left = [&] { return document.next_branch > next_branch ? std::optional(next_branch) : std::nullopt; };
    if (const auto* branch = std::get_if<TakeBranch>(&edit)) {
      const std::optional<std::uint64_t> wanted = intended.branch(branch->number);
      const Result<EditReport> report = wanted
                                            ? apply(document, TakeBranch{*wanted}, {}, clock)
                                            : fail("", "branch " + std::to_string(branch->number) + " isn't there, or not all its edits");
      intended.take(branch->number, report.has_value(), left());
      step.applied = report.has_value();
      if (report)
        step.report = *report;
      else
        step.message = report.error().text();
      steps.push_back(std::move(step));
      continue;
    }
    const SelectionUse use = selection_use(edit);
    if (use.reads && intended.selection_lost()) {
      step.message = "the selection it acts on couldn't be made";
      steps.push_back(std::move(step));
      intended.push(false, kind_of(edit), use, {});
      continue;
    }
    const auto within = [&](double fraction, const Doing& doing) {
      return progress((static_cast<double>(i) + fraction) / static_cast<double>(intents.edits.size()), doing);
    };
    Result<EditReport> report = apply(document, edit, progress ? Progress(within) : Progress(), clock);
    if (!report && is_cancelled(report.error())) break;
    step.applied = report.has_value();
    if (report)
      step.report = std::move(*report);
    else
      step.message = report.error().text();
    if (!is_step) intended.push(step.applied, kind_of(edit), use, left());
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace prismesh::mesh::document
