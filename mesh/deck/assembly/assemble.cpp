#include "mesh/deck/assembly/assemble.h"

#include <algorithm>
#include <numeric>

#include "base/large_memory.h"
#include "base/parallel_for.h"

namespace prismesh::mesh::deck {
namespace {

/// Where each piece's entries begin when all are put one after the other; one more entry than pieces.
template <class Count>
std::vector<std::size_t> starts_of(std::span<PieceCards> cards, Count count) {
  std::vector<std::size_t> starts(cards.size() + 1);
  for (std::size_t p = 0; p < cards.size(); ++p) starts[p + 1] = starts[p] + count(cards[p]);
  return starts;
}

/// Fills an array from the pieces in parallel, a chunk at a time: `copy(piece, first, count, out)`. The chunks of a model as it is opened
/// live as long as the model, so they may share blocks of memory.
template <class T, class Copy>
void gather(ChunkedArray<T>& array, const std::vector<std::size_t>& starts, const Copy& copy) {
  array.reset(starts.back());
  LargePool pool;
  parallel_for(array.chunk_count(), 16, [&](std::size_t first_chunk, std::size_t last_chunk) {
    for (std::size_t c = first_chunk; c < last_chunk; ++c) {
      const std::span<T> out = array.put_chunk(c, pool.make<typename ChunkedArray<T>::Chunk>());
      const std::size_t begin = c * kChunkSize;
      auto piece = static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), begin) - starts.begin()) - 1;
      for (std::size_t done = 0; done < out.size(); ++piece) {
        const std::size_t first = begin + done - starts[piece];
        const std::size_t count = std::min(out.size() - done, starts[piece + 1] - starts[piece] - first);
        copy(piece, first, count, out.subspan(done, count));
        done += count;
      }
    }
  });
}

template <class T, class Field>
void gather_field(ChunkedArray<T>& array, const std::vector<std::size_t>& starts, std::span<PieceCards> cards, const Field& field) {
  gather(array, starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<T> out) {
    const auto& from = field(cards[piece]);
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(first), count, out.begin());
  });
}

template <class T>
void concatenate(const std::vector<std::size_t>& starts, std::span<PieceCards> cards, std::vector<T>& (*field)(PieceCards&),
                 std::vector<T>& all) {
  reserve_large(all, starts.back());
  all.resize(starts.back());
  parallel_for(cards.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::vector<T>& from = field(cards[p]);
      std::copy(from.begin(), from.end(), all.begin() + static_cast<std::ptrdiff_t>(starts[p]));
    }
  });
}

std::shared_ptr<const IdIndex> index_of(const std::vector<std::size_t>& starts, std::span<PieceCards> cards,
                                        std::vector<std::int64_t>& (*field)(PieceCards&)) {
  std::vector<std::int64_t> ids;
  concatenate(starts, cards, field, ids);
  return std::make_shared<const IdIndex>(ids);
}

std::vector<std::int64_t>& node_ids(PieceCards& cards) { return cards.node_id; }
std::vector<std::int64_t>& shell_ids(PieceCards& cards) { return cards.shells.id; }
std::vector<std::uint64_t>& node_offsets(PieceCards& cards) { return cards.node_offset; }
std::vector<std::uint64_t>& shell_offsets(PieceCards& cards) { return cards.shells.offset; }

/// What was copied isn't needed any more, and a large model is better off without it. Giving memory back takes time as well.
template <class Free>
void free_each(std::span<PieceCards> cards, const Free& free) {
  parallel_for(cards.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) free(cards[p]);
  });
}

/// Keeps the entries with keep[i] set.
template <class T>
void keep_only(std::vector<T>& values, const std::vector<std::uint8_t>& keep) {
  if (values.size() != keep.size()) return;
  std::size_t out = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (keep[i]) values[out++] = values[i];
  values.resize(out);
}

class Assembler {
 public:
  Assembler(std::span<PieceCards> cards, Deck& deck, Warnings& warnings) : cards_(cards), deck_(deck), warnings_(warnings) {}

  Model run(std::vector<Part> parts) {
    for (const PieceCards& cards : cards_)
      if (cards.held) deck_.held_files.push_back(cards.file);
    std::sort(deck_.held_files.begin(), deck_.held_files.end());
    deck_.held_files.erase(std::unique(deck_.held_files.begin(), deck_.held_files.end()), deck_.held_files.end());
    note_oddities();
    gather_nodes();
    gather_parts(std::move(parts));
    gather_shells();
    gather_elements();
    return std::move(model_);
  }

