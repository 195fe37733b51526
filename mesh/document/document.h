// A document: a deck, its settings, and generations of (model + selection + part states). See docs/architecture.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/deck.h"
#include "mesh/deck/staged_save.h"
#include "mesh/document/edit.h"
#include "mesh/quality/mass.h"
#include "mesh/quality/report.h"

namespace prismesh::mesh::document {

struct Settings {
  LengthUnit length_unit = LengthUnit::mm;
  bool length_unit_guessed = true;
  double target_size = 1;
  bool target_size_guessed = true;
  quality::Criteria criteria;
};

struct OpenOptions {
  std::optional<LengthUnit> length_unit;
  std::optional<double> target_size;
  std::optional<std::filesystem::path> criteria;
  std::optional<quality::Criteria> judged_by;        ///< goes before `criteria`; the deck still has its say on the time step
  std::size_t history_bytes = std::size_t{2} << 30;  ///< cap on what old generations hold for themselves
  Progress progress;
};

struct PartState {
  bool hidden = false;
  bool locked = false;  ///< its nodes don't move
  bool operator==(const PartState&) const = default;
};

/// Bits of Generation::node_marks. The last two follow from the part states.
enum NodeMark : std::uint8_t {
  kSelected = 1,
  kLocked = 2,  ///< an element of a locked part uses the node
  kHidden = 4,  ///< elements use the node, all of hidden parts
};

struct Surroundings;  // mesh/document/surroundings.h

/// The document after an edit. A value that shares what it didn't change with its neighbours.
struct Generation {
  Model model;
  ChunkedArray<std::uint8_t> node_marks;   ///< NodeMark bits
  ChunkedArray<std::uint8_t> shell_marks;  ///< selected shells, when elements or parts were selected
  select::Kind selection_kind = select::Kind::node;
  std::size_t selected_nodes = 0;
  std::size_t selected_shells = 0;
  std::shared_ptr<const std::vector<PartState>> parts;  ///< by PartIndex
  /// The surface that relaxing and repairing hold nodes on: the model as it was opened or last shaped. Never null once opened.
  std::shared_ptr<const Model> surface;
  std::shared_ptr<const Surroundings> around;  ///< what the deck says besides the mesh; never null once opened
  ChunkedArray<quality::ShellState> quality;
  quality::Counts counts;     ///< all shells
  quality::Weight weight;     ///< of all shells; kept up with each edit, so its last digits tell of the way here
  std::uint64_t number = 0;   ///< counts up over the document's life, never reused
  std::string made_by;        ///< the edit's name; "open" for the first
  std::size_t own_bytes = 0;  ///< of chunks that the generation before doesn't share: what keeping that one costs
};

NodeSet selection(const Generation& generation);

struct EditReport {
  std::string edit;
  std::size_t nodes_moved = 0;
  std::size_t elements_added = 0;
  std::size_t elements_removed = 0;
  quality::Counts before;
  quality::Counts after;
  // of edits that move nodes:
  std::size_t inverted = 0;           ///< shells that it turned over or folded (docs/shaping.md)
  std::size_t lost_connections = 0;   ///< nodes that lay on a sheet and no longer do (docs/connections.md)
  std::vector<std::string> lost;      ///< the first hundred of them, a sentence each
  std::optional<double> mass_before;  ///< of the shells whose mass is known; absent if none is
  std::optional<double> mass_after;
  std::optional<std::array<double, 3>> centre_before;  ///< of gravity
  std::optional<std::array<double, 3>> centre_after;
  std::vector<std::string> notes;
  double milliseconds = 0;
};

struct Document {
  std::filesystem::path path;
  std::shared_ptr<const deck::Deck> deck;
  Settings settings;
  std::size_t history_bytes = std::size_t{2} << 30;
  std::vector<std::shared_ptr<const Generation>> generations;  ///< oldest first; what undo and redo walk
  std::size_t cursor = 0;                                      ///< the current one
  std::shared_ptr<const Generation> opened;                    ///< as read from the deck; what saving compares with
  std::uint64_t next_number = 1;

  const Generation& current() const { return *generations[cursor]; }
  bool can_undo() const { return cursor > 0; }
  bool can_redo() const { return cursor + 1 < generations.size(); }
};

/// Opens a deck: model, guessed or given settings, quality of every shell. Errors: those of deck::open and load_criteria, a
/// target size that isn't positive.
Result<Document> open(const std::filesystem::path& path, const OpenOptions& options);
/// A document of a deck that is open already.
Result<Document> open(const std::filesystem::path& path, deck::OpenedDeck opened, const OpenOptions& options);

/// What an edit would do, before anyone knows of it: so that it can be journalled first.
struct Prepared {
  std::shared_ptr<const Generation> next;  ///< for undo and redo: the generation gone to
  enum class Step : std::uint8_t { push, undo, redo } step = Step::push;
  std::size_t drop_oldest = 0;  ///< generations that go when this one comes, so that the history keeps its byte cap
  EditReport report;
};

/// Works the edit out on the current generation; the document doesn't change. Deterministic. Errors: expression:column,
/// nothing selected, a locked or held node would move (named), nothing to undo, cancelled. `progress` hears of relax and repair, which may
/// take long; the other edits don't look at it.
Result<Prepared> prepare(const Document& document, const Edit& edit, const Progress& progress = {});
/// Makes it the current generation; drops redo and, over the byte cap, the oldest generations. Can't fail.
void commit(Document& document, Prepared prepared);
/// prepare, then commit.
Result<EditReport> apply(Document& document, const Edit& edit, const Progress& progress = {});

/// Saves the current generation (deck::save).
Result<deck::SaveReport> save(const Document& document, const std::filesystem::path& target, const Progress& progress = {});
/// The same up to the point where files are replaced; its report is complete. The document's deck must outlive it.
Result<deck::StagedSave> stage_save(const Document& document, const std::filesystem::path& target, const Progress& progress = {});

}  // namespace prismesh::mesh::document
