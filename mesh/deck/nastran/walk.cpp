#include "mesh/deck/nastran/walk.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "base/letter_case.h"
#include "base/parallel_for.h"
#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/nastran/companion_files.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

namespace fs = std::filesystem;

/// A file name may continue over so many lines; beyond, its quote isn't closed.
constexpr std::size_t kMaxNameLines = 20;
constexpr std::size_t kMaxNameLength = 4096;

bool is_end_of_word(std::string_view text, std::size_t at) {
  return at >= text.size() || std::string_view(" \t\r,$='\"").find(text[at]) != std::string_view::npos;
}

bool is_word(std::string_view text, std::string_view word) { return begins_with(text, word) && is_end_of_word(text, word.size()); }

std::optional<MarkKind> mark_of(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return std::nullopt;
  line.remove_prefix(first);
  switch (upper(line[0])) {
    case 'I': return is_word(line, "INCLUDE") ? std::optional(MarkKind::include) : std::nullopt;
    case 'E': return is_word(line, "ENDDATA") ? std::optional(MarkKind::end_data) : std::nullopt;
    case 'C': return is_word(line, "CEND") ? std::optional(MarkKind::executive) : std::nullopt;
    case 'S': return is_word(line, "SOL") ? std::optional(MarkKind::executive) : std::nullopt;
    case 'B': break;
    default: return std::nullopt;
  }
  if (!is_word(line, "BEGIN")) return std::nullopt;
  std::string_view rest = trim(line.substr(5, line.find('$') - 5));
  if (is_word(rest, "BULK")) rest = trim(rest.substr(4));
  return rest.empty() ? MarkKind::begin_bulk : MarkKind::begin_other;
}

/// Quick test whether the line may be a mark, so that mark_of is called for few lines.
inline bool may_be_mark(const char* at, const char* end) {
  while (at < end && (*at == ' ' || *at == '\t')) ++at;
  if (at == end) return false;
  const char c = static_cast<char>(*at & ~0x20);
  return c == 'I' || c == 'E' || c == 'B' || (c == 'C' && at + 1 < end && (at[1] & ~0x20) == 'E') ||
         (c == 'S' && at + 1 < end && (at[1] & ~0x20) == 'O');
}

void find_marks(std::string_view text, std::size_t begin, std::size_t end, std::vector<Mark>& marks) {
  // A line belongs to the range of bytes that it begins in.
  if (begin > 0) {
    const std::size_t line_end = text.find('\n', begin - 1);
    begin = line_end == std::string_view::npos ? end : line_end + 1;
  }
  const char* const last = text.data() + text.size();
  while (begin < end) {
    const char* at = text.data() + begin;
    const void* found = std::memchr(at, '\n', static_cast<std::size_t>(last - at));
    const char* line_end = found ? static_cast<const char*>(found) : last;
    const std::size_t next = static_cast<std::size_t>(line_end - text.data()) + (found ? 1 : 0);
    if (may_be_mark(at, line_end))
      if (const std::optional<MarkKind> kind = mark_of({at, static_cast<std::size_t>(line_end - at)}))
        marks.push_back({begin, next, *kind});
    begin = next;
  }
}

struct IncludeName {
  std::string name;      ///< empty: there is none
  std::size_t next = 0;  ///< where the line after the statement begins
  bool unclosed = false;
};

/// The name after INCLUDE.
IncludeName include_name(std::string_view text, const Mark& mark) {
  std::size_t at = text.find_first_not_of(" \t", mark.offset) + std::string_view("INCLUDE").size();
  while (at < mark.next && (text[at] == ' ' || text[at] == '\t' || text[at] == '=')) ++at;
  if (at >= mark.next) return {std::string(), mark.next, false};
  const char quote = text[at];
  const std::string_view line = trim(line_at(text, at).text);
  if (quote != '\'' && quote != '"')
    return {std::string(line.substr(0, std::min(line.find_first_of(" \t$"), kMaxNameLength))), mark.next, false};
  std::string name;
  std::size_t from = at + 1;
  for (std::size_t lines = 0; lines < kMaxNameLines && from < text.size() && name.size() < kMaxNameLength; ++lines) {
    const Line part = line_at(text, from);
    const std::size_t end = part.text.find(quote);
    name += trim(part.text.substr(0, end));
    if (end != std::string_view::npos) return {name, part.next, false};
    from = part.next;
  }
  return {std::string(trim(line.substr(std::min<std::size_t>(1, line.size())))), mark.next, true};
}

}  // namespace