 private:
  void note_oddities() {
    for (std::size_t p = 0; p < cards_.size(); ++p) {
      deck_.element_cards += cards_[p].counts;
      for (const auto& [kind, count] : cards_[p].kinds) kind_count(kind) += count;
      for (const Oddity& oddity : cards_[p].oddities) {
        const std::string id = oddity.id > 0 ? " (id " + std::to_string(oddity.id) + ")" : std::string();
        const std::string message = oddity.kind == "undefined-parameter"
                                        ? "a card" + id + " names a parameter that isn't defined; it is left out"
                                        : "an element" + id + " has fewer nodes than its kind needs; it is left out";
        warnings_.note(oddity.kind, cards_[p].file, oddity.offset, message, oddity.count);
      }
    }
  }

  std::size_t& kind_count(std::string_view kind) {
    const auto at = deck_.element_kinds.find(kind);
    return at != deck_.element_kinds.end() ? at->second : deck_.element_kinds[std::string(kind)];
  }

  void gather_nodes() {
    std::vector<std::size_t> starts = starts_of(cards_, [](const PieceCards& c) { return c.node_id.size(); });
    auto index = index_of(starts, cards_, node_ids);
    if (!index->duplicates().empty()) {
      drop_duplicate_nodes(*index, starts);
      starts = starts_of(cards_, [](const PieceCards& c) { return c.node_id.size(); });
      index = index_of(starts, cards_, node_ids);
    }
    model_.node_index = std::move(index);
    gather_field(
        model_.node_ids, starts, cards_, [](PieceCards & c) -> auto& { return c.node_id; });
    gather_field(
        model_.positions, starts, cards_, [](PieceCards & c) -> auto& { return c.position; });
    model_.node_holds = ChunkedArray<std::uint8_t>::filled(starts.back());
    concatenate(starts, cards_, node_offsets, deck_.node_line);
    for (std::size_t p = 0; p < cards_.size(); ++p) {
      PieceCards& cards = cards_[p];
      for (const PieceRun& run : cards.node_runs) add_run(deck_.node_runs, starts[p], cards.file, run);
      hold_nodes(starts[p], cards, cards.held);
    }
    free_each(cards_, [](PieceCards& cards) {
      cards.node_id = {};
      cards.position = {};
      cards.node_offset = {};
    });
    while (!deck_.node_runs.empty() && deck_.node_runs.back().first >= starts.back()) deck_.node_runs.pop_back();
    to_basic_system();
  }

  void to_basic_system() {
    for (std::size_t r = 0; r < deck_.node_runs.size(); ++r) {
      const Frame& frame = deck_.frames[deck_.node_runs[r].frame];
      if (frame.is_basic()) continue;
      const std::size_t end = r + 1 < deck_.node_runs.size() ? deck_.node_runs[r + 1].first : model_.node_count();
      for (std::size_t n = deck_.node_runs[r].first; n < end; ++n) model_.positions.set(n, to_basic(frame, model_.positions[n]));
    }
  }

  void hold_nodes(std::size_t start, const PieceCards& cards, bool held) {
    if (held)
      for (std::size_t i = 0; i < cards.node_id.size(); ++i) model_.node_holds.set(start + i, kHeldByInclude);
    for (const std::uint32_t node : cards.by_parameter)
      model_.node_holds.set(start + node, static_cast<std::uint8_t>(model_.node_holds[start + node] | kHeldByParameter));
    for (const auto& [node, why] : cards.holds)
      model_.node_holds.set(start + node, static_cast<std::uint8_t>(model_.node_holds[start + node] | why));
  }

  /// A run goes on where file and columns stay the same; an empty run gives way to the next.
  static void add_run(std::vector<CardRun>& runs, std::size_t start, std::uint32_t file, const PieceRun& run) {
    const CardRun added{static_cast<std::uint32_t>(start) + run.first, file, run.style, run.frame};
    if (!runs.empty() && runs.back().first == added.first) runs.pop_back();
    if (!runs.empty() && runs.back().file == file && runs.back().style == run.style && runs.back().frame == run.frame) return;
    runs.push_back(added);
  }

