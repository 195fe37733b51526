#include "cli/edit_list.h"

#include <algorithm>
#include <string_view>
#include <variant>

#include "base/file.h"
#include "mesh/document/edit_json.h"

namespace prismesh::cli {

namespace {

std::optional<Refusal> take(std::string_view text, const std::string& file, long line, std::vector<WantedEdit>& wanted) {
  bool is_not_json = false;
  Result<mesh::document::Edit> edit = mesh::document::parse_edit(text, &is_not_json);
  if (!edit) return Refusal{{file, line, edit.error().message}, is_not_json ? kWrongUsage : kFailed};
  wanted.push_back({std::move(*edit), file, line});
  return std::nullopt;
}

}  // namespace

std::optional<Refusal> read_edits(const std::vector<std::string>& edits, const std::string& argument,
                                  const std::optional<std::filesystem::path>& script, std::vector<WantedEdit>& wanted) {
  for (std::size_t i = 0; i < edits.size(); ++i)
    if (auto refusal = take(edits[i], argument, static_cast<long>(i + 1), wanted)) return refusal;
  if (!script) return std::nullopt;
  const Result<FileBytes> bytes = read_file(*script);
  if (!bytes) return Refusal{bytes.error()};
  std::string_view rest = bytes->text();
  for (long line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view edit = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (edit.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (auto refusal = take(edit, script->string(), line, wanted)) return refusal;
  }
  return std::nullopt;
}

bool is_kept_on_cancel(const mesh::document::Edit& edit) {
  const auto* repair = std::get_if<mesh::document::Repair>(&edit);
  return repair != nullptr && repair->on_cancel == mesh::document::OnCancel::keep;
}

void keep_on_cancel(std::vector<WantedEdit>& wanted) {
  for (WantedEdit& each : wanted)
    if (auto* repair = std::get_if<mesh::document::Repair>(&each.edit)) repair->on_cancel = mesh::document::OnCancel::keep;
}

}  // namespace prismesh::cli
