#include "mesh/quality/criteria.h"

#include <algorithm>
#include <cstdlib>

#include "base/file.h"
#include "mesh/quality/built_in.h"

namespace prismesh::mesh::quality {

Result<std::string> criteria_text(const std::filesystem::path& path) {
  for (const BuiltInCriteria& built_in : kBuiltInCriteria)
    if (path.native() == built_in.name) return std::string(built_in.text);
  std::error_code unknown;
  if (const std::uintmax_t bytes = std::filesystem::file_size(path, unknown); !unknown && bytes > kMaxCriteriaBytes)
    return fail(path.string(), "a criteria file has at most 1 MiB");
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  return std::string(bytes->text());
}

Result<Criteria> load_criteria(const std::filesystem::path& path) {
  const Result<std::string> text = criteria_text(path);
  if (!text) return fail(text.error());
  Result<Criteria> criteria = parse_criteria(*text, path.string());
  if (criteria && criteria->name.empty()) criteria->name = path.filename().string();
  return criteria;
}

std::vector<std::string_view> built_in_criteria() {
  std::vector<std::string_view> names;
  for (const BuiltInCriteria& built_in : kBuiltInCriteria) names.push_back(built_in.name);
  return names;
}

std::vector<std::filesystem::path> criteria_files_in(const std::filesystem::path& folder) {
  constexpr std::string_view kOfDeck = ".prismesh.toml";
  std::vector<std::filesystem::path> files;
  std::error_code problem;
  for (std::filesystem::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
    const std::string name = entry->path().filename().string();
    const bool is_of_deck = name.size() >= kOfDeck.size() && name.compare(name.size() - kOfDeck.size(), kOfDeck.size(), kOfDeck) == 0;
    std::error_code unknown;
    if (entry->path().extension() == ".toml" && !is_of_deck && entry->is_regular_file(unknown)) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::filesystem::path> found;
  for (const std::filesystem::path& file : files)
    if (found.size() < kMaxListedCriteria && load_criteria(file)) found.push_back(file);
  return found;
}

bool is_built_in_criteria(const std::filesystem::path& name) {
  return std::any_of(kBuiltInCriteria.begin(), kBuiltInCriteria.end(),
                     [&](const BuiltInCriteria& ours) { return name.native() == ours.name; });
}

std::string_view name(SizeFrom from) { return from == SizeFrom::part ? "part" : from == SizeFrom::deck ? "deck" : "given"; }

const Criteria& default_criteria() {
  static const Criteria kCriteria = [] {
    const Result<Criteria> parsed = parse_criteria(kBuiltInCriteria[0].text, "mesh/quality/criteria/default.toml");
    if (!parsed) std::abort();  // the text is compiled in and tested
    return *parsed;
  }();
  return kCriteria;
}

}  // namespace prismesh::mesh::quality
