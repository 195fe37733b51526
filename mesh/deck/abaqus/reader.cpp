#include "mesh/deck/abaqus/reader.h"

#include <algorithm>
#include <map>
#include <utility>

#include "mesh/deck/abaqus/generated_ids.h"
#include "mesh/deck/abaqus/materials.h"
#include "mesh/deck/abaqus/mesh_cards.h"
#include "mesh/deck/abaqus/references.h"
#include "mesh/deck/abaqus/sets.h"
#include "mesh/deck/abaqus/walk.h"
#include "mesh/deck/assembly/read_pieces.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// Makes the deck's frames: one for each frame of the outline and each instance that uses it.
void place_frames(const DeckOutline& outline, DeckContents& found) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  for (std::size_t p = 0; p < outline.pieces.size(); ++p) {
    const std::uint32_t instance = outline.pieces[p].instance;
    for (PieceRun& run : found.cards[p].node_runs) {
      const auto [at, added] = known.try_emplace({instance, run.frame}, 0);
      if (added) {
        Frame frame = outline.frames[run.frame];
        if (instance != kNone) frame.to_basic = outline.instances[instance].to_basic * frame.to_basic;
        if (!frame.is_basic()) {
          at->second = static_cast<std::uint32_t>(found.frames.size());
          found.frames.push_back(frame);
        }
      }
      run.frame = at->second;
    }
  }
}

/// The smallest and the largest id of an instance's nodes and elements.
struct Extent {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  std::int64_t last = 0;

  void add(const std::vector<std::int64_t>& ids) {
    if (ids.empty()) return;
    const auto [min, max] = std::minmax_element(ids.begin(), ids.end());
    first = std::min(first, *min);
    last = std::max(last, *max);
  }
};

void shift_ids(PieceCards& cards, std::int64_t by) {
  const auto shift = [&](std::vector<std::int64_t>& ids) {
    for (std::int64_t& id : ids) id += by;
  };
  shift(cards.node_id);
  shift(cards.shells.id);
  for (auto& nodes : cards.shells.nodes)
    for (std::int64_t& node : nodes) node += by;
  for (auto& [shell, nodes] : cards.shells.midside)
    for (std::int64_t& node : nodes)
      if (node > 0) node += by;
  for (RawElements& elements : cards.elements) {
    shift(elements.id);
    shift(elements.nodes);
  }
  for (RawHiddenElement& element : cards.hidden) {
    if (element.id > 0) element.id += by;
    for (std::int64_t& node : element.nodes)
      if (node > 0) node += by;
  }
}

/// Marks runs whose text must not be changed: its ids aren't the model's, or it stands for several places.
void close_runs(PieceCards& cards) {
  for (PieceRun& run : cards.node_runs) run.style |= kStyleShifted;
  for (PieceRun& run : cards.shells.runs) run.style |= kStyleShifted;
}