std::vector<Mark> find_marks(std::string_view text) {
  const std::size_t stretches = text.size() / kPieceBytes + 1;
  std::vector<std::vector<Mark>> found(stretches);
  parallel_for(stretches, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) find_marks(text, s * kPieceBytes, std::min((s + 1) * kPieceBytes, text.size()), found[s]);
  });
  std::vector<Mark> marks;
  for (const std::vector<Mark>& some : found) marks.insert(marks.end(), some.begin(), some.end());
  return marks;
}

Walk::Walk(FileSet found) : files(std::move(found)) {}

void Walk::run() {
  walked_files_.resize(1);
  walked_files_[0].uses = 1;
  const std::vector<Mark> marks = find_marks(files.files[0].bytes.text());
  // Without any of these marks the deck is bulk data from its first line on: pre-processors write parts of models so.
  const bool has_sections = std::any_of(marks.begin(), marks.end(), [](const Mark& mark) {
    return mark.kind == MarkKind::begin_bulk || mark.kind == MarkKind::begin_other || mark.kind == MarkKind::executive;
  });
  if (!has_sections) section_ = Section::bulk;
  has_other_sections = std::any_of(marks.begin(), marks.end(), [](const Mark& mark) { return mark.kind == MarkKind::begin_other; });
  has_statements = std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) {
    return mark.kind == MarkKind::begin_bulk || mark.kind == MarkKind::executive ||
           (mark.kind == MarkKind::begin_other &&
            line_at(files.files[0].bytes.text(), mark.offset).text.find('=') != std::string_view::npos);
  });
  walk_file(0, marks, 0);
  if (section_ == Section::control)
    warnings.note("no-bulk-data", 0, 0, "the deck has executive or case control but no BEGIN BULK: there is nothing to show");
  // Bulk data without an executive section needs no ENDDATA; a deck with BEGIN BULK and without ENDDATA was cut off.
  if ((section_ == Section::bulk || section_ == Section::other) && has_sections)
    warnings.note_each("no-end", 0, files.files[0].bytes.text().size(), "the deck has BEGIN BULK but no ENDDATA: it may have been cut off");
  hold_repeated();
}

void Walk::walk_file(std::uint32_t file, const std::vector<Mark>& marks, int depth) {
  walked_files_[file].walked = walked_files_[file].open = true;
  const std::string_view text = files.files[file].bytes.text();
  std::size_t at = begins_with(text, "\xef\xbb\xbf") ? 3 : 0;
  for (const Mark& mark : marks) {
    if (mark.offset < at) continue;
    if (mark.kind == MarkKind::executive) continue;
    take(file, at, mark.offset);
    at = mark.next;
    if (mark.kind == MarkKind::include) {
      at = include(file, mark, depth);
    } else if (mark.kind == MarkKind::begin_bulk) {
      section_ = Section::bulk;
    } else if (mark.kind == MarkKind::begin_other) {
      section_ = Section::other;
      warnings.note("unread-section", file, mark.offset,
                    "only the main bulk data is read; what follows " + quoted(trim(line_at(text, mark.offset).text)) +
                        " has ids of its own and isn't shown; it is kept as it is");
    } else if (section_ != Section::control) {
      if (file == 0) {
        section_ = Section::ended;
        break;
      }
      warnings.note("end-in-include", file, mark.offset, "ENDDATA in an include is taken to end that file only");
      at = text.size();
    }
    if (section_ == Section::ended) break;
  }
  if (section_ != Section::ended) take(file, at, text.size());
  walked_files_[file].open = false;
}

