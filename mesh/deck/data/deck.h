// A deck: the text of its files, word for word, and where the card of each node and shell stands in it, so that saving rewrites only what
// changed.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/units.h"
#include "mesh/deck/data/frame.h"
#include "mesh/deck/data/taken_ids.h"
#include "mesh/model/contact_cards.h"
#include "mesh/model/model.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck {

enum class Format : std::uint8_t { ls_dyna, nastran, radioss, abaqus };
std::string_view name(Format format);  ///< "ls-dyna", ...

/// Something odd in a deck that could be opened. Each kind is reported once, with its first place and a count.
struct Warning {
  std::string file;
  long line = 0;
  std::string kind;  ///< a stable word: "missing-include", "undefined-node", "duplicate-node", ...
  std::string message;
  std::size_t count = 1;
};

/// Element cards by kind. A shell card with fewer than three nodes counts as a quad.
struct ElementCounts {
  std::size_t quad = 0;
  std::size_t tri = 0;
  std::size_t quad8 = 0;
  std::size_t tri6 = 0;
  std::size_t beam = 0;
  std::size_t solid = 0;
  std::size_t tshell = 0;
  std::size_t other = 0;  ///< springs, masses, particles, belts, ...

  std::size_t shells() const { return quad + tri + quad8 + tri6; }
  std::size_t all() const { return shells() + beam + solid + tshell + other; }
  std::size_t& of_shell(bool is_triangle, bool has_midside);
  std::size_t& of(ElementClass element_class);  ///< shells: quads
  ElementCounts& operator+=(const ElementCounts& more);
  /// Without those in `fewer`; where there are more of these, 0.
  ElementCounts without(const ElementCounts& fewer) const;
};

/// One file of the deck.
struct SourceFile {
  std::filesystem::path path;      ///< as opened
  std::filesystem::path relative;  ///< to the main file's folder; the main file: its name. May start with ".."
  FileBytes bytes;
};

/// A file that a card names and that isn't deck text: a table, a curve, results of another run. Saving elsewhere copies it.
struct CompanionFile {
  std::filesystem::path path;      ///< as found
  std::filesystem::path relative;  ///< as SourceFile::relative
};

/// A file with text for the solver that isn't read, though it may hold nodes and elements.
struct UnreadFile {
  std::uint32_t file = 0;  ///< index into files
  std::string keyword;     ///< of the first card that names it
};

/// What is added to the ids in a file's text to get those of the model (LS-DYNA's *INCLUDE_TRANSFORM, Radioss's //SUBMODEL). Includes what
/// the files around it add.
struct IdOffsets {
  std::int64_t node = 0;
  std::int64_t element = 0;
  std::int64_t part = 0;
  std::int64_t material = 0;
  std::int64_t set = 0;
  std::int64_t function = 0;
  std::int64_t define = 0;  ///< everything under *DEFINE except functions
  std::int64_t other = 0;   ///< sections, hourglass controls, ...
  bool operator==(const IdOffsets&) const = default;
};

/// Consecutive nodes or shells in one file, of one style and one frame.
struct CardRun {
  std::uint32_t first = 0;  ///< index of the first node or shell; runs ascend
  std::uint32_t file = 0;   ///< index into files
  std::uint16_t style = 0;  ///< layout of their cards, in a code of the format's own
  std::uint32_t frame = 0;  ///< index into frames and id_offsets
  bool operator==(const CardRun&) const = default;
};

/// Elements whose cards are in the deck, but which the model leaves out: a node of theirs isn't defined, or their id is defined before. The
/// solver may use them, so edits keep their nodes and their edges.
struct HiddenElements {
  struct Card {
    ElementClass element_class = ElementClass::other;
    std::int64_t id = 0;
    std::uint32_t file = 0;    ///< index into files
    std::uint64_t offset = 0;  ///< of the card
  };
  std::vector<Card> cards;
  std::vector<std::uint32_t> first_node{0};  ///< the nodes of element e are nodes[first_node[e] .. first_node[e+1])
  std::vector<NodeIndex> nodes;              ///< those that are defined

  std::size_t size() const { return cards.size(); }
  std::span<const NodeIndex> nodes_of(std::size_t e) const { return {nodes.data() + first_node[e], nodes.data() + first_node[e + 1]}; }
};

/// The largest ids of a file's nodes and shells, as in the model; 0: it has none.
struct LastIds {
  std::int64_t node = 0;
  std::int64_t shell = 0;
};

struct OnDisk;  // mesh/deck/data/on_disk.h

/// What editing and saving need to know about the text.
struct Deck {
  Format format = Format::ls_dyna;
  std::vector<SourceFile> files;       ///< main file first, includes in the order they are read
  std::vector<Frame> frames{Frame()};  ///< [0]: the basic system
  std::vector<IdOffsets> id_offsets;   ///< by frame; frames beyond its end have none
  std::vector<CardRun> node_runs;
  std::vector<std::uint64_t> node_line;  ///< byte offset in its file of each node's card
  std::vector<CardRun> shell_runs;
  std::vector<std::uint64_t> shell_line;        ///< byte offset in its file of each shell's card
  Hash128 content;                              ///< of all files' bytes and relative names
  std::vector<LastIds> last_ids;                ///< by file
  std::vector<std::int64_t> left_out_elements;  ///< ids of element cards that aren't in the model, ascending; new elements can't have them
  HiddenElements hidden;                        ///< what element cards that aren't in the model have of its nodes
  std::vector<std::int64_t> shared_shell_ids;   ///< ids that two shells of the model have (Model::second_shells), ascending
  std::vector<std::uint32_t> held_files;        ///< files that stand for several places, ascending; their cards must not change
  ElementCounts element_cards;
  ElementCounts left_out_cards;  ///< of these, cards that the model leaves out: undefined or missing nodes, an id that is defined again
  std::map<std::string, std::size_t, std::less<>> element_kinds;  ///< cards by the deck's own word: "CQUAD4", "SHELL_THICKNESS", "S4R"
  std::shared_ptr<const References> references;                   ///< cards that name entities; never null after opening
  TimeStepControl time_step;
  ContactCards contacts;                  ///< of LS-DYNA and Radioss decks
  std::optional<LengthUnit> length_unit;  ///< nullopt: the deck doesn't give it
  TakenIds taken;                         ///< united
  std::vector<CompanionFile> companions;
  std::vector<UnreadFile> unread_files;
  std::vector<Warning> warnings;
  std::vector<std::string> missing_files;  ///< includes that weren't found, as written
  std::shared_ptr<OnDisk> on_disk;         ///< never null after opening

  bool shares_id(std::int64_t shell) const { return std::binary_search(shared_shell_ids.begin(), shared_shell_ids.end(), shell); }
  bool is_held(std::uint32_t file) const { return std::binary_search(held_files.begin(), held_files.end(), file); }
  const CardRun& run_of(NodeIndex node) const;
  const CardRun& run_of(ShellIndex shell) const;
  const SourceFile& file_of(NodeIndex node) const { return files[run_of(node).file]; }
  /// What is added to the ids on its cards to get those of the model.
  IdOffsets offsets_of(const CardRun& run) const { return run.frame < id_offsets.size() ? id_offsets[run.frame] : IdOffsets(); }
  /// What an include adds to the ids of a file's text; nullopt: it differs from place to place, or the file has no mesh to tell it by.
  std::optional<IdOffsets> offsets_in(std::uint32_t file) const;
};

/// Files that are read in place of others, by the others' canonical_name.
using StandIns = std::map<std::string, std::filesystem::path>;

}  // namespace prismesh::mesh::deck
