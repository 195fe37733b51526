#include "mesh/deck/abaqus/walk.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "mesh/deck/abaqus/pieces.h"
#include "mesh/deck/abaqus/placement.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

constexpr std::size_t kMaxWords = 60000;
constexpr std::string_view kOtherWord = "(another keyword)";

bool same_frame(const Frame& a, const Frame& b) { return a.kind == b.kind && a.to_basic.matrix() == b.to_basic.matrix(); }

/// Reads the data lines of a *PARAMETER; a name whose value is no plain number is forgotten.
void read_values(DeckOutline& outline, const Block& block) {
  for (std::uint32_t s = 0; s < block.segments; ++s) {
    const Segment& segment = outline.segments[block.first_segment + s];
    DataLines lines(outline.text(segment.file), segment.begin, segment.end);
    for (DataLine line; lines.next(line);) {
      const std::size_t equals = line.text.find('=');
      double value = 0;
      if (equals == std::string_view::npos || trim(line.text.substr(equals + 1)).empty()) continue;
      const std::string name(trim(line.text.substr(0, std::min<std::size_t>(equals, 100))));
      if (parse_real(trim(line.text.substr(equals + 1)), value))
        outline.values[name] = value;
      else
        outline.values.erase(name);
    }
  }
}

/// Indices of words, element types and groups in the outline, by name.
class NameTables {
 public:
  explicit NameTables(DeckOutline& outline) : outline_(outline) {}

  /// Beyond kMaxWords all new keywords share one.
  std::uint16_t word(const std::string& name) {
    if (outline_.words.empty()) add_word(std::string(kOtherWord));
    const auto at = words_.find(name);
    if (at != words_.end()) return at->second;
    return outline_.words.size() < kMaxWords ? add_word(name) : words_[std::string(kOtherWord)];
  }
  std::uint32_t type(const std::string& name) {
    const auto [at, added] = types_.try_emplace(name, static_cast<std::uint32_t>(outline_.types.size()));
    if (added) outline_.types.push_back({name, element_type(name)});
    return at->second;
  }
  std::uint32_t group(const Group& group) {
    const auto [at, added] = groups_.try_emplace(group, static_cast<std::uint32_t>(outline_.groups.size()));
    if (added) outline_.groups.push_back(group);
    return at->second;
  }

 private:
  std::uint16_t add_word(const std::string& name) {
    outline_.words.push_back(name);
    return words_[name] = static_cast<std::uint16_t>(outline_.words.size() - 1);
  }

  DeckOutline& outline_;
  std::map<std::string, std::uint16_t, std::less<>> words_;
  std::map<std::string, std::uint32_t, std::less<>> types_;
  std::map<Group, std::uint32_t> groups_;
};

/// A parameter that names files to read, of one keyword or (empty) of any.
/// Source: Abaqus Keywords Guide; for the last three CalculiX, "matrixassembles.f".
struct FileParameter {
  std::string_view word, parameter;
};
constexpr FileParameter kFileParameters[] = {
    {"", "FILE"}, {"INSTANCE", "LIBRARY"}, {"SUBSTRUCTURE COPY", "OLDLIBRARY"}, {"", "STIFFNESSFILE"}, {"", "MASSFILE"},
};

/// Whether FILE= of a keyword names what the solver writes.
bool is_output(std::string_view word, const Parameters& parameters) {
  return word.ends_with("OUTPUT") || word.ends_with("FILE") || word.ends_with("GENERATE") || word.ends_with("PRINT") ||
         parameters.has("WRITE");
}

/// Whether INPUT= of a keyword names a file with data lines. Others name results or matrices.
bool is_text_for(std::string_view word, const std::string& file) {
  static constexpr std::string_view kOthers[] = {"SUBMODEL", "CRACK PROPAGATION", "HCF", "VIEWFACTOR"};
  if (std::find(std::begin(kOthers), std::end(kOthers), word) != std::end(kOthers)) return false;
  const std::size_t point = file.rfind('.');
  const std::string ending = point == std::string::npos ? "" : label(file.substr(point));
  return ending != ".SIM" && ending != ".FRD" && ending != ".ODB" && ending != ".FIL";
}

/// What is done with the data lines of a keyword.
enum class DataUse { skip, keep, nodes, elements, system, instance, values };

