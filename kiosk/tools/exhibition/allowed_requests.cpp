#include "kiosk/tools/exhibition/allowed_requests.h"

#include "mesh/quality/criteria.h"

namespace prismesh::kiosk::tools::exhibition {

namespace {

using namespace mesh::document;  // NOLINT(google-build-using-namespace): the kinds of edits

bool names_no_file(const Edit& edit) {
  if (const auto* criteria = std::get_if<SetCriteria>(&edit))
    return criteria->criteria == kDeckCriteria || mesh::quality::is_built_in_criteria(criteria->criteria);
  if (const auto* weld = std::get_if<Weld>(&edit)) return !weld->points_file;
  return !std::holds_alternative<ReplacePart>(edit);
}

}  // namespace

bool is_allowed(const ipc::Request& request, const std::filesystem::path& deck) {
  if (const auto* open = std::get_if<ipc::Open>(&request)) return open->path == deck.string() && open->stored.empty();
  if (std::holds_alternative<ipc::Save>(request)) return false;
  if (const auto* apply = std::get_if<ipc::ApplyEdit>(&request)) return names_no_file(apply->edit);
  if (const auto* preview = std::get_if<ipc::PreviewEdit>(&request)) return names_no_file(preview->edit);
  if (const auto* field = std::get_if<ipc::GetField>(&request))
    return field->against.empty() || field->against == "opened" || field->against == "surface" || field->against_generation.has_value();
  return true;
}

}  // namespace prismesh::kiosk::tools::exhibition
