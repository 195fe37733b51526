#include "ipc/store/choosing.h"

namespace prismesh::ipc::store {

namespace {

constexpr std::size_t kMinDigits = 6;
constexpr std::size_t kShownDigits = 12;

}  // namespace

bool may_be_hash(std::string_view text) {
  return text.size() >= kMinDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Result<std::size_t> choose_model(const std::vector<ModelRecord>& models, const std::string& wanted, const std::string& where,
                                 const std::string& lists) {
  const bool is_hash = may_be_hash(wanted), is_whole = parse_content_hash(wanted).has_value();
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < models.size(); ++i)
    if ((!is_whole && models[i].name == wanted) || (is_hash && models[i].model.hex().starts_with(wanted))) found.push_back(i);
  if (found.size() == 1) return found.front();
  if (found.empty()) return fail(where, "has no model '" + wanted + "'; `" + lists + "` lists those there are");
  std::string hashes;
  for (const std::size_t i : found) hashes += (hashes.empty() ? "" : ", ") + models[i].model.hex().substr(0, kShownDigits);
  return fail(where, "has several models '" + wanted + "'; say which by its hash: " + hashes);
}

}  // namespace prismesh::ipc::store