/// The keyword whose data lines are being read.
struct OpenBlock {
  DataUse use = DataUse::skip;
  std::string name;
  Block block;
  MeshSegment mesh;           ///< nodes and elements: what their segments have in common
  bool mesh_is_held = false;  ///< nodes: in a system that can't be worked out
};

/// What the keywords so far say about where the next one stands.
struct Position {
  std::uint32_t scope = 0;
  std::uint32_t instance = kNone;
  Frame system;                ///< of the last *SYSTEM
  bool system_is_bad = false;  ///< its points span no system
};

class Walker {
 public:
  explicit Walker(FileSet files) : outline_(std::move(files)), names_(outline_) { note_new_files(); }

  Result<DeckOutline> run() {
    walk_file(0, 0);
    finish_block();
    if (Result<void> placed = place_instances(outline_); !placed) return fail(placed.error());
    return std::move(outline_);
  }

 private:
  // --- files ---

  void note_new_files() {
    const std::vector<SourceFile>& files = outline_.files.files;
    while (outline_.texts.size() < files.size()) outline_.texts.push_back(files[outline_.texts.size()].bytes.text());
    open_.resize(files.size());
    uses_.resize(files.size());
  }

  void walk_file(std::uint32_t file, int depth) {
    open_[file] = true;
    const std::string_view text = outline_.text(file);
    Keywords keywords(text);
    Keyword keyword;
    std::size_t data = 0;
    while (keywords.next(keyword)) {
      close_segment({file, data, keyword.begin});
      data = keyword.end;
      if (keyword.name != "INCLUDE") {
        begin_block(file, keyword, depth);
        continue;
      }
      const Parameters parameters(text, keyword.begin, keyword.end);
      if (const auto input = parameters.value("INPUT"))
        include(file, keyword.begin, *input, depth);
      else
        outline_.warnings.note("missing-include", file, keyword.begin,
                               "*INCLUDE without INPUT=, which names the file: no file is included");
    }
    close_segment({file, data, text.size()});
    open_[file] = false;
  }

  void include(std::uint32_t from, std::size_t offset, const std::string& name, int depth) {
    std::string reason;
    // Abaqus looks in the folder it was started in, which is the main file's.
    const std::filesystem::path folders[] = {outline_.files.folder_of(0), outline_.files.folder_of(from)};
    const std::uint32_t file = outline_.files.include(from, name, folders, reason);
    note_new_files();
    Warnings& warnings = outline_.warnings;
    if (file == FileSet::kNoFile)
      warnings.note_each("missing-include", from, offset, "the include file " + name + " " + reason);
    else if (open_[file])
      warnings.note("circular-include", from, offset, "the include file " + name + " includes itself; it is read once");
    else if (depth >= kMaxIncludeDepth)
      warnings.note("deep-include", from, offset,
                    "the include file " + name + " is nested more than " + std::to_string(kMaxIncludeDepth) + " deep; it isn't read");
    else if (uses_[file]++ > 0)
      warnings.note("repeated-include", from, offset, "the include file " + name + " is included again; it is read once");
    else
      walk_file(file, depth + 1);
  }

  // --- keywords with their data lines ---

  void begin_block(std::uint32_t file, const Keyword& keyword, int depth) {
    finish_block();
    const auto first_segment = static_cast<std::uint32_t>(outline_.segments.size());
    open_block_ = {DataUse::keep, keyword.name, {file, at_.scope, at_.instance, keyword.begin, keyword.end, first_segment, 0}, {}, false};
    const std::string& name = open_block_.name;
    const Parameters parameters = outline_.parameters(open_block_.block);
    if (name == "NODE") {
      begin_nodes(parameters);
    } else if (name == "ELEMENT") {
      begin_elements(parameters);
    } else if (name == "SYSTEM") {
      open_block_.use = DataUse::system;
    } else if (name == "PARAMETER") {
      open_block_.use = DataUse::values;
    } else if (name == "PART") {
      begin_part(parameters);
    } else if (name == "END PART") {
      at_.scope = 0;
      at_.system = {};
    } else if (name == "INSTANCE") {
      begin_instance(parameters);
    } else if (name == "END INSTANCE") {
      at_.instance = kNone;
      at_.scope = 0;
    }
    const bool is_mesh = open_block_.use == DataUse::nodes || open_block_.use == DataUse::elements;
    const auto input = parameters.value("INPUT");
    if (input && (is_mesh || name == "NSET" || name == "ELSET"))
      include(file, keyword.begin, *input, depth);
    else if (input && is_text_for(name, *input))
      read_data_file(file, keyword, *input);
    else if (input)
      accompany(file, keyword, *input, {""});
    for (const FileParameter& each : kFileParameters)
      if (each.word.empty() || each.word == name)
        if (const auto value = parameters.value(each.parameter); value && !is_output(name, parameters))
          accompany(file, keyword, *value, {"", ".fil", ".odb", ".sim", ".prt", ".res", ".mdl", ".stt"});
  }

