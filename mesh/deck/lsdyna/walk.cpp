#include "mesh/deck/lsdyna/walk.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/lsdyna/companion_files.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxWalks = 4000;  ///< also of contexts, which are searched for each include
constexpr std::size_t kFreeRepeats = std::size_t{64} << 20;
constexpr std::size_t kMaxRepeats = 16;  ///< times the size of all files

}  // namespace

Walk::Walk(FileSet found, bool cut_out_encrypted)
    : files(std::move(found)), cut_out_encrypted_(cut_out_encrypted), search_(files.folder_of(0)) {}

void Walk::run() {
  states_.resize(1);
  states_[0].uses = 1;
  walk_file({0, 0, 0}, Columns::standard);
  tell_unseen();
  hold_repeated();
}

/// Holds the nodes of files that are used twice, and of what these include: they stand for more than one place.
void Walk::hold_repeated() {
  std::vector<const FileUse*> uses;
  for (const FileState& state : states_) uses.push_back(&state);
  const std::vector<bool> held = repeated_files(uses);
  for (Piece& piece : pieces) piece.held = held[piece.file];
}

void Walk::walk_file(const Visit& visit, Columns columns) {
  FileState& state = states_[visit.file];
  state.walked.insert(visit.context);
  state.open = true;
  ++walks_;
  const Parameters before = parameters_;
  parameters_.enter_file();
  Blocks blocks(files.files[visit.file].bytes.text(), columns);
  Block block;
  bool has_keyword = false;
  while (blocks.next(block)) {
    has_keyword |= block.name.starts_with("KEYWORD");
    const std::size_t undefined = parameters_.undefined();
    read_block(visit, block, blocks.columns());
    if (parameters_.undefined() > undefined)
      warnings.note("undefined-parameter", visit.file, block.keyword,
                    "*" + block.name + " names a parameter that isn't defined; what depends on it stays unknown");
  }
  // Fragments without *KEYWORD need no *END. A file with *KEYWORD and no *END may have been cut off.
  if (has_keyword && !blocks.ended())
    warnings.note_each("no-end", visit.file, files.files[visit.file].bytes.text().size(),
                       "the file has *KEYWORD but no *END: it may have been cut off");
  parameters_.leave_file(before);
  states_[visit.file].open = false;
}

void Walk::read_block(const Visit& visit, const Block& block, Columns columns) {
  const std::string_view text = files.files[visit.file].bytes.text();
  const std::string_view name = block.name;
  references.read(visit.file, block, parameters_, contexts[visit.context].offsets);
  const std::optional<CardForm> form = card_form(name);
  if (!form) {
    generated.read(text, block, parameters_);
    find_companions(visit, block);
  }
  if (form) {
    add_mesh(visit, block, *form);
  } else if (name.starts_with("INCLUDE")) {
    include(visit, block, columns);
  } else if (name.starts_with("PARAMETER")) {
    std::vector<ParameterProblem> problems;
    parameters_.read(text, block, problems);
    for (ParameterProblem& problem : problems) warnings.note(problem.kind, visit.file, problem.offset, std::move(problem.message));
  } else if (definitions.read(text, block, parameters_, contexts[visit.context])) {
    for (const BadField& bad : definitions.take_bad_fields())
      warnings.note("bad-card", visit.file, bad.offset, bad.message + "; the card is kept as it is, without that value");
  } else if (name == "DEFINE_TRANSFORMATION" || name == "DEFINE_TRANSFORMATION_TITLE") {
    transformations.read(text, visit.file, block, parameters_, contexts[visit.context].offsets);
  } else if (const std::optional<Unseen> what = unseen(name)) {
    note_unseen(visit, block, *what);
  }
}

/// Counts the lines over all blocks of a keyword in a file.
void Walk::note_unseen(const Visit& visit, const Block& block, const Unseen& what) {
  if (!what.counted) {
    warnings.note_each(what.kind, visit.file, block.keyword, "*" + block.name + " " + std::string(what.message));
    return;
  }
  if (states_[visit.file].walked.size() > 1) return;  // reported at the first place it is shown at
  UnseenLines& unseen_lines = unseen_.try_emplace({visit.file, block.name}, UnseenLines{what, block.keyword}).first->second;
  Lines lines(files.files[visit.file].bytes.text(), block.begin, block.end);
  Line line;
  while (lines.next(line))
    if (!trim(line.text).empty()) ++unseen_lines.lines;
}

