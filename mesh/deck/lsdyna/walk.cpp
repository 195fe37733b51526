#include "mesh/deck/lsdyna/walk.h"

#include <algorithm>
#include <utility>

namespace prismesh::mesh::deck::lsdyna {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
constexpr int kDeepestInclude = 64;
constexpr std::size_t kMostFiles = 20000;
constexpr std::uint32_t kNoFile = 0xffffffffu;

bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

fs::path normal(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return (error ? path : absolute).lexically_normal();
}

std::string canonical_name(const fs::path& path) {
  std::error_code error;
  const fs::path canonical = fs::canonical(path, error);
  return (error ? normal(path) : canonical).string();
}

}  // namespace

Walk::Walk(fs::path path, FileBytes main, bool cut_out_encrypted)
    : main_folder_(normal(path).parent_path()), cut_out_encrypted_(cut_out_encrypted), search_(path.parent_path()) {
  by_canonical_[canonical_name(path)] = 0;
  fs::path name = path.filename();
  files.push_back({std::move(path), std::move(name), std::move(main)});
}

void Walk::run() {
  states_.resize(1);
  states_[0].uses = 1;
  walk_file(0, Columns::standard, 0);
  hold_repeated();
}

/// Nodes of a file that is used twice, and of what it includes, stand for more than one place.
void Walk::hold_repeated() {
  std::vector<bool> held(files.size());
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t file = 0; file < files.size(); ++file)
    if (states_[file].uses > 1) waiting.push_back(file);
  while (!waiting.empty()) {
    const std::uint32_t file = waiting.back();
    waiting.pop_back();
    if (held[file]) continue;
    held[file] = true;
    waiting.insert(waiting.end(), states_[file].includes.begin(), states_[file].includes.end());
  }
  for (Piece& piece : pieces) piece.held = held[piece.file];
}

void Walk::walk_file(std::uint32_t file, Columns columns, int depth) {
  states_[file].walked = states_[file].open = true;
  const Parameters before = parameters_;
  Blocks blocks(files[file].bytes.text(), columns);
  Block block;
  bool has_keyword = false;
  while (blocks.next(block)) {
    has_keyword |= starts_with(block.name, "KEYWORD");
    read_block(file, block, blocks.columns(), depth);
  }
  // Fragments without *KEYWORD do without *END; a deck that has the one lacks the other when it was cut off.
  if (has_keyword && !blocks.ended())
    warnings.note_each("no-end", file, files[file].bytes.text().size(), "the file has *KEYWORD but no *END: it may have been cut off");
  parameters_.leave_file(before);
  states_[file].open = false;
}

void Walk::read_block(std::uint32_t file, const Block& block, Columns columns, int depth) {
  const std::string_view text = files[file].bytes.text();
  const std::string_view name = block.name;
  if (const std::optional<CardForm> form = card_form(name)) {
    add_mesh(file, block, *form);
  } else if (starts_with(name, "ELEMENT_")) {
    warnings.note_each("unread-elements", file, block.keyword, "*" + block.name + " isn't read in this version; it is kept as it is");
  } else if (starts_with(name, "INCLUDE")) {
    include(file, block, columns, depth);
  } else if (starts_with(name, "PARAMETER") && name != "PARAMETER_DUPLICATION" && !starts_with(name, "PARAMETER_TYPE")) {
    parameters_.read(text, block);
  } else if (definitions.read(text, block, parameters_)) {
    return;
  } else if (starts_with(name, "PART_MOVE") || starts_with(name, "NODE_TRANSFORM")) {
    warnings.note_each("moved-at-start", file, block.keyword,
                       "*" + block.name + " moves nodes when the solver starts; they are shown and edited where their cards put them");
  }
}

void Walk::add_mesh(std::uint32_t file, const Block& block, const CardForm& form) {
  if (parameter_tables.empty() || !(parameter_tables.back() == parameters_)) parameter_tables.push_back(parameters_);
  states_[file].has_mesh = true;
  Segment segment{form, block.columns, static_cast<std::uint32_t>(parameter_tables.size() - 1), block.begin, block.end};
  const std::string_view text = files[file].bytes.text().substr(0, block.end);
  while (cut_out_encrypted_ && segment.begin < segment.end) {
    std::size_t begin = text.find(kEncryptedBegin, segment.begin);
    while (begin != std::string_view::npos && begin > 0 && text[begin - 1] != '\n') begin = text.find(kEncryptedBegin, begin + 1);
    if (begin == std::string_view::npos) break;
    Segment plain = segment;
    plain.end = begin;
    add_segment(file, plain);
    const std::size_t last = text.find(kEncryptedEnd, begin);
    const std::size_t end = last == std::string_view::npos ? last : text.find('\n', last);
    segment.begin = end == std::string_view::npos ? block.end : end + 1;
  }
  add_segment(file, segment);
}

