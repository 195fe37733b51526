#include "mesh/document/delta.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/document/chosen_criteria.h"
#include "mesh/document/grow_parts.h"
#include "mesh/document/judging_rules.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::uint8_t kVersion = 2;
constexpr std::uint8_t kVersionWithSizes = 3;      ///< as 2, followed by target sizes; written where an edit set any
constexpr std::uint8_t kVersionWithCriteria = 4;   ///< as 3, followed by criteria; written where an edit set any
constexpr std::uint8_t kVersionWithElements = 5;   ///< as 4, with elements, parts and placed nodes; written where an edit added any
constexpr std::uint8_t kVersionWithoutGrowth = 1;  ///< of journals that were written before edits could change the structure

// --- writing ---

class DeltaWriter {
 public:
  void byte(std::uint8_t value) { bytes_.push_back(static_cast<std::byte>(value)); }
  /// Seven bits in each byte, lowest first; the top bit tells that more follow.
  void number(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) byte(static_cast<std::uint8_t>(value | 0x80));
    byte(static_cast<std::uint8_t>(value));
  }
  void bits(double value) {
    const std::uint64_t word = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) byte(static_cast<std::uint8_t>(word >> shift));
  }
  void text(std::string_view value) {
    number(value.size());
    for (const char each : value) byte(static_cast<std::uint8_t>(each));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

void write_moved(const Generation& before, const Generation& after, DeltaWriter& out) {
  const std::vector<NodeIndex> moved = moved_nodes(before.model, after.model);
  out.number(moved.size());
  std::size_t next = 0;
  for (const NodeIndex node : moved) {
    out.number(node.value - next);
    next = node.value + 1;
    const Vec3& position = after.model.position(node);
    for (int k = 0; k < 3; ++k) out.bits(position[k]);
  }
}

void write_corners(const ShellNodes& nodes, DeltaWriter& out) {
  for (const NodeIndex node : nodes.node) out.number(node.value);
}

/// Ascending indices as gaps.
template <class IndexType, class Body>
void write_indices(const std::vector<IndexType>& indices, DeltaWriter& out, const Body& body) {
  out.number(indices.size());
  std::size_t next = 0;
  for (const IndexType index : indices) {
    out.number(index.value - next);
    next = index.value + 1;
    body(index);
  }
}

// What follows, in the second byte of version 5.
constexpr std::uint8_t kHasSizes = 1;
constexpr std::uint8_t kHasCriteria = 2;

// Bits beside the number of an added node's parents.
constexpr std::uint8_t kPlaced = 8;
constexpr std::uint8_t kJoinsShift = 4;  ///< PlacedNode::joins stands in the two bits from here on

/// Writes new entries one by one. None of them is removed: an edit doesn't remove what it adds.
void write_added(const Model& before, const Model& model, DeltaWriter& out) {
  out.number(model.node_count() - before.node_count());
  for (std::size_t n = before.node_count(); n < model.node_count(); ++n) {
    out.number(static_cast<std::uint64_t>(model.node_ids[n]));
    const NodeOrigin& origin = origin_of(model, NodeIndex(n));
    const PlacedNode* placed = placed_node(model, NodeIndex(n));
    const std::uint32_t bits = placed == nullptr ? 0 : kPlaced | placed->joins << kJoinsShift;
    out.byte(static_cast<std::uint8_t>(static_cast<std::uint32_t>(origin.count()) | bits));
    for (std::size_t p = 0; p < static_cast<std::size_t>(origin.count()); ++p) {
      out.number(origin.parent[p].value);
      out.bits(origin.weight[p]);
    }
    for (int k = 0; k < 3; ++k) out.bits(model.positions[n][k]);
  }
  out.number(model.shell_count() - before.shell_count());
  for (std::size_t s = before.shell_count(); s < model.shell_count(); ++s) {
    out.number(static_cast<std::uint64_t>(model.shell_ids[s]));
    out.number(model.topology_change->shell_parents[s - model.topology_change->deck_shells].value);
    write_corners(model.shell_nodes[s], out);
  }
}

void write_optional(const std::optional<std::int64_t>& value, DeltaWriter& out) {
  out.number(value && *value >= 0 ? static_cast<std::uint64_t>(*value) + 1 : 0);
}

void write_optional(const std::optional<double>& value, DeltaWriter& out) {
  out.byte(value ? 1 : 0);
  if (value) out.bits(*value);
}

/// Parts, then the elements of each class.
void write_parts_and_elements(const Model& after, const Changes& changes, DeltaWriter& out) {
  out.number(changes.added_parts.size());
  for (const PartIndex index : changes.added_parts) {
    const Part& part = (*after.parts)[index.value];
    out.number(static_cast<std::uint64_t>(part.id));
    out.text(part.name);
    write_optional(part.section, out);
    write_optional(part.material, out);
    for (const std::optional<double>* value : {&part.thickness, &part.density, &part.youngs_modulus, &part.poissons_ratio})
      write_optional(*value, out);
    out.byte(part.limits_time_step ? 1 : 0);
    out.text(after.topology_change->added_parts[index.value - after.topology_change->deck_parts].cards);
  }
  for (std::size_t c = 1; c < changes.added_elements.size(); ++c) {
    out.number(changes.added_elements[c].size());
    for (const std::uint32_t e : changes.added_elements[c]) {
      const ElementBlock& block = *after.elements[c];
      out.number(static_cast<std::uint64_t>(block.id[e]));
      out.number(block.part[e].valid() ? std::uint64_t{block.part[e].value} + 1 : 0);
      const std::uint32_t example = after.topology_change->element_examples[c][e - after.topology_change->deck_elements[c]];
      out.number(example == kNoExample ? 0 : std::uint64_t{example} + 1);
      out.number(block.first_node[e + 1] - block.first_node[e]);
      for (std::size_t n = block.first_node[e]; n < block.first_node[e + 1]; ++n) out.number(block.nodes[n].value);
    }
  }
}

void write_growth(const Model& before, const Model& after, const Changes& changes, DeltaWriter& out) {
  write_added(before, after, out);
  write_indices(changes.reshaped_shells, out, [&](ShellIndex shell) { write_corners(after.shell(shell), out); });
  write_indices(changes.removed_shells, out, [](ShellIndex) {});
  write_indices(changes.removed_nodes, out, [](NodeIndex) {});
}

struct Run {
  std::size_t first = 0;
  std::size_t count = 0;
  std::uint8_t mark = 0;
};

/// Writes runs of entries that changed to the same mark; new entries had none.
std::vector<Run> changed_runs(const ChunkedArray<std::uint8_t>& before, const ChunkedArray<std::uint8_t>& after) {
  std::vector<Run> runs;
  for (std::size_t c = 0; c < after.chunk_count(); ++c) {
    // The pointers are compared instead of shares_chunk: a grown array shares all chunks but the last.
    const bool known = c < before.chunk_count();
    if (known && after.chunk_owner(c) == before.chunk_owner(c)) continue;
    const std::span<const std::uint8_t> a = known ? before.chunk(c) : std::span<const std::uint8_t>();
    const std::span<const std::uint8_t> b = after.chunk(c);
    for (std::size_t i = 0; i < b.size(); ++i) {
      if ((i < a.size() ? a[i] : 0) == b[i]) continue;
      const std::size_t at = c * kChunkSize + i;
      if (!runs.empty() && runs.back().first + runs.back().count == at && runs.back().mark == b[i])
        ++runs.back().count;
      else
        runs.push_back({at, 1, b[i]});
    }
  }
  return runs;
}

void write_runs(const std::vector<Run>& runs, DeltaWriter& out) {
  out.number(runs.size());
  std::size_t next = 0;
  for (const Run& run : runs) {
    out.number(run.first - next);
    out.number(run.count);
    out.byte(run.mark);
    next = run.first + run.count;
  }
}

std::uint8_t packed(const PartState& state) { return static_cast<std::uint8_t>((state.hidden ? 1 : 0) | (state.locked ? 2 : 0)); }

void write_parts(const Generation& before, const Generation& after, DeltaWriter& out) {
  std::vector<std::size_t> changed;
  if (before.parts != after.parts)
    for (std::size_t p = 0; p < after.parts->size(); ++p)
      if (!((*before.parts)[p] == (*after.parts)[p])) changed.push_back(p);
  out.number(changed.size());
  for (const std::size_t p : changed) {
    out.number(p);
    out.byte(packed((*after.parts)[p]));
  }
}

/// 0: none of its own, 1: guessed from the part, 2: guessed from the deck, 3: a length follows.
void write_size(const std::optional<TargetSize>& size, DeltaWriter& out) {
  if (!size) return out.byte(0);
  if (const double* given = std::get_if<double>(&*size)) {
    out.byte(3);
    out.bits(*given);
    return;
  }
  out.byte(std::get<SizeGuess>(*size) == SizeGuess::part ? 1 : 2);
}

void write_sizes(const Judging& before, const Judging& after, DeltaWriter& out) {
  write_size(after.target_size, out);
  std::vector<PartIndex> changed;
  for (std::size_t p = 0; p < after.parts.size(); ++p)
    if (before.parts[p].target_size != after.parts[p].target_size) changed.emplace_back(p);
  write_indices(changed, out, [&](PartIndex part) { write_size(after.parts[part.value].target_size, out); });
}

bool is_same_own(const std::optional<ChosenCriteria>& a, const std::optional<ChosenCriteria>& b) {
  return a.has_value() == b.has_value() && (!a || is_same_choice(*a, *b));
}

bool have_same_criteria(const Judging& a, const Judging& b) {
  return is_same_choice(a.criteria, b.criteria) &&
         std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(),
                    [](const PartChoice& of_a, const PartChoice& of_b) { return is_same_own(of_a.criteria, of_b.criteria); });
}

