#include "mesh/deck/nastran/companion_files.h"

#include <algorithm>

#include "base/letter_case.h"
#include "mesh/deck/nastran/card.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

constexpr std::size_t kMaxStatementLines = 20;  ///< of a statement

bool is_quote(char c) { return c == '\'' || c == '"'; }

/// A statement with its continuations: a comma at the end of a line, or an open quote.
std::string statement_at(std::string_view text, std::size_t end, std::size_t& at) {
  std::string statement;
  char quote = 0;
  for (std::size_t lines = 0; at < end && lines < kMaxStatementLines; ++lines) {
    const Line line = line_at(text.substr(0, end), at);
    at = line.next;
    const std::string_view content = trim(quote != 0 ? line.text : line.text.substr(0, line.text.find('$')));
    for (const char c : content)
      if (is_quote(c)) quote = quote == 0 ? c : quote == c ? char{0} : quote;
    statement += content;
    if (quote == 0 && (content.empty() || content.back() != ',')) break;
  }
  return statement;
}

/// Logical names and kinds of ASSIGN whose files are only read.
bool is_read(std::string_view upper_statement) {
  for (const std::string_view word : {"INPUTT2", "INPUTT4", "H3DDMIG", "AKUSMOD", "DAC", "EXCINP", "GETDISP", "UPDATE", "STATUS=OLD"})
    if (upper_statement.find(word) != std::string_view::npos) return true;
  return false;
}

std::string file_name_in(std::string_view statement) {
  const auto open = std::find_if(statement.begin(), statement.end(), is_quote);
  if (open != statement.end()) {
    const auto close = std::find(open + 1, statement.end(), *open);
    return std::string(trim(std::string_view(open + 1, close)));
  }
  // MSC: the word behind the equals sign; OptiStruct: the last word.
  const std::size_t equals = statement.find('=');
  std::string_view rest = equals == std::string_view::npos ? statement : trim(statement.substr(equals + 1));
  if (equals != std::string_view::npos) return std::string(rest.substr(0, rest.find_first_of(" ,")));
  return std::string(trim(rest.substr(rest.find_last_of(" ,") + 1)));
}

}  // namespace

std::vector<NamedFile> named_files(std::string_view text, std::size_t begin, std::size_t end) {
  std::vector<NamedFile> names;
  for (std::size_t at = begin; at < end;) {
    const std::size_t offset = at;
    const std::string_view line = trim(line_at(text.substr(0, end), at).text);
    const bool is_assign = begins_with(line, "ASSIGN"), is_library = begins_with(line, "LOADLIB");
    if (!is_assign && !is_library) {
      at = line_at(text.substr(0, end), at).next;
      continue;
    }
    const std::string statement = statement_at(text, end, at);
    const std::string name = file_name_in(std::string_view(statement).substr(is_assign ? 6 : 7));
    std::string upper_statement;
    for (const char c : statement)
      if (c != ' ') upper_statement += upper(c);
    if (!name.empty()) names.push_back({is_assign ? "ASSIGN" : "LOADLIB", name, offset, is_assign && is_read(upper_statement)});
  }
  return names;
}

}  // namespace prismesh::mesh::deck::nastran
