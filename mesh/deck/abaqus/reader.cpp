#include "mesh/deck/abaqus/reader.h"

#include <algorithm>
#include <map>
#include <utility>

#include "mesh/deck/abaqus/mesh_cards.h"
#include "mesh/deck/abaqus/references.h"
#include "mesh/deck/abaqus/sets.h"
#include "mesh/deck/abaqus/walk.h"
#include "mesh/deck/assembly/read_pieces.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// Frames of the deck for those of the walk, seen from each instance.
void place_frames(const Walk& walk, DeckContents& found) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  for (std::size_t p = 0; p < walk.pieces.size(); ++p) {
    const std::uint32_t instance = walk.pieces[p].instance;
    for (PieceRun& run : found.cards[p].node_runs) {
      const auto [at, added] = known.try_emplace({instance, run.frame}, 0);
      if (added) {
        Frame frame = walk.frames[run.frame];
        if (instance != kNone) frame.to_basic = walk.instances[instance].to_basic * frame.to_basic;
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
    const auto [least, most] = std::minmax_element(ids.begin(), ids.end());
    first = std::min(first, *least);
    last = std::max(last, *most);
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
}

/// Nothing may be added to or changed in text whose ids aren't the model's, or that stands for several places.
void close_runs(PieceCards& cards) {
  for (PieceRun& run : cards.node_runs) run.style |= kStyleShifted;
  for (PieceRun& run : cards.shells.runs) run.style |= kStyleShifted;
}

/// Ids mean something within their part only. The first instance keeps its own; where another's would be the same, it gets a round number
/// added to all of them.
Result<void> shift_instances(Walk& walk, DeckContents& found) {
  // What stands outside of instances is one, too, and comes last: it refers to the others.
  std::vector<Extent> extents(walk.instances.size() + 1);
  for (std::size_t p = 0; p < walk.pieces.size(); ++p) {
    const PieceCards& cards = found.cards[p];
    Extent& extent = extents[walk.pieces[p].instance == kNone ? walk.instances.size() : walk.pieces[p].instance];
    extent.add(cards.node_id);
    extent.add(cards.shells.id);
    for (const RawElements& elements : cards.elements) extent.add(elements.id);
  }
  constexpr std::int64_t kMax = 900'000'000'000'000'000;
  std::int64_t used = extents.back().last;
  std::int64_t least = extents.back().first;
  for (std::size_t i = 0; i < walk.instances.size(); ++i) {
    if (extents[i].last == 0) continue;
    if (extents[i].first <= used && extents[i].last >= least) {
      std::int64_t round = 1000;
      while (round < extents[i].last && round < kMax / 10) round *= 10;
      const std::int64_t shift = (used / round + 1) * round;
      if (shift > kMax - extents[i].last)
        return fail(found.files[0].path.string(), "has instances whose numbers are too large to be told apart");
      walk.instances[i].shift = shift;
      found.warnings.note("renumbered-instance", walk.scopes[walk.instances[i].scope].file, walk.scopes[walk.instances[i].scope].begin,
                          "nodes and elements of the instance " + walk.instances[i].name + " are shown with " + std::to_string(shift) +
                              " added to their numbers, since other instances have the same; the file keeps its own");
    }
    used = std::max(used, extents[i].last + walk.instances[i].shift);
    least = std::min(least, extents[i].first + walk.instances[i].shift);
  }
  for (std::size_t p = 0; p < walk.pieces.size(); ++p) {
    const std::uint32_t instance = walk.pieces[p].instance;
    const std::int64_t shift = instance == kNone ? 0 : walk.instances[instance].shift;
    if (shift != 0) shift_ids(found.cards[p], shift);
    if (shift != 0 || walk.pieces[p].held) close_runs(found.cards[p]);
  }
  return {};
}

/// Elements that are left out for a reason of this format's own.
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

/// Keywords that make or move nodes and elements, which the model then lacks or has elsewhere.
void note_unread_mesh(const Walk& walk, Warnings& warnings) {
  for (const Walk::Kept& kept : walk.kept) {
    const std::string& word = walk.words[kept.word];
    for (const std::string_view makes : {"NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY", "NMAP", "SUBSTRUCTURE GENERATE", "IMPORT",
                                         "SYMMETRIC MODEL GENERATION", "TRIANGULATE"})
      if (word == makes)
        warnings.note_each("unread-generation", kept.block.file, kept.block.begin,
                           "*" + word + " isn't read in this version: what it makes isn't shown; it is kept as it is");
  }
}

}  // namespace

Result<DeckContents> read(FileSet files, Watch& watch) {
  Walk walk(std::move(files));
  if (Result<void> walked = walk.run(); !walked) return fail(walked.error());
  watch.tell(kWalked);
  DeckContents found;
  found.format = Format::abaqus;
  found.warnings = walk.warnings;
  note_unread_mesh(walk, found.warnings);
  // The walk needs the files until the references are found; read_pieces needs to hash them.
  found.files = std::move(walk.files.files);
  walk.keep_texts(found.files);
  read_pieces(
      found, walk.pieces.size(), [&](std::size_t p) { return read_piece(walk, walk.pieces[p]); }, watch);
  if (watch.stopped()) return fail(cancelled());
  // After an error pieces are cut short; opening tells of it.
  const bool whole = std::none_of(found.cards.begin(), found.cards.end(), [](const PieceCards& cards) { return cards.error.has_value(); });
  if (whole) {
    note_left_out(found);
    place_frames(walk, found);
    found.parts = make_parts(walk, found.cards, found.warnings);
    if (Result<void> shifted = shift_instances(walk, found); !shifted) return fail(shifted.error());
    found.references = find_references(walk);
  }
  found.missing_files = std::move(walk.files.missing);
  return found;
}

}  // namespace prismesh::mesh::deck::abaqus
