// What clients and modeld say to each other: plain structs, one JSON definition each (messages_json.cpp). One message a line.
// docs/protocol.md describes them for other programs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mesh/deck/deck.h"
#include "mesh/document/document.h"
#include "mesh/document/edit.h"

namespace prismesh::ipc {

inline constexpr int kProtocolVersion = 1;

// --- requests; every one carries a number that its answer repeats ---
struct Hello {
  int protocol = kProtocolVersion;
  std::string program;
};
struct Open {
  std::string path;
  std::optional<std::string> length_unit;
  std::optional<double> target_size;
  std::optional<std::string> criteria;
};
struct Save {
  std::optional<std::string> path;  ///< absent: the deck's own
};
struct Close {
  bool discard = false;  ///< false: refused while there are unsaved edits
};
struct ApplyEdit {
  mesh::document::Edit edit;
};
struct BeginDrag {
  mesh::document::Edit edit;  ///< translate, lift, slide or rotate; the displacement is ignored
};
struct DragStep {  ///< no answer; the preview shows it
  std::uint64_t drag = 0;
  std::uint64_t sequence = 0;
  std::array<double, 3> by{};
  double distance = 0;
  double degrees = 0;
};
struct CommitDrag {
  std::uint64_t drag = 0;
};
struct CancelDrag {
  std::uint64_t drag = 0;
};
struct Count {  ///< what an id expression names; selects nothing
  std::string expr;
  mesh::select::Kind kind = mesh::select::Kind::node;
};
struct GetState {};
struct GetSnapshot {
  std::vector<std::uint64_t> have_segments;  ///< segments the client still has mapped
};
struct ReturnSnapshot {  ///< no answer
  std::uint64_t lease = 0;
};

using Request = std::variant<Hello, Open, Save, Close, ApplyEdit, BeginDrag, DragStep, CommitDrag, CancelDrag, Count, GetState, GetSnapshot,
                             ReturnSnapshot>;

// --- answers ---
struct Failed {
  std::string file;
  long line = 0;
  std::string message;
};
struct Done {};
struct Welcome {
  int protocol = kProtocolVersion;
  std::string version;
  std::uint64_t client = 0;
};
/// A file of the deck that holds elements, and the parts that these belong to.
struct DeckFile {
  std::string name;  ///< as `file:NAME` in an expression means it
  std::uint64_t shells = 0;
  std::vector<std::int64_t> parts;  ///< ids, ascending
};
struct State {
  bool open = false;
  bool busy = false;
  std::string path;
  std::string length_unit;
  bool length_unit_guessed = false;
  double target_size = 0;
  bool target_size_guessed = false;
  std::uint64_t generation = 0;
  std::uint64_t nodes = 0, shells = 0, parts = 0;
  std::uint64_t selected_nodes = 0;
  mesh::quality::Counts counts;
  bool can_undo = false, can_redo = false, changed = false;
  std::uint64_t recovered_edits = 0;   ///< brought back from the journal when the document was opened
  std::uint64_t journalled_edits = 0;  ///< acknowledged since the deck was opened or last saved in place: what a restart brings back
  std::uint64_t history_bytes = 0, history_cap = 0;  ///< what the states kept for undo and redo take, and may take
  std::vector<DeckFile> files;
  std::vector<mesh::deck::Warning> warnings;
};
struct Saved {
  std::string path;
  std::uint64_t nodes_written = 0, lines_changed = 0;
  std::vector<std::string> notes;
};
struct Edited {
  mesh::document::EditReport report;
  std::uint64_t generation = 0;
};
struct Counted {
  std::uint64_t nodes = 0, shells = 0, parts = 0;
};
struct DragBegun {  ///< descriptor: the preview
  std::uint64_t drag = 0;
  std::uint64_t base_generation = 0;
  std::uint64_t nodes = 0;
  std::int64_t grab = 0;  ///< node id
  std::array<double, 3> grab_position{};
  std::array<double, 3> normal{};
};
struct Snapshot {  ///< descriptors: the table, then the segments listed in new_segments
  std::uint64_t lease = 0;
  std::uint64_t generation = 0;
  std::vector<std::uint64_t> segments;      ///< all that the table uses, in the table's order
  std::vector<std::uint64_t> new_segments;  ///< those that ride with this message, in this order
};
using Answer = std::variant<Failed, Done, Welcome, State, Saved, Edited, Counted, DragBegun, Snapshot>;

// --- events; sent to every client ---
struct GenerationPublished {
  std::uint64_t generation = 0;
  std::string made_by;
  std::uint64_t history_bytes = 0, history_cap = 0;  ///< as in State
};
struct DocumentOpened {
  std::string path;
};
struct DocumentClosed {};
struct ProgressMade {
  std::string what;
  double fraction = 0;
};
struct DragEnded {
  std::uint64_t drag = 0;
  bool committed = false;
  std::string why;
};
using Event = std::variant<GenerationPublished, DocumentOpened, DocumentClosed, ProgressMade, DragEnded>;

}  // namespace prismesh::ipc
