#include "mesh/deck/nastran/settle.h"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/deck/nastran/piece_entities.h"
#include "mesh/model/id_index.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// Where a grid point's card was read.
struct GridAt {
  std::size_t piece = 0;
  std::uint32_t node = 0;
};

std::int64_t system_of(const PieceCards& cards, std::uint32_t node, std::int64_t grid_default) {
  const auto run = std::prev(std::upper_bound(cards.node_runs.begin(), cards.node_runs.end(), node,
                                              [](std::uint32_t value, const PieceRun& r) { return value < r.first; }));
  return run->frame == kSystemOfGrdset ? grid_default : run->frame;
}

std::int64_t settle_grid_default(DeckContents& found, std::span<const PieceFacts> facts) {
  std::int64_t system = 0;
  bool given = false;
  for (std::size_t p = 0; p < facts.size(); ++p)
    for (const auto& [offset, asked] : facts[p].grid_default) {
      if (given)
        found.warnings.note("duplicate-grdset", found.cards[p].file, offset, "there is more than one GRDSET; the first counts");
      else
        system = asked;
      given = true;
    }
  return system;
}

/// Of the grid points that span systems; of equal ids the first counts.
std::unordered_map<std::int64_t, GridAt> find_spanning(const DeckContents& found, const std::vector<SystemCard>& systems) {
  std::unordered_map<std::int64_t, GridAt> at;
  for (const SystemCard& system : systems)
    if (system.by_grids)
      for (const std::int64_t grid : system.grids) at.try_emplace(grid, GridAt{found.cards.size(), 0});
  if (at.empty()) return at;
  for (std::size_t p = 0; p < found.cards.size(); ++p)
    for (std::uint32_t n = 0; n < found.cards[p].node_id.size(); ++n)
      if (const auto wanted = at.find(found.cards[p].node_id[n]); wanted != at.end() && wanted->second.piece == found.cards.size())
        wanted->second = {p, n};
  std::erase_if(at, [&](const auto& entry) { return entry.second.piece == found.cards.size(); });
  return at;
}

void hold_run(PieceCards& cards, std::size_t run, std::uint8_t why) {
  const std::size_t end = run + 1 < cards.node_runs.size() ? cards.node_runs[run + 1].first : cards.node_id.size();
  for (std::size_t n = cards.node_runs[run].first; n < end; ++n) cards.holds.emplace_back(static_cast<std::uint32_t>(n), why);
}

std::string name_of(const SystemCard& card) { return "coordinate system " + std::to_string(card.id); }

void warn_of_systems(DeckContents& found, const Systems& systems) {
  for (const Systems::Bad& bad : systems.bad())
    found.warnings.note(
        "bad-coordinate-system", bad.card->file, bad.card->offset,
        name_of(*bad.card) + " " + bad.why + "; what stands in it is shown as if it stood in the basic system and can't be moved");
  for (const SystemCard& card : systems.duplicates())
    found.warnings.note("duplicate-coordinate-system", card.file, card.offset,
                        name_of(card) + " is defined again; its first definition counts");
}

/// Frames by system id, made as runs ask for them.
class FrameTable {
 public:
  FrameTable(DeckContents& found, const Systems& systems) : found_(found), systems_(systems) {}

  /// nullopt: the system can't be worked out.
  std::optional<std::uint32_t> index(std::int64_t system) {
    if (system == 0) return 0;
    const auto [at, first] = known_.try_emplace(system);
    if (first)
      if (const std::optional<Frame> frame = systems_.find(system)) {
        found_.frames.push_back(*frame);
        at->second = static_cast<std::uint32_t>(found_.frames.size() - 1);
      }
    return at->second;
  }

 private:
  DeckContents& found_;
  const Systems& systems_;
  std::unordered_map<std::int64_t, std::optional<std::uint32_t>> known_;
};

}  // namespace

