#include "mesh/deck/lsdyna/includes.h"

#include <algorithm>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::size_t kLongestName = 4096;
constexpr std::size_t kMostPaths = 100;

/// Decks from Windows have backslashes between folders.
std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) && !std::filesystem::is_directory(path, error);
}

}  // namespace

std::vector<IncludeName> include_names(std::string_view text, const Block& block, bool only_first) {
  std::vector<IncludeName> names;
  Lines lines(text, block.begin, block.end);
  Line line;
  bool goes_on = false;
  while (lines.next(line)) {
    std::string_view part = trim(line.text);
    if (part.empty()) continue;
    if (!goes_on) {
      if (only_first && !names.empty()) break;
      names.push_back({{}, line.offset});
    }
    goes_on = part.size() >= 2 && part.back() == '+' && (part[part.size() - 2] == ' ' || part[part.size() - 2] == '\t');
    if (goes_on) part = trim(part.substr(0, part.size() - 1));
    std::string& name = names.back().name;
    if (name.size() + part.size() <= kLongestName) name += part;
  }
  return names;
}

bool transform_is_identity(std::string_view text, const Block& block, const Parameters& parameters) {
  Lines lines(text, block.begin, block.end);
  Line line;
  Card card;
  bool in_name = true;
  for (int number = 0; lines.next(line);) {
    const std::string_view part = trim(line.text);
    if (in_name) {
      in_name = part.size() >= 2 && part.back() == '+' && part[part.size() - 2] == ' ';
      continue;
    }
    // Offsets of ids on the first two cards; factors for mass, time, length on the third, where 1 is as good as 0 and
    // the fifth field only concerns the solver's output; the transformation on the fourth.
    ++number;
    card.cut(line.text, block.columns);
    for (std::size_t f = 0; f < card.count() && number <= 4; ++f) {
      if (number == 3 && f == 4) continue;
      const std::optional<double> value = card.real(f, parameters);
      if (!value || (*value != 0 && !(number == 3 && *value == 1))) return false;
    }
  }
  return true;
}

void IncludeSearch::add_path(const std::string& path) {
  if (paths_.size() < kMostPaths) paths_.push_back(main_folder_ / with_slashes(path));
}

std::optional<std::filesystem::path> IncludeSearch::find(const std::string& name, const std::filesystem::path& from_folder) const {
  if (name.find('\0') != std::string::npos) return std::nullopt;
  for (const std::string& spelled : {name, with_slashes(name)}) {
    if (is_file(from_folder / spelled)) return from_folder / spelled;
    if (is_file(main_folder_ / spelled)) return main_folder_ / spelled;
    for (const std::filesystem::path& path : paths_)
      if (is_file(path / spelled)) return path / spelled;
  }
  return std::nullopt;
}

}  // namespace prismesh::mesh::deck::lsdyna