/// The criteria that are new, each once, then who has which: 0 for none chosen, or a place in that list, from 1.
void write_criteria(const Judging& before, const Judging& after, DeltaWriter& out) {
  std::vector<const ChosenCriteria*> listed;
  const auto place = [&](const ChosenCriteria& chosen) {
    const auto found =
        std::find_if(listed.begin(), listed.end(), [&](const ChosenCriteria* each) { return is_same_choice(*each, chosen); });
    const auto at = static_cast<std::uint64_t>(found - listed.begin());
    if (found == listed.end()) listed.push_back(&chosen);
    return at + 1;
  };
  const std::uint64_t of_deck = after.criteria.name.empty() ? 0 : place(after.criteria);
  std::vector<PartIndex> changed;
  std::vector<std::uint64_t> places;
  for (std::size_t p = 0; p < after.parts.size(); ++p) {
    const std::optional<ChosenCriteria>& own = after.parts[p].criteria;
    if (is_same_own(before.parts[p].criteria, own)) continue;
    changed.emplace_back(p);
    places.push_back(own ? place(*own) : 0);
  }
  out.number(listed.size());
  for (const ChosenCriteria* each : listed) {
    out.text(each->name);
    out.text(*each->text);
  }
  out.number(of_deck);
  std::size_t next = 0;
  write_indices(changed, out, [&](PartIndex) { out.number(places[next++]); });
}