void Walk::tell_unseen() {
  for (const auto& [keyword, found] : unseen_)
    warnings.note_each(found.what.kind, keyword.first, found.offset,
                       "*" + keyword.second + " " + std::string(found.what.message) + " (" + std::to_string(found.lines) +
                           (found.lines == 1 ? " line)" : " lines)"));
}

void Walk::add_mesh(const Visit& visit, const Block& block, const CardForm& form) {
  const std::uint32_t file = visit.file;
  if (parameter_tables.empty() || !(parameter_tables.back() == parameters_)) parameter_tables.push_back(parameters_);
  states_[file].has_mesh = true;
  Segment segment{form, block.columns, static_cast<std::uint32_t>(parameter_tables.size() - 1), block.begin, block.end, visit.context, {}};
  // "ELEMENT_SHELL_THICKNESS" is reported as "SHELL_THICKNESS".
  constexpr std::string_view kElement = "ELEMENT_";
  if (block.name.starts_with(kElement)) segment.word = *words_.insert(block.name.substr(kElement.size())).first;
  const std::string_view text = files.files[file].bytes.text().substr(0, block.end);
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
    references.encrypted(file, block, begin, segment.begin);
  }
  add_segment(file, segment);
}

/// Makes pieces of about equal size: cuts long blocks between lines, and joins short ones.
void Walk::add_segment(std::uint32_t file, const Segment& segment) {
  const std::string_view text = files.files[file].bytes.text();
  const auto bytes_of = [](const Piece& piece) { return piece.segments.back().end - piece.segments.front().begin; };
  Segment rest = segment;
  while (rest.begin < rest.end) {
    if (pieces.empty() || pieces.back().file != file || pieces.back().segments.back().frame != rest.frame ||
        bytes_of(pieces.back()) >= kPieceBytes)
      pieces.push_back({file, false, {}});
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

void Walk::include(const Visit& from, const Block& block, Columns columns) {
  const std::string_view text = files.files[from.file].bytes.text();
  const std::string_view kind = std::string_view(block.name).substr(std::string_view("INCLUDE").size());
  if (kind == "_PATH" || kind == "_PATH_RELATIVE") {
    for (const IncludeName& name : include_names(text, block, false)) search_.add_path(name.name);
  } else if (kind.empty()) {
    for (const IncludeName& name : include_names(text, block, false)) include_one(from, name, columns, from.context);
  } else if (kind == "_TRANSFORM") {
    include_transformed(from, block, columns);
  } else {
    keep_unread(from, block);
  }
}

/// An equal transformation at another place shares its context. One that changes nothing is a plain include.
void Walk::include_transformed(const Visit& from, const Block& block, Columns columns) {
  const std::string_view text = files.files[from.file].bytes.text();
  IncludeTransform transform = read_transform(text, block, parameters_, contexts, from.context);
  if (!transform.problem.empty())
    warnings.note_each("bad-include-transform", from.file, block.keyword,
                       "*" + block.name + " " + transform.problem + "; that is left out");
  IncludeContext& context = transform.context;
  context.file = from.file;
  context.offset = block.keyword;
  std::uint32_t index = from.context;
  IncludeContext nothing = contexts[from.context];
  nothing.parent = from.context;
  nothing.transformation = 0;
  if (!context.same_as(nothing)) {
    const auto known = std::find_if(contexts.begin() + 1, contexts.end(), [&](const IncludeContext& c) { return c.same_as(context); });
    index = static_cast<std::uint32_t>(known - contexts.begin());
    if (index >= kMaxWalks) {
      warnings.note("too-many-includes", from.file, block.keyword, "more includes are transformed than can be shown; this one isn't read");
      return;
    }
    if (known == contexts.end()) contexts.push_back(std::move(context));
  }
  for (const IncludeName& name : include_names(text, block, true)) include_one(from, name, columns, index);
}

/// Keeps the files of *INCLUDE keywords that aren't read: they belong to the deck too. Those of some become part of the mesh; those of the
/// others are only looked into for something else.
void Walk::keep_unread(const Visit& from, const Block& block) {
  const std::string_view kind = std::string_view(block.name).substr(std::string_view("INCLUDE").size());
  warnings.note_each("unread-include", from.file, block.keyword, "*" + block.name + " isn't read in this version; it is kept as it is");
  if (kind == "_COMPENSATION_SYMMETRIC_LINES") return;  // names no file
  static constexpr std::string_view kOfMesh[] = {"_NASTRAN", "_BINARY", "_TRANSFORM_BINARY", "_AUTO_OFFSET", "_AUTO_OFFSET_USER",
                                                 "_ISPG",    "_EFV",    "_RADIOSS"};
  const bool is_mesh = std::find(std::begin(kOfMesh), std::end(kOfMesh), kind) != std::end(kOfMesh);
  const bool has_number_first = kind.starts_with("_MULTISCALE");
  std::vector<IncludeName> names = include_names(files.files[from.file].bytes.text(), block, !has_number_first);
  if (has_number_first) names = names.size() > 1 ? std::vector(names.begin() + 1, names.begin() + 2) : std::vector<IncludeName>();
  for (const IncludeName& name : names) {
    if (!is_mesh) {
      accompany(from, block, name.name, name.offset, true);
      continue;
    }
    std::string reason;
    const std::uint32_t file = files.include_unread(from.file, name.name, search_.folders(files.folder_of(from.file)), block.name, reason);
    states_.resize(files.files.size());
    if (file == FileSet::kNoFile)
      warnings.note_each("missing-include", from.file, name.offset, "the include file " + name.name + " " + reason);
    else
      ++states_[file].uses;
  }
}

void Walk::find_companions(const Visit& from, const Block& block) {
  for (const NamedFile& named : named_files(files.files[from.file].bytes.text(), block))
    accompany(from, block, named.name, named.offset, named.is_certain);
}

/// Notes a file that a card names, or may name.
void Walk::accompany(const Visit& from, const Block& block, const std::string& name, std::size_t offset, bool is_certain) {
  std::string reason;
  const std::string spelled = parameters_.put_into_text(name);
  if (files.accompany(spelled, search_.folders(files.folder_of(from.file)), reason) || !is_certain) return;
  warnings.note_each("missing-file", from.file, offset, "the file " + name + ", which *" + block.name + " names, " + reason);
}

/// A file that is shown at several places costs its size several times. The limits prevent a short deck from taking gigabytes.
bool Walk::may_walk_again(std::uint32_t file) {
  std::size_t total = 0;
  for (const SourceFile& each : files.files) total += each.bytes.text().size();
  walked_again_ += files.files[file].bytes.text().size();
  return walks_ < kMaxWalks && walked_again_ <= kFreeRepeats + kMaxRepeats * total;
}

void Walk::include_one(const Visit& from, const IncludeName& name, Columns columns, std::uint32_t context) {
  std::string reason;
  const std::string spelled = parameters_.put_into_text(name.name);
  const std::uint32_t file = files.include(from.file, spelled, search_.folders(files.folder_of(from.file)), reason);
  states_.resize(files.files.size());
  if (file == FileSet::kNoFile) {
    warnings.note_each("missing-include", from.file, name.offset, "the include file " + name.name + " " + reason);
    return;
  }
  ++states_[file].uses;
  states_[from.file].includes.push_back(file);
  const auto warn = [&](const char* kind, const std::string& what) {
    warnings.note(kind, from.file, name.offset, "the include file " + name.name + " " + what);
  };
  if (states_[file].open) {
    warn("circular-include", "includes itself; it is read once");
  } else if (states_[file].walked.contains(context)) {
    if (states_[file].has_mesh) warn("repeated-include", "is included twice; its nodes can't be moved");
  } else if (from.depth >= kMaxIncludeDepth) {
    warn("deep-include", "is nested more than " + std::to_string(kMaxIncludeDepth) + " deep; it isn't read");
  } else if (!states_[file].walked.empty() && !may_walk_again(file)) {
    warn("too-many-includes", "is included too often to be shown at each place; it isn't read again");
  } else {
    if (!states_[file].walked.empty())
      warn("several-places", "is shown at several places, transformed differently; its nodes can't be moved, since all would move");
    walk_file({file, context, from.depth + 1}, columns);
  }
}

}  // namespace prismesh::mesh::deck::lsdyna
