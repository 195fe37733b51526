// A deck as it stands on disk: its text, kept word for word, and where in it each node's coordinates are, so that saving
// rewrites only what changed. Formats live in folders beside this header.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/progress.h"
#include "base/units.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

enum class Format : std::uint8_t { ls_dyna, nastran, radioss, abaqus };
std::string_view name(Format format);  ///< "ls-dyna", ...

/// Something odd that opened all the same. Each kind is reported once, with its first place and how often.
struct Warning {
  std::string file;
  long line = 0;
  std::string kind;  ///< a stable word: "missing-include", "undefined-node", "duplicate-node", ...
  std::string message;
  std::size_t count = 1;
};

/// Element cards of the deck by kind, those included whose nodes lack and that the model therefore leaves out. A shell
/// card with fewer than three nodes counts as the four-node form.
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
  ElementCounts& operator+=(const ElementCounts& more);
};

/// One file of the deck.
struct SourceFile {
  std::filesystem::path path;      ///< as opened
  std::filesystem::path relative;  ///< to the main file's folder; the main file: its name. May start with ".."
  FileBytes bytes;
};

/// How the columns of a run of node cards are cut.
enum class Columns : std::uint8_t { standard, i10, wide };

/// Nodes that follow each other in one file in one column layout (a card with commas is free format whatever the layout).
struct NodeRun {
  std::uint32_t first_node = 0;  ///< NodeIndex value of the first; runs ascend
  std::uint32_t file = 0;        ///< index into files
  Columns columns = Columns::standard;
};

struct OnDisk;  // mesh/deck/on_disk.h

/// Everything about the text that editing and saving need.
struct Deck {
  Format format = Format::ls_dyna;
  std::vector<SourceFile> files;  ///< main file first, includes in the order they are read
  std::vector<NodeRun> node_runs;
  std::vector<std::uint64_t> node_line;  ///< byte offset in its file of each node's card
  Hash128 content;                       ///< of all files' bytes and relative names
  ElementCounts element_cards;
  TimeStepControl time_step;
  std::vector<Warning> warnings;
  std::vector<std::string> missing_files;  ///< includes that weren't found, as written
  std::shared_ptr<OnDisk> on_disk;         ///< what saving in place has left on disk; never null after opening

  std::uint32_t run_of(NodeIndex node) const;  ///< index into node_runs
};

struct OpenedDeck {
  std::shared_ptr<const Deck> deck;
  Model model;  ///< complete, with adjacency
};

/// Opens a deck with its includes. Errors: not readable, not a deck (says what it looks like instead), a format that
/// this build doesn't read (named), a malformed card whose loss would matter (file and line).
Result<OpenedDeck> open(const std::filesystem::path& path, const Progress& progress = {});

struct SaveReport {
  std::size_t nodes_written = 0;
  std::size_t lines_changed = 0;
  std::vector<std::filesystem::path> files_written;
  std::vector<std::string> notes;  ///< fields that couldn't hold the full precision, ...
};

/// Writes the deck with the positions of `model` to `target`. Only cards of nodes whose position differs from the one in
/// the text are rewritten, in their own columns and style. To the deck's own path: changed files only, and refused if a
/// file on disk is no longer the one that was read. Elsewhere: all files, includes under their relative paths (one
/// outside the main file's folder is refused by name). Atomic (see replace_files).
/// `original` is the model as it was opened.
Result<SaveReport> save(const Deck& deck, const Model& original, const Model& model, const std::filesystem::path& target);

/// Guesses from densities and the median edge.
LengthUnit guess_length_unit(const Model& model);

}  // namespace prismesh::mesh::deck
