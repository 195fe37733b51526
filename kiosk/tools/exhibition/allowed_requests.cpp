#include "kiosk/tools/exhibition/allowed_requests.h"

namespace prismesh::kiosk::tools::exhibition {

namespace {

using namespace mesh::document;  // NOLINT(google-build-using-namespace): the kinds of edits

/// Target sizes and criteria are kept in a file beside the deck: the next visitor would get them.
bool touches_no_file(const Edit& edit) {
  if (std::holds_alternative<SetCriteria>(edit) || std::holds_alternative<SetTargetSize>(edit)) return false;
  if (const auto* weld = std::get_if<Weld>(&edit)) return !weld->points_file;
  return !std::holds_alternative<ReplacePart>(edit);
}

}  // namespace

bool is_allowed(const ipc::Request& request, const std::filesystem::path& deck) {
  if (const auto* open = std::get_if<ipc::Open>(&request)) return open->path == deck.string() && open->stored.empty();
  if (std::holds_alternative<ipc::Save>(request)) return false;
  if (const auto* apply = std::get_if<ipc::ApplyEdit>(&request)) return touches_no_file(apply->edit);
  if (const auto* preview = std::get_if<ipc::PreviewEdit>(&request)) return touches_no_file(preview->edit);
  if (const auto* field = std::get_if<ipc::GetField>(&request))
    return field->against.empty() || field->against == "opened" || field->against == "surface" || field->against_generation.has_value();
  return true;
}

}  // namespace prismesh::kiosk::tools::exhibition