// --- reading ---

/// Reads numbers; after the end or a bad one everything is 0 and ok() is false.
class DeltaReader {
 public:
  explicit DeltaReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && next_ == bytes_.size(); }
  std::size_t left() const { return bytes_.size() - next_; }

  std::uint8_t byte() {
    if (next_ >= bytes_.size()) ok_ = false;
    return ok_ ? std::to_integer<std::uint8_t>(bytes_[next_++]) : std::uint8_t{0};
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      const std::uint8_t part = byte();
      value |= static_cast<std::uint64_t>(part & 0x7f) << shift;
      if (part < 0x80) return ok_ ? value : 0;
    }
    ok_ = false;
    return 0;
  }
  double bits() {
    std::uint64_t word = 0;
    for (int shift = 0; shift < 64; shift += 8) word |= static_cast<std::uint64_t>(byte()) << shift;
    return std::bit_cast<double>(word);
  }
  std::string text() {
    const std::uint64_t size = count(1);
    std::string value;
    for (std::uint64_t i = 0; i < size; ++i) value += static_cast<char>(byte());
    return value;
  }
  /// A count of entries of at least `bytes_each` bytes; 0 if so many can't follow, so that no memory is reserved for them.
  std::uint64_t count(std::size_t bytes_each) {
    const std::uint64_t value = number();
    if (value > left() / bytes_each) ok_ = false;
    return ok_ ? value : 0;
  }
  void refuse() { ok_ = false; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t next_ = 0;
  bool ok_ = true;
};

