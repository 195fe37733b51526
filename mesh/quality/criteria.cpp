#include "mesh/quality/criteria.h"

#include <algorithm>
#include <cstdlib>

#include "base/file.h"
#include "mesh/quality/built_in.h"

namespace prismesh::mesh::quality {

Result<Criteria> load_criteria(const std::filesystem::path& path) {
  for (const BuiltInCriteria& built_in : kBuiltInCriteria)
    if (path.native() == built_in.name) return parse_criteria(built_in.text, std::string(built_in.name));
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  return parse_criteria(bytes->text(), path.string());
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