void Walk::take(std::uint32_t file, std::size_t begin, std::size_t end) {
  if (begin >= end) return;
  const std::string_view text = files.files[file].bytes.text();
  if (section_ == Section::control) {
    references.read_case_control(text, file, begin, end);
    find_companions(file, begin, end);
  } else if (section_ == Section::bulk)
    cut(file, begin, end);
  else if (section_ == Section::other)
    references.read_unread("BEGIN", {file, begin, end});
}

/// The files that statements before the bulk data name: ASSIGN, and OptiStruct's LOADLIB.
void Walk::find_companions(std::uint32_t from, std::size_t begin, std::size_t end) {
  const std::array<fs::path, 2> folders{files.folder_of(from), files.folder_of(0)};
  for (const NamedFile& named : named_files(files.files[from].bytes.text(), begin, end)) {
    std::string reason;
    if (files.accompany(named.name, folders, reason) || files.accompany(named.name + ".gz", folders, reason) || !named.is_certain) continue;
    warnings.note_each("missing-file", from, named.offset, "the file " + named.name + ", which " + named.statement + " names, " + reason);
  }
}

/// Cuts bulk data into pieces of about equal size, each beginning with a card.
void Walk::cut(std::uint32_t file, std::size_t begin, std::size_t end) {
  const std::string_view text = files.files[file].bytes.text().substr(0, end);
  while (begin < end) {
    std::size_t next = end;
    if (end - begin > kPieceBytes + kPieceBytes / 2) {
      const std::size_t line_end = text.find('\n', begin + kPieceBytes);
      next = line_end == std::string_view::npos ? end : line_end + 1;
      while (next < end) {
        const Line line = line_at(text, next);
        // A card with an equals sign may take fields from the card before.
        if (starts_card(line.text) && line.text.find('=') == std::string_view::npos) break;
        next = line.next;
      }
    }
    pieces.push_back({file, begin, next});
    begin = next;
  }
}

/// Where the line after the statement begins.
std::size_t Walk::include(std::uint32_t from, const Mark& mark, int depth) {
  const auto [name, next, unclosed] = include_name(files.files[from].bytes.text(), mark);
  if (unclosed && !name.empty()) {
    files.missing.push_back(name);
    warnings.note_each("missing-include", from, mark.offset,
                       "the quote before the include file's name " + deck::quoted(name) + " isn't closed");
    return next;
  }
  std::string reason;
  const std::array<fs::path, 2> folders{files.folder_of(from), files.folder_of(0)};
  const std::uint32_t file = name.empty() ? FileSet::kNoFile : files.include(from, name, folders, reason);
  walked_files_.resize(files.files.size());
  if (file == FileSet::kNoFile) {
    warnings.note_each("missing-include", from, mark.offset,
                       name.empty() ? std::string("INCLUDE names no file") : "the include file " + name + " " + reason);
    return next;
  }
  ++walked_files_[file].uses;
  walked_files_[from].includes.push_back(file);
  if (walked_files_[file].open) {
    warnings.note("circular-include", from, mark.offset, "the include file " + name + " includes itself; it is read once");
  } else if (walked_files_[file].walked) {
    warnings.note("repeated-include", from, mark.offset, "the include file " + name + " is included twice; its nodes can't be moved");
  } else if (depth >= kMaxIncludeDepth) {
    warnings.note("deep-include", from, mark.offset,
                  "the include file " + name + " is nested more than " + std::to_string(kMaxIncludeDepth) + " deep; it isn't read");
  } else {
    walk_file(file, find_marks(files.files[file].bytes.text()), depth + 1);
  }
  return next;
}

/// Holds files that are used twice, and what they include: their nodes stand for more than one place.
void Walk::hold_repeated() {
  std::vector<const FileUse*> uses;
  for (const WalkedFile& file : walked_files_) uses.push_back(&file);
  held = repeated_files(uses);
}

}  // namespace prismesh::mesh::deck::nastran