/// Reads an existing node below `end`.
NodeIndex read_node(DeltaReader& in, const Model& model, std::size_t end) {
  const std::uint64_t value = in.number();
  if (!in.ok() || value >= end || model.is_removed(NodeIndex(static_cast<std::size_t>(value)))) {
    in.refuse();
    return {};
  }
  return NodeIndex(static_cast<std::size_t>(value));
}

ShellNodes read_corners(DeltaReader& in, const Model& model) {
  ShellNodes nodes;
  for (NodeIndex& node : nodes.node) node = read_node(in, model, model.node_count());
  return nodes;
}

/// Reads an id that isn't in the index.
std::int64_t read_id(DeltaReader& in, const IdIndex& taken) {
  const std::uint64_t value = in.number();
  const auto id = static_cast<std::int64_t>(value);  // max 63 bits
  if (!in.ok() || value == 0 || taken.find(id) != IdIndex::kNotFound) {
    in.refuse();
    return 0;
  }
  return id;
}

/// `with_placed`: nodes may lie between no others.
void read_added_nodes(DeltaReader& in, bool with_placed, Model& model) {
  const std::uint64_t count = in.count(35);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::int64_t id = read_id(in, *model.node_index);
    const std::uint8_t kind = in.byte();
    const bool placed = (kind & kPlaced) != 0;
    const auto joins = static_cast<std::uint32_t>(kind >> kJoinsShift);
    const int parents = kind & (kPlaced - 1);
    if (!in.ok() || parents < 1 || parents > 4 || (placed && !with_placed) || joins > kJoinsTies || (joins != kJoinsNone && !placed))
      return in.refuse();
    NodeOrigin origin;
    for (std::size_t p = 0; p < static_cast<std::size_t>(parents); ++p) {
      origin.parent[p] = read_node(in, model, model.node_count());
      origin.weight[p] = in.bits();
      if (!in.ok() || !(origin.weight[p] > 0 && origin.weight[p] <= 1)) return in.refuse();
    }
    Vec3 position;
    for (int k = 0; k < 3; ++k) position[k] = in.bits();
    if (!in.ok() || !position.allFinite()) return in.refuse();
    if (placed)
      add_placed_node(model, id, position, origin, joins);
    else
      add_node(model, id, position, origin);
  }
}

std::optional<std::int64_t> read_optional_id(DeltaReader& in) {
  const std::uint64_t value = in.number();
  return value == 0 ? std::nullopt : std::optional(static_cast<std::int64_t>(value - 1));
}

std::optional<double> read_optional_number(DeltaReader& in) {
  const std::uint8_t is_there = in.byte();
  if (is_there > 1) in.refuse();
  return is_there == 1 ? std::optional(in.bits()) : std::nullopt;
}

void read_new_parts(DeltaReader& in, Model& model) {
  const std::uint64_t count = in.count(10);
  for (std::uint64_t i = 0; i < count; ++i) {
    Part part;
    part.id = static_cast<std::int64_t>(in.number());
    part.defined = true;
    part.name = in.text();
    part.section = read_optional_id(in);
    part.material = read_optional_id(in);
    for (std::optional<double>* value : {&part.thickness, &part.density, &part.youngs_modulus, &part.poissons_ratio})
      *value = read_optional_number(in);
    const std::uint8_t limits = in.byte();
    AddedPart added{in.text()};
    if (!in.ok() || limits > 1 || part.id < 1 || (!model.parts->empty() && part.id <= model.parts->back().id)) return in.refuse();
    part.limits_time_step = limits == 1;
    add_part(model, std::move(part), std::move(added));
  }
}

