#include "mesh/document/journal_rebuild.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/base64.h"
#include "base/json/read.h"
#include "mesh/document/branches.h"
#include "mesh/document/delta.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/exchange_relations.h"
#include "mesh/document/grow_relations.h"
#include "mesh/document/history.h"
#include "mesh/document/judge_parts.h"
#include "mesh/document/restructure.h"

namespace prismesh::mesh::document {

namespace {

std::string edit_name(std::string_view intent) {
  const json::Json edit = json::Json::parse(intent, nullptr, false);
  std::string name = "edit";
  if (!edit.is_object()) return name;
  json::FieldReader(edit, json::Author::program)("edit", name);
  return name;
}

bool is_exchange(std::string_view intent) {
  const EditKind* kind = find_edit_kind(edit_name(intent));
  return kind != nullptr && kind->group == EditGroup::exchange;
}

/// Whether the edit gave the model a new shape, which relaxing and repairing keep. Undo and redo across a save are recorded as edits with a
/// delta.
bool reshapes(std::string_view intent) {
  const Result<Edit> edit = parse_edit(intent);
  if (!edit) return false;
  const EditGroup group = kind_of(*edit).group;
  return group == EditGroup::shaping || group == EditGroup::contact || group == EditGroup::exchange || group == EditGroup::step;
}

/// The generation that results from applying the record's delta to the current one.
Result<std::shared_ptr<const Generation>> rebuilt(const Document& document, const JournalRecord& record) {
  const std::optional<std::vector<std::byte>> delta = base64_decode(record.delta);
  if (!delta) return fail("", "its delta isn't base64");
  auto next = std::make_shared<Generation>(document.current());
  const Result<NodeSet> moved = apply_delta(*delta, *next);
  if (!moved) return fail(moved.error());
  std::shared_ptr<const Judging> judging = std::exchange(next->judging, document.current().judging);
  settle_growth(document.current(), *moved, *next);
  grow_relations(document.current().model, *next);
  next->made_by = edit_name(record.intent);
  if (next->made_by == name(RepairWelds{})) place_anew(*moved, *next);
  if (is_exchange(record.intent)) exchange_relations(document.current().model, *next);
  if (judging != next->judging) judge_by(std::move(judging), *next);
  if (reshapes(record.intent)) next->surface = std::make_shared<const Model>(next->model);
  next->number = document.next_number;
  next->own_bytes = own_bytes(document.current(), *next);
  return std::shared_ptr<const Generation>(std::move(next));
}

}  // namespace

Result<void> take_record(const JournalRecord& record, Document& document, const std::string& file) {
  const auto wrong = [&](const std::string& what) {
    return fail(file, record.line, "edit " + std::to_string(record.number) + " can't be brought back: " + what);
  };
  Prepared prepared;
  prepared.step = record.step;
  prepared.drop_oldest = record.drop_oldest;
  prepared.drop_branches = record.drop_branches;
  prepared.branch = record.branch;
  if (record.step == Prepared::Step::push) {
    Result<std::shared_ptr<const Generation>> next = rebuilt(document, record);
    if (!next) return wrong(next.error().message);
    prepared.next = std::move(*next);
  } else if (record.step == Prepared::Step::branch) {
    const Branch* branch = find_branch(document, record.branch);
    if (branch == nullptr || branch->fork != document.current().number)
      return wrong("no branch " + std::to_string(record.branch) + " leaves from there");
  } else if (record.step == Prepared::Step::undo ? !document.can_undo() : !document.can_redo()) {
    return wrong("there is nothing to " + std::string(record.step == Prepared::Step::undo ? "undo" : "redo"));
  }
  commit(document, std::move(prepared));
  return {};
}

}  // namespace prismesh::mesh::document