  /// Takes a keyword's data lines from a file. It may name nodes and elements, so it is read like an include.
  void read_data_file(std::uint32_t from, const Keyword& keyword, const std::string& name) {
    std::string reason;
    const std::filesystem::path folders[] = {outline_.files.folder_of(0), outline_.files.folder_of(from)};
    const std::uint32_t file = outline_.files.include(from, name, folders, reason);
    note_new_files();
    if (file == FileSet::kNoFile)
      return outline_.warnings.note_each("missing-include", from, keyword.begin,
                                         "the file " + name + ", which *" + keyword.name + " takes its data from, " + reason);
    outline_.data_uses.resize(outline_.files.files.size());
    ++outline_.data_uses[file];
    close_segment({file, 0, outline_.text(file).size()});
  }

  /// Notes files that the solver reads and that name nothing by number: results of other runs, matrices. With one of the endings at least
  /// one must be there.
  void accompany(std::uint32_t from, const Keyword& keyword, const std::string& name, std::span<const std::string_view> endings) {
    std::string reason, last;
    bool found = false;
    const std::filesystem::path folders[] = {outline_.files.folder_of(0), outline_.files.folder_of(from)};
    for (const std::string_view ending : endings) {
      found |= outline_.files.accompany(name + std::string(ending), folders, last);
      if (reason.empty()) reason = last;
    }
    if (!found)
      outline_.warnings.note_each("missing-file", from, keyword.begin,
                                  "the file " + name + ", which *" + keyword.name + " names, " + reason);
  }
  void accompany(std::uint32_t from, const Keyword& keyword, const std::string& name, std::initializer_list<std::string_view> endings) {
    accompany(from, keyword, name, std::span(endings.begin(), endings.size()));
  }

  void close_segment(const Segment& segment) {
    if (segment.begin >= segment.end || open_block_.use == DataUse::skip) return;
    if (open_block_.use == DataUse::nodes || open_block_.use == DataUse::elements) {
      MeshSegment mesh = open_block_.mesh;
      mesh.begin = segment.begin;
      mesh.end = segment.end;
      add_mesh(outline_.pieces, {segment.file, at_.scope, at_.instance, open_block_.mesh_is_held, {}}, mesh, outline_.text(segment.file));
      return;
    }
    outline_.segments.push_back(segment);
    ++open_block_.block.segments;
  }

  void finish_block() {
    const DataUse use = std::exchange(open_block_.use, DataUse::skip);
    const Block& block = open_block_.block;
    if (use == DataUse::keep) outline_.kept.push_back({names_.word(open_block_.name), block});
    if (use == DataUse::system) read_system(block);
    if (use == DataUse::instance) read_instance(block);
    if (use == DataUse::values) read_values(outline_, block);
    if (use == DataUse::system || use == DataUse::instance || use == DataUse::values) outline_.segments.resize(block.first_segment);
  }

  void begin_nodes(const Parameters& parameters) {
    open_block_.use = DataUse::nodes;
    open_block_.mesh.nodes = true;
    open_block_.mesh_is_held = at_.system_is_bad;
    Frame frame = at_.system;
    if (const auto system = parameters.value("SYSTEM")) frame.kind = frame_kind(*system);
    std::vector<Frame>& frames = outline_.frames;
    if (!same_frame(frames.back(), frame)) frames.push_back(frame.is_basic() ? Frame() : frame);
    open_block_.mesh.frame = frame.is_basic() ? 0 : static_cast<std::uint32_t>(frames.size() - 1);
  }

