#include "mesh/deck/radioss/walk.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "mesh/deck/radioss/companion_files.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

namespace fs = std::filesystem;

/// Limit of the text that submodels include again.
constexpr std::size_t kMaxRepeatedBytes = std::size_t{1} << 27;
constexpr std::size_t kMaxIncludeLength = 4096;
constexpr std::size_t kMaxContexts = 100000;
constexpr int kMaxEngineFiles = 100;
constexpr std::int64_t kMaxOffset = 9'999'999'999;  ///< what ten columns hold

/// The next line at or after the start of a line `at` that begins with a slash or a hash; the text's size if there is none.
std::size_t next_mark(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    if (text[at] == '/' || text[at] == '#') return at;
    const void* end = std::memchr(text.data() + at, '\n', text.size() - at);
    if (!end) break;
    at = static_cast<std::size_t>(static_cast<const char*>(end) - text.data()) + 1;
  }
  return text.size();
}

std::size_t next_line(std::string_view text, std::size_t at) { return std::min(text.find('\n', at), text.size() - 1) + 1; }

}  // namespace

Walk::Walk(FileSet found) : files(std::move(found)), main_folder_(files.folder_of(0)) {}

void Walk::run() {
  states_.resize(1);
  states_[0].uses = 1;
  walked_.insert({0, 0});
  walk_file(0, 0);
  finish_block();
  if (context_ != 0)
    warnings.note("open-submodel", contexts[context_].file, contexts[context_].offset, "the submodel isn't closed by //ENDSUB");
  // A file that is used twice, and what it includes, stands for more than one place.
  std::vector<const FileUse*> uses;
  for (const FileState& state : states_) uses.push_back(&state);
  held = repeated_files(uses);
  find_engine_files();
}

void Walk::walk_file(std::uint32_t file, int depth) {
  states_[file].open = true;
  ended_ = false;
  stretch_ = {file, 0, 0};
  std::size_t at = 0;
  while (!ended_) {
    const std::string_view text = files.files[file].bytes.text();
    at = next_mark(text, at);
    if (at >= text.size()) break;
    const std::size_t after = next_line(text, at);
    if (text[at] == '/') {
      close_stretch(at);
      keyword(file, at);
      stretch_ = {file, after, after};
    } else if (is_include(text.substr(at))) {
      close_stretch(at);
      include(file, at, depth);
      ended_ = false;
      stretch_ = {file, after, after};
    } else if (text.substr(at).starts_with(kEndOfData)) {
      close_stretch(at);
      stretch_ = {file, at, at};
      ended_ = true;
    }
    at = after;
  }
  if (!ended_) close_stretch(files.files[file].bytes.text().size());
  states_[file].open = false;
}

void Walk::close_stretch(std::size_t end) {
  stretch_.end = end;
  if (!in_block_) return;
  if (first_stretch_)
    block_.body = stretch_;
  else if (end > stretch_.begin)
    block_.more.push_back(stretch_);
  first_stretch_ = false;
}

void Walk::keyword(std::uint32_t file, std::size_t offset) {
  finish_block();
  const std::string_view text = files.files[file].bytes.text();
  keyword_ = keyword_at(text, offset);
  const std::string_view word = keyword_.word(0);
  if (word == "END" && keyword_.word(1) != "ENGINE") {
    ended_ = true;
    return;
  }
  if (word == "END") {
    // In a deck for both programs the engine's options come first; they name nothing.
    blocks.clear();
    return;
  }
  if (word == "ENDSUB") return end_submodel(file, offset);
  block_ = Block{file, context_, offset, {file, offset, offset}, {}};
  in_block_ = first_stretch_ = true;
}

void Walk::finish_block() {
  if (!in_block_) return;
  in_block_ = false;
  if (keyword_.word(0) == "SUBMODEL") {
    begin_submodel(block_, keyword_);
  } else {
    if (keyword_.word(0) == "BEGIN") read_begin(block_);
    find_files(block_, keyword_);
    blocks.push_back(std::move(block_));
  }
}

/// The files that a block names besides #include.
void Walk::find_files(const Block& block, const Keyword& keyword) {
  const std::vector<fs::path> folders = {main_folder_, files.folder_of(block.file)};
  std::string reason;
  for (const NamedFile& named : named_files(files.files, block, keyword)) {
    if (named.is_mesh) {
      if (files.include_unread(block.file, named.name, folders, keyword.joined(), reason) == FileSet::kNoFile)
        warnings.note_each("missing-include", block.file, named.offset, "the include file " + named.name + " " + reason);
      else
        warnings.note_each("unread-include", block.file, named.offset,
                           "/" + keyword.joined() + " isn't read in this version; what the file " + named.name +
                               " holds isn't shown and is kept as it is");
      states_.resize(files.files.size());
    } else if (!files.accompany(named.name, folders, reason) && named.is_certain) {
      warnings.note_each("missing-file", block.file, named.offset,
                         "the file " + named.name + ", which /" + keyword.joined() + " names, " + reason);
    }
  }
}

/// The engine's input has the starter's name with another number. The starter looks into it, and both run together.
void Walk::find_engine_files() {
  const std::string name = files.files[0].path.filename().string();
  const std::size_t at = name.rfind("_0000.rad");
  if (at == std::string::npos || at + 9 != name.size()) return;
  const std::vector<fs::path> folders = {main_folder_};
  std::string reason;
  for (int run = 1; run <= kMaxEngineFiles; ++run) {
    const std::string number = std::to_string(run);
    if (!files.accompany(name.substr(0, at) + "_" + std::string(4 - number.size(), '0') + number + ".rad", folders, reason)) return;
  }
}