  void drop_duplicate_nodes(const IdIndex& index, const std::vector<std::size_t>& starts) {
    for (std::size_t p = 0; p < cards_.size(); ++p) {
      PieceCards& cards = cards_[p];
      std::vector<std::uint8_t> keep(cards.node_id.size());
      for (std::size_t i = 0; i < keep.size(); ++i) {
        keep[i] = index.find(cards.node_id[i]) == starts[p] + i;
        if (!keep[i])
          warnings_.note("duplicate-node", cards_[p].file, cards.node_offset[i],
                         "node " + std::to_string(cards.node_id[i]) + " is defined again; its first definition counts");
      }
      std::vector<std::uint32_t> before(keep.size() + 1);
      for (std::size_t i = 0; i < keep.size(); ++i) before[i + 1] = before[i] + keep[i];
      for (PieceRun& run : cards.node_runs) run.first = before[run.first];
      std::erase_if(cards.by_parameter, [&](std::uint32_t node) { return !keep[node]; });
      for (std::uint32_t& node : cards.by_parameter) node = before[node];
      std::erase_if(cards.holds, [&](const auto& hold) { return !keep[hold.first]; });
      for (auto& hold : cards.holds) hold.first = before[hold.first];
      keep_only(cards.position, keep);
      keep_only(cards.node_offset, keep);
      keep_only(cards.node_id, keep);
    }
  }