/// Pieces are about equally large: long blocks are cut between lines, short ones put together.
void Walk::add_segment(std::uint32_t file, const Segment& segment) {
  const std::string_view text = files[file].bytes.text();
  const auto bytes_of = [](const Piece& piece) { return piece.segments.back().end - piece.segments.front().begin; };
  Segment rest = segment;
  while (rest.begin < rest.end) {
    if (pieces.empty() || pieces.back().file != file || bytes_of(pieces.back()) >= kPieceBytes) pieces.push_back({file, false, {}});
    Piece& piece = pieces.back();
    const std::size_t begin = piece.segments.empty() ? rest.begin : piece.segments.front().begin;
    std::size_t end = rest.end;
    if (rest.form.single_lines() && end - begin > kPieceBytes + kPieceBytes / 2) {
      const std::size_t line_end = text.find('\n', std::max(begin + kPieceBytes, rest.begin));
      end = std::min(rest.end, line_end == std::string_view::npos ? rest.end : line_end + 1);
    }
    Segment part = rest;
    part.end = end;
    piece.segments.push_back(part);
    rest.begin = end;
  }
}

void Walk::include(std::uint32_t from, const Block& block, Columns columns, int depth) {
  const std::string_view text = files[from].bytes.text();
  const std::string_view kind = std::string_view(block.name).substr(std::string_view("INCLUDE").size());
  if (kind == "_PATH" || kind == "_PATH_RELATIVE") {
    for (const IncludeName& name : include_names(text, block, false)) search_.add_path(name.name);
    return;
  }
  if (kind.empty()) {
    for (const IncludeName& name : include_names(text, block, false)) include_one(from, name, columns, depth, true);
    return;
  }
  bool read = false;
  if (kind == "_TRANSFORM") {
    read = transform_is_identity(text, block, parameters_);
    if (!read)
      warnings.note("transformed-include", from, block.keyword,
                    "*INCLUDE_TRANSFORM isn't read in this version: what the file holds isn't shown; it is kept as it is");
  } else {
    warnings.note_each("unread-include", from, block.keyword, "*" + block.name + " isn't read in this version; it is kept as it is");
    // Of the others only these begin with a file's name.
    if (kind != "_NASTRAN" && kind != "_BINARY" && kind != "_TRIM" && kind != "_AUTO_OFFSET" && !starts_with(kind, "_STAMPED")) return;
  }
  for (const IncludeName& name : include_names(text, block, true)) include_one(from, name, columns, depth, read);
}

void Walk::include_one(std::uint32_t from, const IncludeName& name, Columns columns, int depth, bool read) {
  std::string reason = "isn't there";
  const std::uint32_t file = find_file(from, name.name, reason);
  if (file == kNoFile) {
    if (missing_files.size() < kMostFiles) missing_files.push_back(name.name);
    warnings.note_each("missing-include", from, name.offset, "the include file " + name.name + " " + reason);
    return;
  }
  ++states_[file].uses;
  states_[from].includes.push_back(file);
  if (states_[file].open) {
    warnings.note("circular-include", from, name.offset, "the include file " + name.name + " includes itself; it is read once");
  } else if (!read) {
    return;
  } else if (states_[file].walked) {
    if (states_[file].has_mesh)
      warnings.note("repeated-include", from, name.offset,
                    "the include file " + name.name + " is included twice; its nodes can't be moved");
  } else if (depth >= kDeepestInclude) {
    warnings.note("deep-include", from, name.offset,
                  "the include file " + name.name + " is nested more than " + std::to_string(kDeepestInclude) + " deep; it isn't read");
  } else {
    walk_file(file, columns, depth + 1);
  }
}

/// Looked for once for each file that names it: names may be many, and looking is slow.
std::uint32_t Walk::find_file(std::uint32_t from, const std::string& name, std::string& reason) {
  const auto [at, first] = known_.try_emplace({from, name}, kNoFile);
  if (!first || missing_files.size() >= kMostFiles) return at->second;
  if (const std::optional<fs::path> found = search_.find(name, files[from].path.parent_path()))
    at->second = open_file(*found, name, reason);
  return at->second;
}

/// The index of the file, read now if it wasn't before; kNoFile with a reason if it can't be.
std::uint32_t Walk::open_file(const fs::path& found, const std::string& name, std::string& reason) {
  const std::string canonical = canonical_name(found);
  if (const auto at = by_canonical_.find(canonical); at != by_canonical_.end()) return at->second;
  if (files.size() >= kMostFiles) {
    reason = "is one of too many";
    return kNoFile;
  }
  Result<FileBytes> bytes = read_file(found);
  if (!bytes) {
    reason = bytes.error().message;
    return kNoFile;
  }
  // An absolute name would still mean the old file in a copy of the deck, so it isn't made relative.
  const fs::path relative = fs::path(name).is_absolute() ? fs::path(name) : normal(found).lexically_relative(main_folder_);
  const auto index = static_cast<std::uint32_t>(files.size());
  by_canonical_[canonical] = index;
  files.push_back({found, relative, std::move(*bytes)});
  states_.emplace_back();
  return index;
}

}  // namespace prismesh::mesh::deck::lsdyna