void Walk::begin_submodel(const Block& block, const Keyword& keyword) {
  if (contexts.size() >= kMaxContexts) return;
  if (contexts[context_].depth >= kMaxIncludeDepth) {
    warnings.note(
        "deep-submodel", block.file, block.offset,
        "submodels stand in each other more than " + std::to_string(kMaxIncludeDepth) + " deep; what follows is read as part of the last");
    return;
  }
  Context context;
  context.depth = contexts[context_].depth + 1;
  context.id = keyword.number(0);
  context.unit = keyword.number(1);
  context.parent = context_;
  context.file = block.file;
  context.offset = block.offset;
  context.version = contexts[context_].version;
  context.added = contexts[context_].added;
  // "/V130" behind the numbers.
  const std::string_view text = files.files[block.file].bytes.text();
  std::string_view line = text.substr(block.offset, std::min(text.find_first_of("\r\n", block.offset), text.size()) - block.offset);
  line = trim(line.substr(0, 200));
  const std::size_t v = line.rfind('/');
  std::int64_t version = 0;
  if (v + 2 < line.size() && (line[v + 1] == 'V' || line[v + 1] == 'v') && parse_integer(line.substr(v + 2), version) && version > 0)
    context.version = version;
  BlockLines lines(files.files, block);
  Line card;
  if (lines.next(card) && lines.next(card)) {
    std::array<std::int64_t, 6> offsets{};
    for (std::size_t f = 0; f < offsets.size(); ++f) {
      std::int64_t value = 0;
      if (parse_integer(trim(field(card.text, context.field_width(), f)), value) && std::abs(value) <= kMaxOffset) offsets[f] = value;
      if (f > 0 && offsets[f] == 0) offsets[f] = offsets[0];
    }
    context.added.set += offsets[0];
    context.added.function += offsets[0];
    context.added.define += offsets[0];
    context.added.node += offsets[1];
    context.added.element += offsets[2];
    context.added.part += offsets[3];
    context.added.material += offsets[4];
    context.added.other += offsets[5];
  }
  if (context_ != 0)
    warnings.note("nested-submodel", block.file, block.offset, "a submodel stands in another one; what both add to ids is added up");
  contexts.push_back(context);
  context_ = static_cast<std::uint32_t>(contexts.size() - 1);
}

void Walk::end_submodel(std::uint32_t file, std::size_t offset) {
  if (context_ == 0) warnings.note("open-submodel", file, offset, "//ENDSUB stands here without a //SUBMODEL");
  context_ = contexts[context_].parent;
}

/// In an included file the card applies only within a submodel.
void Walk::read_begin(const Block& block) {
  Context& context = contexts[block.context];
  if (context.has_begin || (block.context == 0 && block.file != 0)) return;
  context.has_begin = true;
  BlockLines lines(files.files, block);
  Line line;
  if (!lines.next(line) || !lines.next(line)) return;
  std::int64_t version = 0;
  const std::string_view card = trim(line.text);
  if (parse_integer(card.substr(0, card.find(' ')), version) && version > 0) context.version = version;
  if (!lines.next(line)) return;
  const std::size_t width = context.field_width();
  const auto mass = unit_factor(field(line.text, width, 0, 2), 'g');
  const auto length = unit_factor(field(line.text, width, 2, 2), 'm');
  const auto time = unit_factor(field(line.text, width, 4, 2), 's');
  if (mass && length && time) context.units = Units{*mass, *length, *time};
}

void Walk::include(std::uint32_t from, std::size_t offset, int depth) {
  const std::string_view text = files.files[from].bytes.text();
  std::string_view line = text.substr(offset, std::min(text.find_first_of("\r\n", offset), text.size()) - offset);
  const std::string name(trim(line.substr(8, kMaxIncludeLength)));
  // Names are relative to the folder where the solver is started, usually that of the main file. Else the file's own folder is searched.
  const std::vector<fs::path> folders = {main_folder_, files.folder_of(from)};
  std::string reason;
  const std::uint32_t file = files.include(from, name, folders, reason);
  states_.resize(files.files.size());
  if (file == FileSet::kNoFile) {
    warnings.note_each("missing-include", from, offset, "the include file " + name + " " + reason);
    return;
  }
  states_[from].includes.push_back(file);
  ++states_[file].uses;
  const std::size_t bytes = files.files[file].bytes.text().size();
  // The include may stand behind the keyword of a submodel, which must be known before the included text.
  if (in_block_ && keyword_.word(0) == "SUBMODEL") finish_block();
  if (states_[file].open) {
    warnings.note("circular-include", from, offset, "the include file " + name + " includes itself; it is read once");
  } else if (depth >= kMaxIncludeDepth) {
    warnings.note("deep-include", from, offset,
                  "the include file " + name + " is nested more than " + std::to_string(kMaxIncludeDepth) + " deep; it isn't read");
  } else if (!walked_.insert({file, context_}).second) {
    warnings.note("repeated-include", from, offset, "the include file " + name + " is included twice; its nodes can't be moved");
  } else if (states_[file].uses > 1 && (repeated_bytes_ += bytes) > kMaxRepeatedBytes) {
    warnings.note("repeated-include", from, offset, "the include file " + name + " is used too often; it isn't read here");
  } else {
    walk_file(file, depth + 1);
  }
}

}  // namespace prismesh::mesh::deck::radioss