void settle_frames(DeckContents& found, std::span<PieceFacts> facts) {
  const std::int64_t grid_default = settle_grid_default(found, facts);
  std::vector<SystemCard> cards;
  for (PieceFacts& some : facts) cards.insert(cards.end(), some.systems.begin(), some.systems.end());
  const std::unordered_map<std::int64_t, GridAt> spanning = find_spanning(found, cards);
  const Systems systems(std::move(cards), [&](std::int64_t id) -> std::optional<GridPlace> {
    const auto at = spanning.find(id);
    if (at == spanning.end()) return std::nullopt;
    const PieceCards& piece = found.cards[at->second.piece];
    return GridPlace{piece.position[at->second.node], system_of(piece, at->second.node, grid_default)};
  });
  warn_of_systems(found, systems);
  for (const auto& [id, at] : spanning) found.cards[at.piece].holds.emplace_back(at.node, kHeldByFrame);
  FrameTable frames(found, systems);
  for (PieceCards& piece : found.cards)
    for (std::size_t r = 0; r < piece.node_runs.size(); ++r) {
      PieceRun& run = piece.node_runs[r];
      const std::int64_t system = run.frame == kSystemOfGrdset ? grid_default : run.frame;
      const std::optional<std::uint32_t> frame = frames.index(system);
      run.frame = frame.value_or(0);
      if (frame) continue;
      hold_run(piece, r, kHeldByFrame);
      if (!systems.defined(system))
        found.warnings.note("undefined-coordinate-system", piece.file, piece.node_offset[run.first],
                            "grid point " + std::to_string(piece.node_id[run.first]) + " stands in coordinate system " +
                                std::to_string(system) +
                                ", which isn't defined; it is shown as if that were the basic one and can't be moved");
    }
}

namespace {

constexpr std::int64_t kMaxDivisions = 1000;  ///< of an aerodynamic panel in one direction

class ScalarPoints {
 public:
  explicit ScalarPoints(std::span<const PieceFacts> facts) {
    for (const PieceFacts& some : facts) ranges_.insert(ranges_.end(), some.scalar_points.begin(), some.scalar_points.end());
    unite(ranges_);
  }
  bool empty() const { return ranges_.empty(); }
  /// Whether all of them lie in one range.
  bool has(std::int64_t first, std::int64_t last) const {
    const IdRange* range = range_with(ranges_, first);
    return range != nullptr && last <= range->last;
  }
  /// Calls `keep(first, last)` for each part of a range of ids without scalar points.
  template <class Keep>
  void leave_out_of(std::int64_t first, std::int64_t last, const Keep& keep) const {
    auto range = std::partition_point(ranges_.begin(), ranges_.end(), [&](const IdRange& r) { return r.last < first; });
    for (; range != ranges_.end() && range->first <= last; ++range) {
      if (first < range->first) keep(first, range->first - 1);
      if (range->last >= last) return;
      first = range->last + 1;
    }
    keep(first, last);
  }

 private:
  std::vector<IdRange> ranges_;
};

References without(const ScalarPoints& points, References&& references) {
  References kept;
  for (const Referrer& referrer : references.referrers()) kept.add(referrer);
  for (const UnreadText& unread : references.unread()) kept.add(unread);
  for (const Reference& reference : references.all()) {
    if (reference.referred == Referred::node && reference.role == ReferenceRole::list && reference.step == 1)
      points.leave_out_of(reference.first, reference.last, [&](std::int64_t first, std::int64_t last) {
        Reference part = reference;
        part.first = first;
        part.last = last;
        kept.add(part);
      });
    else if (reference.referred != Referred::node || !points.has(reference.first, reference.last))
      kept.add(reference);
  }
  return kept;
}

}  // namespace

void settle_scalar_points(DeckContents& found, std::span<PieceFacts> facts) {
  const ScalarPoints points(facts);
  if (points.empty()) return;
  for (PieceFacts& some : facts) some.references = without(points, std::move(some.references));
  found.references = without(points, std::move(found.references));
  for (PieceCards& piece : found.cards)
    for (RawElements& elements : piece.elements) {
      std::vector<std::int64_t> nodes;
      std::vector<std::uint32_t> first{0};
      for (std::size_t e = 0; e < elements.id.size(); ++e) {
        for (std::uint32_t n = elements.first_node[e]; n < elements.first_node[e + 1]; ++n)
          if (!points.has(elements.nodes[n], elements.nodes[n])) nodes.push_back(elements.nodes[n]);
        first.push_back(static_cast<std::uint32_t>(nodes.size()));
      }
      elements.nodes = std::move(nodes);
      elements.first_node = std::move(first);
    }
}