void read_elements_of(DeltaReader& in, ElementClass element_class, Model& model) {
  const auto c = static_cast<std::size_t>(element_class);
  const std::uint64_t count = in.count(5);
  if (count == 0) return;
  std::vector<std::int64_t> taken = model.elements[c] ? model.elements[c]->id : std::vector<std::int64_t>();
  std::sort(taken.begin(), taken.end());
  // elements that were added before are no examples
  const std::size_t in_deck = model.topology_change ? model.topology_change->deck_elements[c] : taken.size();
  std::vector<std::int64_t> given;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto id = static_cast<std::int64_t>(in.number());
    const std::uint64_t part = in.number(), example = in.number();
    std::vector<NodeIndex> nodes(in.count(1));
    for (NodeIndex& node : nodes) node = read_node(in, model, model.node_count());
    if (!in.ok() || id < 1 || std::binary_search(taken.begin(), taken.end(), id) || part > model.parts->size() || example > in_deck ||
        nodes.empty())
      return in.refuse();
    given.push_back(id);
    add_element(model, element_class, id, part == 0 ? PartIndex() : PartIndex(static_cast<std::size_t>(part - 1)), nodes,
                example == 0 ? kNoExample : static_cast<std::uint32_t>(example - 1));
  }
  std::sort(given.begin(), given.end());
  if (std::adjacent_find(given.begin(), given.end()) != given.end()) in.refuse();
}

void read_parts_and_elements(DeltaReader& in, Model& model) {
  if (!model.parts) return in.refuse();
  read_new_parts(in, model);
  for (std::size_t c = 1; c < model.elements.size() && in.ok(); ++c) read_elements_of(in, static_cast<ElementClass>(c), model);
}

/// Calls `body` with each of ascending indices below `end`.
template <class IndexType, class Body>
void read_indices(DeltaReader& in, std::size_t bytes_each, std::size_t end, const Body& body) {
  const std::uint64_t count = in.count(bytes_each);
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t gap = in.number();
    if (!in.ok() || gap >= end - next) return in.refuse();
    body(IndexType(static_cast<std::size_t>(next + gap)));
    if (!in.ok()) return;
    next += gap + 1;
  }
}

void read_growth(DeltaReader& in, bool with_elements, Model& model) {
  const std::size_t nodes_before = model.node_count(), shells_before = model.shell_count();
  read_added_nodes(in, with_elements, model);
  const std::uint64_t count = in.ok() ? in.count(6) : 0;
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
    const std::int64_t id = read_id(in, *model.shell_index);
    const std::uint64_t parent = in.number();
    const ShellNodes corners = read_corners(in, model);
    if (!in.ok() || parent >= shells_before || model.is_removed(ShellIndex(static_cast<std::size_t>(parent)))) return in.refuse();
    add_shell(model, id, corners, ShellIndex(static_cast<std::size_t>(parent)));
  }
  read_indices<ShellIndex>(in, 5, shells_before, [&](ShellIndex shell) {
    const ShellNodes corners = read_corners(in, model);
    if (!in.ok() || model.is_removed(shell)) return in.refuse();
    set_shell_nodes(model, shell, corners);
  });
  read_indices<ShellIndex>(in, 1, shells_before, [&](ShellIndex shell) {
    if (model.is_removed(shell)) return in.refuse();
    remove_shell(model, shell);
  });
  read_indices<NodeIndex>(in, 1, nodes_before, [&](NodeIndex node) {
    if (model.is_removed(node)) return in.refuse();
    remove_node(model, node);
  });
}

NodeSet read_moved(DeltaReader& in, Model& model) {
  NodeSet moved;
  const std::uint64_t count = in.count(25);
  moved.reserve(count);
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t gap = in.number();
    Vec3 position;
    for (int k = 0; k < 3; ++k) position[k] = in.bits();
    if (!in.ok() || gap >= model.node_count() - next || !position.allFinite()) {
      in.refuse();
      return moved;
    }
    moved.emplace_back(static_cast<std::size_t>(next + gap));
    if (model.is_removed(moved.back())) {
      in.refuse();
      return moved;
    }
    model.positions.set(moved.back().value, position);
    next += gap + 1;
  }
  return moved;
}

