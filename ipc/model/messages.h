// The messages between modeld and its clients, as plain structs (their JSON: messages_json.cpp). docs/protocol.md describes them for other
// programs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ipc/wire/answers.h"
#include "mesh/deck/data/deck.h"
#include "mesh/document/edit.h"
#include "mesh/document/edit_report.h"
#include "mesh/document/judging_rules.h"
#include "mesh/document/quality_figures.h"

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
  std::vector<mesh::document::JudgingRule> rules;  ///< what parts are judged by, after the settings beside the deck and the two above
  bool discard = false;  ///< discards unsaved edits of the open document once the other deck is read; false: refused with unsaved edits
  bool keep = false;     ///< instead leaves them in their journal: they come back when that deck is opened again
  /// Nobody vouches for the deck: it is read, and its text rewritten, by prismesh-import in a sandbox (docs/remote.md). The settings beside
  /// it aren't read.
  bool sandboxed = false;
  /// Hash of a model in the store, instead of the path: it is copied, and opened sandboxed. Once it is open: the model that its deck came
  /// from, or was last published as; saving it in place publishes it anew.
  std::string stored;
};
struct Save {
  std::optional<std::string> path;  ///< absent: the deck's own
  bool becomes = false;             ///< the document becomes the deck at `path`; false: it is saved as a copy
  bool asks = false;                ///< if a file would be replaced or a folder made, nothing is written and the answer is SaveWould
  bool stays_unsaved = false;       ///< of a copy: edits that the document's own deck doesn't have still count as unsaved
};
struct Close {
  bool discard = false;  ///< false: refused while there are unsaved edits
  bool keep = false;     ///< instead leaves them in their journal: they come back when the deck is opened again
};
struct ApplyEdit {
  mesh::document::Edit edit;
};
/// Goes to a state of the history or of a branch by as many undos, redos and branches taken as that needs; each is journalled as one.
struct GoTo {
  std::uint64_t generation = 0;  ///< one of those that History lists
};
struct BeginDrag {
  mesh::document::Edit edit;  ///< translate, lift, slide, rotate or move; the displacement is ignored
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
struct Count {  ///< counts what an expression names; selects nothing
  std::string expr;
  mesh::select::EntityKind kind = mesh::select::EntityKind::node;
};
/// Asks for statistics of the shells' quality. Costs a pass over the shells: ask only where they are shown, once for a generation.
using GetQuality = mesh::document::QualityQuestion;
using FindShells = mesh::document::ShellsWanted;
struct PreviewEdit {  ///< asks what an edit would do, without applying it
  mesh::document::Edit edit;
};
struct FindFollowedEdges {    ///< asks which free edges would follow an edit, and how far it reaches; nothing is done
  mesh::document::Edit edit;  ///< translate, lift, slide, rotate or move; the displacement is ignored
};
/// Asks for a field (mesh/document/field.h).
struct GetField {
  std::string field = "displacement";               ///< a name for mesh::document::field_wish
  std::optional<std::uint64_t> generation;          ///< absent: the current one
  std::string against = "opened";                   ///< or "surface": as last shaped; or another deck's path
  std::optional<std::uint64_t> against_generation;  ///< replaces `against`
  std::string from, to;                             ///< of "distance": expressions
};
/// Asks where shells cross or are too close (mesh/document/contacts.h). Costs a search of the whole model.
struct GetContacts {
  std::optional<std::string> select;  ///< an expression: only where one of its shells takes part; absent: everywhere
  double gap = 0;                     ///< how far faces must be apart, deck's length unit
  std::optional<double> thickness;    ///< of all shells; absent: that in the deck's contacts, else of elements and sections
};
/// Asks for the welds and what is wrong with them (mesh/document/weld_checks.h). Costs the shells of the model. Lengths: deck's unit; 0:
/// not checked.
struct GetWeldChecks {
  double edge_distance = 0;
  double pitch = 0;
};
/// The camera of a view, for views that move together. In screen millimetres and deck coordinates, as in kiosk/stereo/view.h.
struct Camera {
  std::array<double, 3> pivot{};
  std::vector<double> rotation{1, 0, 0, 0};  ///< a unit quaternion, real part first
  double mm_per_unit = 1;
  std::array<double, 3> stands_mm{};  ///< the pivot: right, up, before the screen
  bool operator==(const Camera&) const = default;
};
struct ShareCamera {  ///< no answer; the other clients receive CameraMoved
  Camera camera;
};
/// Stops the work under way, if this client asked for it and it can be stopped. Its answer is Failed, and nothing has changed; but a repair
/// that is kept is answered as Edited. The first one decides.
struct Cancel {
  bool keep = false;  ///< keeps what a repair has reached; false: its `on_cancel` decides
};
struct GetState {};
struct GetHistory {};
struct GetSnapshot {
  std::optional<std::uint64_t> generation;   ///< one of DocumentState::generations; absent: the current one
  std::vector<std::uint64_t> have_segments;  ///< segments the client still has mapped
};
struct ReturnSnapshot {  ///< no answer
  std::uint64_t lease = 0;
};
/// Follows a haptic pen: modeld keeps the distances to the shells near it in a page. A second one replaces pen and placement. It ends with
/// LeavePen or the client's connection. pen_mm = scale * turn * position + shift_mm.
struct FollowPen {                         ///< descriptor: the state page of the pen's process (ipc/pen/page.h)
  std::uint64_t placement = 0;             ///< number of this map from the model to the pen's space; the fields have it
  std::array<double, 4> turn{1, 0, 0, 0};  ///< a unit quaternion, real part first
  std::array<double, 3> shift_mm{};
  double scale = 1;  ///< millimetres of the pen for one length of the deck
};
struct LeavePen {};

using Request = std::variant<Hello, Open, Save, Close, ApplyEdit, GoTo, BeginDrag, DragStep, CommitDrag, CancelDrag, Cancel, Count,
                             GetQuality, FindShells, PreviewEdit, FindFollowedEdges, GetField, GetContacts, GetWeldChecks, ShareCamera,
                             GetState, GetHistory, GetSnapshot, ReturnSnapshot, FollowPen, LeavePen>;

// --- answers (Failed and Done: ipc/wire/answers.h) ---
struct Welcome {
  int protocol = kProtocolVersion;
  std::string version;
  std::uint64_t client = 0;
};
/// A file of the deck that holds elements, and the parts that these belong to.
struct DeckFile {
  std::string name;  ///< NAME of `file:NAME` in an expression
  std::uint64_t shells = 0;
  std::vector<std::int64_t> parts;  ///< ids, ascending
};
/// A generation that GetSnapshot and GetField can name.
struct ListedGeneration {
  std::uint64_t number = 0;
  std::string made_by;
};
struct DocumentState {
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
  std::uint64_t recovered_edits = 0;   ///< restored from the journal when the document was opened
  std::uint64_t journalled_edits = 0;  ///< acknowledged since the deck was opened or last saved in place; a restart restores them
  std::uint64_t history_bytes = 0, history_cap = 0;  ///< size of the generations kept for undo and redo, and its max
  std::vector<ListedGeneration> generations;         ///< oldest first; undo and redo move among them
  std::vector<DeckFile> files;
  std::vector<mesh::deck::Warning> warnings;
  std::string stored;  ///< Open::stored of it; empty: it doesn't come from the store
};
/// States that an edit took the place of after they were undone; GoTo brings them back.
struct HistoryBranch {
  std::uint64_t number = 0;
  std::uint64_t fork = 0;                     ///< the state that the first one was made from; may be in another branch
  std::vector<ListedGeneration> generations;  ///< oldest first
};
/// The states that undo and redo move among; without a document there are none.
struct History {
  std::uint64_t generation = 0;               ///< the current one
  std::vector<ListedGeneration> generations;  ///< oldest first
  std::vector<HistoryBranch> branches;        ///< in the order in which they were left
};
struct Saved {
  std::string path;
  std::uint64_t nodes_written = 0, lines_changed = 0;
  std::vector<std::string> notes;
};
/// Nothing was saved; tells what the save would replace and make. Send it without `asks` to save.
struct SaveWould {
  std::vector<std::string> replace;  ///< existing files that aren't the deck's own
  std::vector<std::string> make;     ///< missing folders
};
struct Edited {
  mesh::document::EditReport report;
  std::uint64_t generation = 0;
};
struct Counted {
  std::uint64_t nodes = 0, shells = 0, parts = 0;
};
// mesh/document/quality_figures.h
using Quality = mesh::document::QualityFigures;
using QualityMetric = mesh::document::QualityMetric;
using QualityBar = mesh::document::QualityBar;
using QualityError = mesh::document::QualityError;
using QualityPart = mesh::document::QualityPart;
using ShellsFound = mesh::document::ShellsFound;
/// A shell as an edit would leave it: a new one, or one whose corners it would move or change.
struct PreviewedShell {
  std::int64_t shell = 0;
  std::vector<std::uint32_t> corners;  ///< four, into `points`; a triangle repeats its third
  std::uint32_t warn = 0, fail = 0;    ///< mesh::quality::ShellState
  std::uint32_t clusters = 0;          ///< bit k: at corner k are too many triangles, and this is the first of them here
};
/// A spot at which an edit would make no weld.
struct PreviewedGap {
  std::array<double, 3> at{};
  std::string why;
};
struct EditPreviewed {
  std::uint64_t generation = 0;  ///< that the edit would be applied to
  mesh::document::EditReport report;
  std::vector<std::array<double, 3>> points;
  std::vector<PreviewedShell> shells;        ///< max kMaxPreviewedShells
  std::uint64_t shell_count = 0;             ///< without that limit
  std::vector<std::int64_t> replaced;        ///< ids of shells that would be removed or changed
  std::vector<std::array<double, 6>> lines;  ///< new elements with two nodes: both ends; max kMaxPreviewedLines
  std::uint64_t line_count = 0;              ///< without that limit
  std::vector<PreviewedGap> left_out;        ///< spots that get no weld
};
inline constexpr std::size_t kMaxPreviewedShells = 2000;
inline constexpr std::size_t kMaxPreviewedLines = 5000;
struct FollowedEdges {
  std::uint64_t generation = 0;      ///< that the edit would be applied to
  std::vector<std::uint32_t> nodes;  ///< two for each edge, as indices into the generation's nodes; max kMaxFollowedEdges edges
  std::uint64_t edge_count = 0;      ///< without that limit
  /// Where the weight falls through a half: both ends of each piece, deck coordinates; max kMaxFollowedEdges.
  std::vector<std::array<double, 6>> halfway{};
};
inline constexpr std::size_t kMaxFollowedEdges = 5000;
struct FieldMade {          ///< descriptor: the values (ipc/model/field_page.h)
  std::uint64_t field = 0;  ///< its number, unique
  std::string title, unit;
  std::string of;       ///< the state it is of, in words
  std::string against;  ///< what it is compared with, in words; empty: nothing
  std::uint64_t generation = 0;
  bool on_nodes = true;
  std::uint64_t measured = 0;  ///< nodes or shells with a value
  double min = 0, mean = 0, max = 0;
  std::string min_at, max_at;        ///< "node:7", "shell:12"
  double clear = 0, full = 1;        ///< suggested limits of a colour map
  std::uint64_t new_nodes = 0;       ///< have a value, but aren't in the figures (mesh/document/field.h)
  std::uint64_t shells_without = 0;  ///< existing shells without a value
};
/// A node that must move, and where to.
struct ContactVector {
  std::uint32_t node = 0;  ///< index into the generation's nodes
  std::array<double, 3> to{};
};
/// A region in which shells cross or are too close: mesh::document::ContactRegion. Lists are cut as kMaxContacts says.
struct ContactRegion {
  std::string kind;            ///< "perforation", "penetration" or "clearance"
  std::string a, b;            ///< "part:1"; empty: shells without a part
  std::string name_a, name_b;  ///< of the parts
  std::uint64_t shells_a = 0, shells_b = 0;
  double length = 0;                ///< of the curve along which they cross; else 0
  std::optional<double> max_depth;  ///< absent: half through
  double mean_depth = 0;
  double area = 0;
  std::array<double, 3> at{};
  std::string worst_a, worst_b;  ///< "shell:7"
  bool joined = false;
  std::string contact;  ///< the deck's contact that sees the region; empty: not known
  std::string why;      ///< why it can't be separated; empty: it can
  std::string thickness_from;
  std::vector<std::uint32_t> shells;         ///< of both sides, as indices into the generation's shells
  std::vector<std::array<double, 6>> curve;  ///< segments along which they cross: both ends
  std::vector<ContactVector> vectors;
};
struct Contacts {
  std::uint64_t generation = 0;
  std::uint64_t perforations = 0, penetrations = 0, clearances = 0;  ///< without the limit
  std::vector<ContactRegion> regions;                                ///< perforations, then the others; of each the worst first
  std::vector<std::int64_t> without_thickness;                       ///< ids of parts, ascending
  std::int64_t search_ns = 0;                                        ///< how long the search took, without the wait for it
};
/// Of one answer. What is beyond them is left out from the end, so that the worst regions are whole.
struct ContactLimits {
  std::size_t regions = 300;
  std::size_t shells = 20'000, segments = 10'000, vectors = 10'000;  ///< of all regions together
};
inline constexpr ContactLimits kMaxContacts;
struct WeldFound {
  std::string kind;  ///< mesh::document::WeldFinding
  std::string words;
  std::array<double, 3> at{};
};
struct WeldChecks {
  std::uint64_t generation = 0;
  std::uint64_t welds = 0;
  std::uint64_t finding_count = 0;  ///< without the limit
  std::vector<WeldFound> findings;  ///< max kMaxWeldFindings
  std::int64_t search_ns = 0;       ///< how long the search took, without the wait for it
};
inline constexpr std::size_t kMaxWeldFindings = 1000;
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
  std::vector<std::uint64_t> segments;      ///< used by the table, in its order
  std::vector<std::uint64_t> new_segments;  ///< those sent with this message, in this order
};
struct PenFollowed {};  ///< descriptor: the page with the fields (ipc/pen/haptic_field_page.h)
using Answer = std::variant<Failed, Done, Welcome, DocumentState, History, Saved, SaveWould, Edited, Counted, Quality, ShellsFound,
                            EditPreviewed, FollowedEdges, DragBegun, Snapshot, FieldMade, Contacts, WeldChecks, PenFollowed>;

// --- events; sent to every client ---
struct GenerationPublished {
  std::uint64_t generation = 0;
  std::string made_by;
  std::uint64_t history_bytes = 0, history_cap = 0;  ///< as in DocumentState
};
struct DocumentOpened {
  std::string path;
};
struct DocumentClosed {};
struct ProgressMade {
  std::string what;
  double fraction = 0;
  std::string doing{};        ///< in words; empty: the work has none
  std::uint64_t seconds = 0;  ///< since the work began
};
struct DragEnded {
  std::uint64_t drag = 0;
  bool committed = false;
  std::string why;
};
struct CameraMoved {  ///< not sent to the client that moved it
  std::uint64_t client = 0;
  Camera camera;
};
using Event = std::variant<GenerationPublished, DocumentOpened, DocumentClosed, ProgressMade, DragEnded, CameraMoved>;

}  // namespace prismesh::ipc