void settle_taken_ids(DeckContents& found, std::span<const PieceFacts> facts) {
  std::unordered_map<std::int64_t, std::int64_t> factors;
  for (const PieceFacts& some : facts) {
    found.taken.nodes.insert(found.taken.nodes.end(), some.scalar_points.begin(), some.scalar_points.end());
    found.taken.nodes.insert(found.taken.nodes.end(), some.unlisted_points.begin(), some.unlisted_points.end());
    factors.insert(some.factor_lists.begin(), some.factor_lists.end());
  }
  // N factors divide into N - 1 boxes. A list that isn't there counts as one of very many.
  const auto divisions = [&](std::int64_t count, std::int64_t list) {
    if (count > 0) return std::min(count, kMaxDivisions);
    const auto given = factors.find(list);
    return given == factors.end() ? kMaxDivisions : std::clamp<std::int64_t>(given->second, 1, kMaxDivisions);
  };
  for (const PieceFacts& some : facts)
    for (const AeroPanel& panel : some.panels) {
      const std::int64_t corners = (divisions(panel.spans, panel.span_list) + 1) * (divisions(panel.chords, panel.chord_list) + 1);
      const IdRange range{panel.id, panel.id + corners - 1};
      found.taken.nodes.push_back(range);
      found.taken.elements.push_back(range);
    }
}

void settle_thickness(DeckContents& found, std::span<const PieceFacts> facts, const PartTable& table) {
  for (std::size_t p = 0; p < facts.size(); ++p)
    for (const ThicknessFields& own : facts[p].thickness) {
      RawShells& shells = found.cards[p].shells;
      const std::optional<double> section = table.thickness_of(shells.part[own.shell]);
      const double blank = own.corners - own.given;
      double mean = own.sum / own.given;
      if (section)
        mean = own.relative ? (own.sum + blank) * *section / own.corners : (own.sum + blank * *section) / own.corners;
      else if (own.relative)
        mean = 0;
      // The array has no entry yet where the fields say 0 and no shell before had a thickness.
      if (shells.thickness.size() <= own.shell) shells.thickness.resize(shells.id.size());
      shells.thickness[own.shell] = static_cast<float>(mean);
    }
}

namespace {

/// Where an element that isn't a shell is stored.
struct ElementPlace {
  std::size_t piece = 0;
  std::size_t element_class = 0;
  std::size_t offset = 0;
};

/// All elements but shells, in the deck's order within each piece and class.
std::vector<ElementPlace> places_of(const DeckContents& found, std::vector<std::int64_t>& ids) {
  std::vector<ElementPlace> places;
  for (std::size_t p = 0; p < found.cards.size(); ++p)
    for (std::size_t c = 0; c < found.cards[p].elements.size(); ++c) {
      const RawElements& elements = found.cards[p].elements[c];
      for (std::size_t e = 0; e < elements.id.size(); ++e) places.push_back({p, c, elements.offset[e]});
      ids.insert(ids.end(), elements.id.begin(), elements.id.end());
    }
  return places;
}

}  // namespace

void note_shared_element_ids(DeckContents& found) {
  std::vector<std::int64_t> ids;
  const std::vector<ElementPlace> places = places_of(found, ids);
  if (places.empty()) return;
  const IdIndex index(ids);
  const auto note = [&](std::size_t piece, std::size_t offset, std::int64_t id) {
    found.warnings.note("shared-element-number", found.cards[piece].file, offset,
                        "element " + std::to_string(id) + " has the number of an element of another type; both are shown");
  };
  for (std::size_t i = 0; i < places.size(); ++i)
    if (const std::uint32_t first = index.find(ids[i]); first != i && places[first].element_class != places[i].element_class)
      note(places[i].piece, places[i].offset, ids[i]);
  std::vector<std::vector<std::size_t>> shared(found.cards.size());
  parallel_for(found.cards.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t s = 0; s < found.cards[p].shells.id.size(); ++s)
        if (index.find(found.cards[p].shells.id[s]) != IdIndex::kNotFound) shared[p].push_back(s);
  });
  for (std::size_t p = 0; p < shared.size(); ++p)
    for (const std::size_t s : shared[p]) note(p, found.cards[p].shells.offset[s], found.cards[p].shells.id[s]);
}

}  // namespace prismesh::mesh::deck::nastran