/// Returns by how much the number of selected entries grew.
std::int64_t read_runs(DeltaReader& in, std::uint8_t known_bits, ChunkedArray<std::uint8_t>& marks) {
  std::int64_t selected = 0;
  const std::uint64_t count = in.count(3);
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t gap = in.number();
    const std::uint64_t length = in.number();
    const std::uint8_t mark = in.byte();
    if (!in.ok() || gap > marks.size() - next || length == 0 || length > marks.size() - next - gap || (mark & ~known_bits) != 0) {
      in.refuse();
      return 0;
    }
    const std::size_t first = static_cast<std::size_t>(next + gap);
    next = first + length;
    for (std::size_t at = first; at < next; ++at) {
      selected += ((mark & kSelected) != 0 ? 1 : 0) - ((marks[at] & kSelected) != 0 ? 1 : 0);
      marks.set(at, mark);
    }
  }
  return selected;
}

void read_parts(DeltaReader& in, Generation& generation) {
  const std::uint64_t count = in.count(2);
  if (count == 0) return;
  auto parts = std::make_shared<std::vector<PartState>>(*generation.parts);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t part = in.number();
    const std::uint8_t state = in.byte();
    if (!in.ok() || part >= parts->size() || state > 3) return in.refuse();
    (*parts)[part] = {(state & 1) != 0, (state & 2) != 0};
  }
  generation.parts = std::move(parts);
}

std::optional<TargetSize> read_size(DeltaReader& in) {
  switch (in.byte()) {
    case 0: return std::nullopt;
    case 1: return SizeGuess::part;
    case 2: return SizeGuess::deck;
    case 3: break;
    default: in.refuse(); return std::nullopt;
  }
  const TargetSize size(in.bits());
  if (!in.ok() || !check_target_size(size)) in.refuse();
  return size;
}

void read_sizes(DeltaReader& in, Judging& judging) {
  const std::optional<TargetSize> of_all = read_size(in);
  if (!of_all) return in.refuse();
  judging.target_size = *of_all;
  read_indices<PartIndex>(in, 2, judging.parts.size(), [&](PartIndex part) { judging.parts[part.value].target_size = read_size(in); });
}

void read_criteria(DeltaReader& in, Judging& judging) {
  const double scale = judging.criteria.criteria->time_step_scale;
  std::vector<ChosenCriteria> listed;
  const std::uint64_t count = in.count(2);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string name = in.text();
    std::string text = in.text();
    if (!in.ok() || name.empty()) return in.refuse();
    Result<ChosenCriteria> chosen = read_chosen_criteria(name, std::move(text), scale);
    if (!chosen) return in.refuse();
    listed.push_back(shared_choice(judging, std::move(*chosen)));
  }
  const auto read_place = [&]() -> std::optional<ChosenCriteria> {
    const std::uint64_t place = in.number();
    if (place > listed.size()) in.refuse();
    if (!in.ok() || place == 0) return std::nullopt;
    return listed[static_cast<std::size_t>(place - 1)];
  };
  const std::optional<ChosenCriteria> of_deck = read_place();
  judging.criteria = of_deck ? *of_deck : shared_choice(judging, default_choice(scale));
  read_indices<PartIndex>(in, 2, judging.parts.size(), [&](PartIndex part) { judging.parts[part.value].criteria = read_place(); });
}

void read_judging(DeltaReader& in, bool with_criteria, Generation& generation) {
  auto judging = std::make_shared<Judging>(*generation.judging);
  read_sizes(in, *judging);
  if (with_criteria && in.ok()) read_criteria(in, *judging);
  if (!in.ok()) return;
  settle(*judging);
  generation.judging = std::move(judging);
}

std::size_t grown(std::size_t size, std::int64_t by) { return static_cast<std::size_t>(static_cast<std::int64_t>(size) + by); }