/// Makes the ids of all instances unique: ids are unique within a part only. The first instance keeps its ids; another one whose range of
/// ids overlaps gets a round number added to all of them.
Result<void> shift_instances(DeckOutline& outline, DeckContents& found) {
  // The last one is that of everything outside of instances.
  std::vector<Extent> extents(outline.instances.size() + 1);
  for (std::size_t p = 0; p < outline.pieces.size(); ++p) {
    const PieceCards& cards = found.cards[p];
    Extent& extent = extents[outline.pieces[p].instance == kNone ? outline.instances.size() : outline.pieces[p].instance];
    extent.add(cards.node_id);
    extent.add(cards.shells.id);
    for (const RawElements& elements : cards.elements) extent.add(elements.id);
  }
  constexpr std::int64_t kMax = 900'000'000'000'000'000;
  std::int64_t used = extents.back().last;
  std::int64_t lowest = extents.back().first;
  for (std::size_t i = 0; i < outline.instances.size(); ++i) {
    if (extents[i].last == 0) continue;
    if (extents[i].first <= used && extents[i].last >= lowest) {
      std::int64_t round = 1000;
      while (round < extents[i].last && round < kMax / 10) round *= 10;
      const std::int64_t shift = (used / round + 1) * round;
      if (shift > kMax - extents[i].last)
        return fail(found.files[0].path.string(), "has instances whose numbers are too large to be told apart");
      outline.instances[i].shift = shift;
      found.warnings.note("renumbered-instance", outline.scopes[outline.instances[i].scope].file,
                          outline.scopes[outline.instances[i].scope].begin,
                          "nodes and elements of the instance " + outline.instances[i].name + " are shown with " + std::to_string(shift) +
                              " added to their numbers, since other instances have the same; the file keeps its own");
    }
    used = std::max(used, extents[i].last + outline.instances[i].shift);
    lowest = std::min(lowest, extents[i].first + outline.instances[i].shift);
  }
  for (std::size_t p = 0; p < outline.pieces.size(); ++p) {
    const std::uint32_t instance = outline.pieces[p].instance;
    const std::int64_t shift = instance == kNone ? 0 : outline.instances[instance].shift;
    if (shift != 0) shift_ids(found.cards[p], shift);
    if (shift != 0 || outline.pieces[p].held) close_runs(found.cards[p]);
  }
  return {};
}

/// Warns of elements that are left out because they connect instances.
void note_left_out(DeckContents& found) {
  for (PieceCards& cards : found.cards)
    for (const Oddity& oddity : cards.oddities)
      if (oddity.kind == "element-between-instances")
        found.warnings.note(
            oddity.kind, cards.file, oddity.offset,
            "element " + std::to_string(oddity.id) + " names nodes of instances; such elements aren't shown, they are kept as they are",
            oddity.count);
  for (PieceCards& cards : found.cards)
    std::erase_if(cards.oddities, [](const Oddity& oddity) { return oddity.kind == "element-between-instances"; });
}

/// Warns of keywords that generate or move nodes and elements: these are missing in the model, or are elsewhere in it.
void note_unread_mesh(const DeckOutline& outline, Warnings& warnings) {
  for (const KeptBlock& kept : outline.kept) {
    const std::string& word = outline.words[kept.word];
    for (const std::string_view makes : {"NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY", "NMAP", "SUBSTRUCTURE GENERATE", "IMPORT",
                                         "SYMMETRIC MODEL GENERATION", "TRIANGULATE"})
      if (word == makes)
        warnings.note_each("unread-generation", kept.block.file, kept.block.begin,
                           "*" + word + " isn't read in this version: what it makes isn't shown; it is kept as it is");
  }
}

}  // namespace

Result<DeckContents> read(FileSet files, Watch& watch) {
  Result<DeckOutline> walked = walk(std::move(files));
  if (!walked) return fail(walked.error());
  DeckOutline& outline = *walked;
  watch.tell(kWalked);
  DeckContents found;
  found.format = Format::abaqus;
  found.warnings = outline.warnings;
  note_unread_mesh(outline, found.warnings);
  found.files = std::move(outline.files.files);
  read_pieces(
      found, outline.pieces.size(), [&](std::size_t p) { return read_piece(outline, outline.pieces[p]); }, watch);
  if (watch.stopped()) return fail(cancelled());
  // After an error pieces are incomplete; open() reports the error.
  const bool whole = std::none_of(found.cards.begin(), found.cards.end(), [](const PieceCards& cards) { return cards.error.has_value(); });
  if (whole) {
    note_left_out(found);
    place_frames(outline, found);
    found.parts = make_parts(outline, found.cards, found.warnings);
    found.contacts = section_offsets(outline);
    if (Result<void> shifted = shift_instances(outline, found); !shifted) return fail(shifted.error());
    found.references = find_references(outline);
    found.taken = find_generated_ids(outline, largest_ids(found.cards));
  }
  found.missing_files = std::move(outline.files.missing);
  found.companions = std::move(outline.files.companions);
  found.unread_files = std::move(outline.files.unread);
  return found;
}

}  // namespace prismesh::mesh::deck::abaqus