  void begin_elements(const Parameters& parameters) {
    const Block& block = open_block_.block;
    const auto named = parameters.value("TYPE");
    if (!named || named->empty()) {
      open_block_.use = DataUse::skip;
      outline_.warnings.note("unread-elements", block.file, block.begin,
                             "*ELEMENT without TYPE=: the elements that follow aren't shown; their text is kept");
      return;
    }
    open_block_.use = DataUse::elements;
    const std::string type = label(named->substr(0, 80));
    open_block_.mesh.type = names_.type(type);
    open_block_.mesh.group = names_.group({at_.scope, label(parameters.value("ELSET").value_or(""))});
    std::int64_t offset = 0;
    if (const auto by = parameters.value("OFFSET"); by && parse_integer(*by, offset)) outline_.offset_elements.push_back({block, offset});
    const ElementType& known = outline_.types[open_block_.mesh.type].type;
    if (known.element_class == ElementClass::shell && !known.is_shell_section)
      outline_.warnings.note("shown-as-shells", block.file, block.begin,
                             "elements of type " + type + " (membranes, surfaces or rigid facets) are shown as shells");
  }

  void read_system(const Block& block) {
    const std::optional<Eigen::Affine3d> system = system_of(outline_, block);
    at_.system_is_bad = !system;
    at_.system = {};
    if (system)
      at_.system.to_basic = *system;
    else
      outline_.warnings.note(
          "unread-system", block.file, block.begin,
          "the points of this *SYSTEM span no coordinate system; nodes in it are shown as if it weren't there, and can't be moved");
  }

  // --- parts and instances ---

  std::uint32_t add_scope(const std::string& name) {
    outline_.scopes.push_back({name, open_block_.block.begin, open_block_.block.file, {}});
    return static_cast<std::uint32_t>(outline_.scopes.size() - 1);
  }

  void begin_part(const Parameters& parameters) {
    open_block_.use = DataUse::skip;
    const std::string name = label(parameters.value("NAME").value_or(""));
    at_ = {add_scope(name), at_.instance, {}, false};
    if (!scope_by_name_.try_emplace(name, at_.scope).second)
      outline_.warnings.note("duplicate-part", open_block_.block.file, open_block_.block.begin,
                             "the part " + name + " is defined again; its first definition counts");
  }

  void begin_instance(const Parameters& parameters) {
    Block& block = open_block_.block;
    open_block_.use = DataUse::instance;
    const std::string name = label(parameters.value("NAME").value_or(""));
    const auto part = parameters.value("PART");
    const auto at = part ? scope_by_name_.find(label(*part)) : scope_by_name_.end();
    if (at == scope_by_name_.end()) {
      outline_.warnings.note_each("unread-instance", block.file, block.begin,
                                  "the instance " + name + " is of no part of this deck, so it isn't shown; it is kept as it is");
      // What it holds itself has ids of its own.
      at_.scope = add_scope(name);
    } else {
      at_.scope = at->second;
    }
    at_.instance = static_cast<std::uint32_t>(outline_.instances.size());
    outline_.instances.push_back({name, at_.scope, Eigen::Affine3d::Identity(), 0});
    outline_.instance_by_name.try_emplace(name, at_.instance);
    outline_.scopes[at_.scope].instances.push_back(at_.instance);
    block.instance = at_.instance;
  }

  void read_instance(const Block& block) {
    Instance& instance = outline_.instances[block.instance];
    if (const std::optional<Eigen::Affine3d> place = instance_place(outline_, block))
      instance.to_basic = *place;
    else
      outline_.warnings.note("unread-instance", block.file, block.begin,
                             "where the instance " + instance.name + " stands can't be made out; it is shown where its part stands");
  }

  DeckOutline outline_;
  NameTables names_;
  Position at_;
  OpenBlock open_block_;
  std::vector<bool> open_;           ///< by file: it is being walked
  std::vector<std::uint32_t> uses_;  ///< by file
  std::map<std::string, std::uint32_t, std::less<>> scope_by_name_;
};

}  // namespace

Result<DeckOutline> walk(FileSet files) { return Walker(std::move(files)).run(); }

}  // namespace prismesh::mesh::deck::abaqus