std::vector<std::byte> encode_delta_of(const Generation& before, const Generation& after, const Changes& changes) {
  DeltaWriter out;
  const bool has_sizes = before.judging != after.judging && before.judging && after.judging;
  const bool has_criteria = has_sizes && !have_same_criteria(*before.judging, *after.judging);
  const std::size_t nodes_before = before.model.node_count();
  const std::vector<PlacedNode>* placed = after.model.topology_change ? &after.model.topology_change->placed_nodes : nullptr;
  const bool has_placed = placed != nullptr && !placed->empty() && placed->back().node.value >= nodes_before;
  const bool has_elements = has_placed || changes.other_elements() > 0 || !changes.added_parts.empty();
  out.byte(has_elements ? kVersionWithElements : has_criteria ? kVersionWithCriteria : has_sizes ? kVersionWithSizes : kVersion);
  if (has_elements) out.byte(static_cast<std::uint8_t>((has_sizes ? kHasSizes : 0) | (has_criteria ? kHasCriteria : 0)));
  write_growth(before.model, after.model, changes, out);
  if (has_elements) write_parts_and_elements(after.model, changes, out);
  write_moved(before, after, out);
  write_runs(changed_runs(before.node_marks, after.node_marks), out);
  write_runs(changed_runs(before.shell_marks, after.shell_marks), out);
  out.byte(static_cast<std::uint8_t>(after.selection_kind));
  write_parts(before, after, out);
  if (has_sizes) write_sizes(*before.judging, *after.judging, out);
  if (has_criteria) write_criteria(*before.judging, *after.judging, out);
  return out.take();
}

}  // namespace

std::vector<std::byte> encode_delta(const Generation& before, const Generation& after) {
  const Changes changes = changes_between(before.model, after.model);
  if (!changes.added_parts.empty()) {
    // What the new parts are judged by, and their states, are compared with those of new parts.
    Generation grown = before;
    grow_parts(after.model.parts->size(), grown);
    return encode_delta_of(grown, after, changes);
  }
  return encode_delta_of(before, after, changes);
}

Result<NodeSet> apply_delta(std::span<const std::byte> delta, Generation& generation) {
  DeltaReader in(delta);
  const std::uint8_t version = in.byte();
  if (version < kVersionWithoutGrowth || version > kVersionWithElements) return fail("", "its delta is of another version");
  const bool with_elements = version == kVersionWithElements;
  const std::uint8_t has = with_elements                     ? in.byte()
                           : version == kVersionWithCriteria ? kHasSizes | kHasCriteria
                           : version == kVersionWithSizes    ? kHasSizes
                                                             : 0;
  if (has > (kHasSizes | kHasCriteria) || has == kHasCriteria) in.refuse();
  if (version != kVersionWithoutGrowth) read_growth(in, with_elements, generation.model);
  if (with_elements && in.ok()) read_parts_and_elements(in, generation.model);
  if (!in.ok()) return fail("", "its delta doesn't fit the model");
  if (generation.model.parts) grow_parts(generation.model.parts->size(), generation);
  generation.node_marks.resize(generation.model.node_count());
  generation.shell_marks.resize(generation.model.shell_count());
  NodeSet moved = read_moved(in, generation.model);
  generation.selected_nodes = grown(generation.selected_nodes, read_runs(in, kSelected | kLocked | kHidden, generation.node_marks));
  generation.selected_shells = grown(generation.selected_shells, read_runs(in, kSelected, generation.shell_marks));
  const std::uint8_t kind = in.byte();
  if (kind > static_cast<std::uint8_t>(select::EntityKind::part)) in.refuse();
  generation.selection_kind = static_cast<select::EntityKind>(kind);
  read_parts(in, generation);
  if ((has & kHasSizes) != 0) {
    if (!generation.judging) return fail("", "its delta doesn't fit the model");
    read_judging(in, (has & kHasCriteria) != 0, generation);
  }
  if (!in.at_end()) return fail("", "its delta doesn't fit the model");
  return moved;
}

}  // namespace prismesh::mesh::document
