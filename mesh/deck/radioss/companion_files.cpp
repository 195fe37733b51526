#include "mesh/deck/radioss/companion_files.h"

#include <string_view>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

/// The name stands on the data line `line` (from 1, titles count); 0: on any of the first lines, if it is one at all.
struct FileRule {
  std::string_view keyword;  ///< the words that the block begins with
  int line = 0;
  bool is_mesh = false;
};

constexpr FileRule kFileRules[] = {
    {"INCLUDE_LS-DYNA", 1, true},
    {"INISTA", 1},
    {"REFSTA"},
    {"STATE/STR_FILE"},
    {"FXBODY", 3},
    {"EIG"},
    {"EOS/SESAME"},
    {"MAT/LAW26"},
    {"MAT/SESAM"},
    {"INIMAP1D/FILE"},
    {"INIMAP2D/FILE"},
};

constexpr int kMaxNameLines = 40;

bool is_or_begins_with(std::string_view keyword, std::string_view words) {
  return keyword.starts_with(words) && (keyword.size() == words.size() || keyword[words.size()] == '/');
}

/// "x_0003.sty" of /INISTA needs "x_0000.sty" as well.
std::string first_state(const std::string& name) {
  const std::size_t at = name.rfind("_0");
  return at != std::string::npos && name.size() == at + 9 && name.ends_with(".sty") ? name.substr(0, at) + "_0000.sty" : std::string();
}

}  // namespace

std::vector<NamedFile> named_files(std::span<const SourceFile> files, const Block& block, const Keyword& keyword) {
  const std::string words = keyword.joined();
  std::vector<NamedFile> names;
  for (const FileRule& rule : kFileRules) {
    if (!is_or_begins_with(words, rule.keyword)) continue;
    BlockLines lines(files, block);
    Line line;
    for (int number = 1; number <= kMaxNameLines && lines.next(line); ++number) {
      if (rule.line != 0 && number < rule.line) continue;
      const std::string name(trim(line.text));
      if (!name.empty()) names.push_back({name, line.file == block.file ? line.offset : block.offset, rule.is_mesh, rule.line != 0});
      if (const std::string first = rule.keyword == "INISTA" ? first_state(name) : std::string(); !first.empty())
        names.push_back({first, block.offset, false, false});
      if (rule.line != 0) break;
    }
  }
  return names;
}

}  // namespace prismesh::mesh::deck::radioss