  /// The parts that are defined, and those that elements name all the same.
  void gather_parts(std::vector<Part> parts) {
    std::vector<std::vector<std::int64_t>> used(cards_.size());
    parallel_for(cards_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        collect_parts(cards_[p].shells.part, used[p]);
        for (int c = 0; c < kElementClassCount; ++c)
          if (c != static_cast<int>(ElementClass::mass)) collect_parts(cards_[p].elements[static_cast<std::size_t>(c)].part, used[p]);
      }
    });
    std::vector<std::int64_t> ids;
    for (const auto& piece : used) ids.insert(ids.end(), piece.begin(), piece.end());
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const std::size_t defined = parts.size();
    const auto by_id = [](const Part& a, const Part& b) { return a.id < b.id; };
    for (const std::int64_t id : ids) {
      Part part;
      part.id = id;
      if (!std::binary_search(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(defined), part, by_id)) parts.push_back(part);
    }
    std::inplace_merge(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(defined), parts.end(), by_id);
    std::vector<std::int64_t> part_ids(parts.size());
    std::transform(parts.begin(), parts.end(), part_ids.begin(), [](const Part& part) { return part.id; });
    part_index_ = IdIndex(part_ids);
    model_.parts = std::make_shared<const std::vector<Part>>(std::move(parts));
  }

  static void collect_parts(const std::vector<std::int64_t>& from, std::vector<std::int64_t>& used) {
    std::vector<std::int64_t> mine;
    for (const std::int64_t id : from)
      if (id != kNoPart && (mine.empty() || mine.back() != id)) mine.push_back(id);
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
    used.insert(used.end(), mine.begin(), mine.end());
  }

  PartIndex part_of(std::int64_t id) const {
    const std::uint32_t index = part_index_.find(id);
    return index == IdIndex::kNotFound ? PartIndex() : PartIndex(index);
  }

  NodeIndex node_of(std::int64_t id) const { return NodeIndex(model_.node_index->find(id)); }

  void note_undefined(std::uint32_t file, std::size_t offset, std::string_view what, std::int64_t element, std::int64_t node) {
    deck_.left_out_elements.push_back(element);
    warnings_.note("undefined-node", file, offset,
                   std::string(what) + " " + std::to_string(element) + " names node " + std::to_string(node) +
                       ", which isn't defined; it is left out");
  }

  /// An element that is left out would be torn or squeezed unseen if the nodes it has were moved.
  void hold_by_missing(NodeIndex node) {
    if (node.valid()) model_.node_holds.set(node.value, static_cast<std::uint8_t>(model_.node_holds[node.value] | kHeldByMissing));
  }

  /// Shells of a piece whose nodes are all there; `resolved` gets their node indices.
  struct PieceShells {
    std::vector<ShellNodes> nodes;
    std::vector<std::uint32_t> source;  ///< index in the piece; empty: all are there
  };

  void gather_shells() {
    std::vector<PieceShells> resolved(cards_.size());
    parallel_for(cards_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) resolve_shells(cards_[p].shells, resolved[p]);
    });
    for (std::size_t p = 0; p < cards_.size(); ++p) drop_undefined_shells(p, resolved[p]);
    std::vector<std::size_t> starts = starts_of(cards_, [](const PieceCards& c) { return c.shells.id.size(); });
    auto index = index_of(starts, cards_, shell_ids);
    if (!index->duplicates().empty()) {
      for (std::size_t p = 0; p < cards_.size(); ++p) drop_duplicate_shells(p, *index, starts[p], resolved[p]);
      starts = starts_of(cards_, [](const PieceCards& c) { return c.shells.id.size(); });
      index = index_of(starts, cards_, shell_ids);
    }
    model_.shell_index = std::move(index);
    gather_field(
        model_.shell_ids, starts, cards_, [](PieceCards & c) -> auto& { return c.shells.id; });
    gather(model_.shell_nodes, starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<ShellNodes> out) {
      std::copy_n(resolved[piece].nodes.begin() + static_cast<std::ptrdiff_t>(first), count, out.begin());
    });
    gather(model_.shell_parts, starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<PartIndex> out) {
      for (std::size_t i = 0; i < count; ++i) out[i] = part_of(cards_[piece].shells.part[first + i]);
    });
    gather_thickness(starts);
    gather_midside(starts);
    gather_shell_places(starts);
  }

  void gather_thickness(const std::vector<std::size_t>& starts) {
    const bool any = std::any_of(cards_.begin(), cards_.end(), [](const PieceCards& cards) { return !cards.shells.thickness.empty(); });
    if (!any) {
      model_.shell_thickness = ChunkedArray<float>::filled(starts.back());
      return;
    }
    gather(model_.shell_thickness, starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<float> out) {
      const std::vector<float>& from = cards_[piece].shells.thickness;
      for (std::size_t i = 0; i < count; ++i) out[i] = first + i < from.size() ? from[first + i] : 0;
    });
  }

  void gather_shell_places(const std::vector<std::size_t>& starts) {
    concatenate(starts, cards_, shell_offsets, deck_.shell_line);
    for (std::size_t p = 0; p < cards_.size(); ++p) {
      for (const PieceRun& run : cards_[p].shells.runs) add_run(deck_.shell_runs, starts[p], cards_[p].file, run);
    }
    free_each(cards_, [](PieceCards& cards) { cards.shells = {}; });
    while (!deck_.shell_runs.empty() && deck_.shell_runs.back().first >= starts.back()) deck_.shell_runs.pop_back();
  }

  void resolve_shells(const RawShells& shells, PieceShells& resolved) const {
    resolved.nodes.resize(shells.id.size());
    for (std::size_t i = 0; i < shells.id.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c) resolved.nodes[i].node[c] = node_of(shells.nodes[i][c]);
  }

  void drop_undefined_shells(std::size_t p, PieceShells& resolved) {
    RawShells& shells = cards_[p].shells;
    std::vector<std::uint8_t> keep;
    const auto drop = [&](std::size_t i, std::int64_t node) {
      if (keep.empty()) keep.assign(shells.id.size(), 1);
      if (!keep[i]) return;
      keep[i] = 0;
      note_undefined(cards_[p].file, shells.offset[i], "shell", shells.id[i], node);
    };
    for (std::size_t i = 0; i < resolved.nodes.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c)
        if (!resolved.nodes[i].node[c].valid()) drop(i, shells.nodes[i][c]);
    for (const auto& [shell, nodes] : shells.midside)
      for (const std::int64_t node : nodes)
        if (node > 0 && !node_of(node).valid()) drop(shell, node);
    if (keep.empty()) return;
    for (std::size_t i = 0; i < keep.size(); ++i)
      if (!keep[i])
        for (const NodeIndex node : resolved.nodes[i].node) hold_by_missing(node);
    for (const auto& [shell, nodes] : shells.midside)
      if (!keep[shell])
        for (const std::int64_t node : nodes) hold_by_missing(node_of(node));
    keep_shells(shells, resolved, keep);
  }

  void drop_duplicate_shells(std::size_t p, const IdIndex& index, std::size_t start, PieceShells& resolved) {
    RawShells& shells = cards_[p].shells;
    std::vector<std::uint8_t> keep(shells.id.size());
    for (std::size_t i = 0; i < keep.size(); ++i) {
      keep[i] = index.find(shells.id[i]) == start + i;
      if (!keep[i])
        warnings_.note("duplicate-element", cards_[p].file, shells.offset[i],
                       "shell " + std::to_string(shells.id[i]) + " is defined again; its first definition counts");
    }
    keep_shells(shells, resolved, keep);
  }

  static void keep_shells(RawShells& shells, PieceShells& resolved, const std::vector<std::uint8_t>& keep) {
    if (!shells.thickness.empty()) shells.thickness.resize(keep.size());
    std::vector<std::uint32_t> before(keep.size() + 1);
    for (std::size_t i = 0; i < keep.size(); ++i) before[i + 1] = before[i] + keep[i];
    for (PieceRun& run : shells.runs) run.first = before[run.first];
    std::erase_if(shells.midside, [&](const auto& entry) { return !keep[entry.first]; });
    for (auto& entry : shells.midside) entry.first = before[entry.first];
    keep_only(shells.thickness, keep);
    keep_only(shells.part, keep);
    keep_only(shells.nodes, keep);
    keep_only(shells.offset, keep);
    keep_only(resolved.nodes, keep);
    keep_only(shells.id, keep);
  }

  void gather_midside(const std::vector<std::size_t>& starts) {
    auto midside = std::make_shared<std::vector<MidsideNodes>>();
    for (std::size_t p = 0; p < cards_.size(); ++p)
      for (const auto& [shell, nodes] : cards_[p].shells.midside) {
        MidsideNodes entry{ShellIndex(starts[p] + shell), {}};
        const std::array<std::int64_t, 4>& corners = cards_[p].shells.nodes[shell];
        for (std::size_t i = 0; i < 4; ++i)
          // A triangle's third edge has no length; the node given there is a corner again.
          if (nodes[i] > 0 && !(corners[2] == corners[3] && nodes[i] == corners[2])) entry.node[i] = node_of(nodes[i]);
        midside->push_back(entry);
      }
    model_.midside = std::move(midside);
  }

  void gather_elements() {
    for (int c = 0; c < kElementClassCount; ++c) {
      if (c == static_cast<int>(ElementClass::shell)) continue;
      auto block = std::make_shared<ElementBlock>();
      places_.clear();
      for (std::size_t p = 0; p < cards_.size(); ++p) {
        RawElements& from = cards_[p].elements[static_cast<std::size_t>(c)];
        append_elements(cards_[p].file, static_cast<ElementClass>(c), from, *block);
        from = {};
      }
      drop_duplicate_elements(static_cast<ElementClass>(c), *block);
      model_.elements[static_cast<std::size_t>(c)] = std::move(block);
    }
  }

  void append_elements(std::uint32_t file, ElementClass element_class, const RawElements& from, ElementBlock& block) {
    std::vector<NodeIndex> nodes;
    for (std::size_t e = 0; e < from.id.size(); ++e) {
      nodes.clear();
      bool whole = true;
      for (std::uint32_t n = from.first_node[e]; n < from.first_node[e + 1] && whole; ++n) {
        // Beyond the corners a blank is a mid-side node that isn't there.
        if (from.nodes[n] == 0 && n >= from.first_node[e] + 8) continue;
        nodes.push_back(node_of(from.nodes[n]));
        whole = nodes.back().valid();
        if (!whole) note_undefined(file, from.offset[e], name(element_class), from.id[e], from.nodes[n]);
      }
      if (!whole) {
        for (std::uint32_t n = from.first_node[e]; n < from.first_node[e + 1]; ++n) hold_by_missing(node_of(from.nodes[n]));
        continue;
      }
      places_.push_back({file, from.offset[e]});
      block.id.push_back(from.id[e]);
      block.part.push_back(from.part[e] == 0 && element_class == ElementClass::mass ? PartIndex() : part_of(from.part[e]));
      block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
      block.first_node.push_back(static_cast<std::uint32_t>(block.nodes.size()));
    }
  }

  /// Masses of parts and sets have ids of their own kind, so equal ids among masses say nothing.
  void drop_duplicate_elements(ElementClass element_class, ElementBlock& block) {
    if (element_class == ElementClass::mass || element_class == ElementClass::other) return;
    const IdIndex index(block.id);
    if (index.duplicates().empty()) return;
    ElementBlock kept;
    for (std::size_t e = 0; e < block.size(); ++e) {
      if (index.find(block.id[e]) != e) {
        warnings_.note(
            "duplicate-element", places_[e].file, places_[e].offset,
            std::string(name(element_class)) + " " + std::to_string(block.id[e]) + " is defined again; its first definition counts");
        continue;
      }
      kept.id.push_back(block.id[e]);
      kept.part.push_back(block.part[e]);
      kept.nodes.insert(kept.nodes.end(), block.nodes.begin() + block.first_node[e], block.nodes.begin() + block.first_node[e + 1]);
      kept.first_node.push_back(static_cast<std::uint32_t>(kept.nodes.size()));
    }
    block = std::move(kept);
  }

  std::span<PieceCards> cards_;
  Deck& deck_;
  Warnings& warnings_;
  Model model_;
  IdIndex part_index_;

  struct Place {
    std::uint32_t file;
    std::size_t offset;
  };
  std::vector<Place> places_;  ///< of the cards of the class being gathered
};

}  // namespace

Model assemble(std::span<PieceCards> cards, std::vector<Part> parts, Deck& deck, Warnings& warnings) {
  return Assembler(cards, deck, warnings).run(std::move(parts));
}

}  // namespace prismesh::mesh::deck
