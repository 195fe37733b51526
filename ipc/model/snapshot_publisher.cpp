#include "ipc/model/snapshot_publisher.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "ipc/model/snapshot_table.h"
#include "mesh/document/cluster_signs.h"
#include "mesh/document/damage.h"
#include "mesh/document/shell_damage.h"
#include "mesh/model/element_lines.h"
#include "mesh/model/topology_change.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::ipc {

namespace {

using mesh::document::Document;
using mesh::document::Generation;

constexpr std::size_t kPage = 4096;

std::size_t index_of(SnapshotArray array) { return static_cast<std::size_t>(array); }

/// Bytes of a whole chunk, in whole pages.
std::size_t slot_bytes(SnapshotArray array) { return (mesh::kChunkSize * element_size(array) + kPage - 1) / kPage * kPage; }

/// Shared memory for chunks of one array.
struct Segment {
  std::uint64_t number = 0;
  Descriptor descriptor;
  Mapping mapping;
  std::size_t slots = 0;
  std::size_t backed = 0;         ///< slots that have memory; the others were never written
  std::size_t used = 0;           ///< slots that hold a chunk
  std::vector<std::size_t> free;  ///< empty slots; the last is used next
};

/// A chunk of a generation in shared memory, kept as long as a snapshot needs it.
struct Copy {
  std::shared_ptr<const void> owner;  ///< kept alive: the address identifies the content only as long
  SnapshotArray array{};
  Segment* segment = nullptr;
  std::size_t slot = 0;
  std::size_t bytes = 0;
  std::uint64_t version = 0;
  std::size_t users = 0;  ///< snapshots that hold it
};

struct ArraySpace {
  std::vector<std::unique_ptr<Segment>> segments;
  std::unordered_map<const void*, Copy*> by_owner;
};

/// A published generation: its table and what it holds. Lives while it is current or leased.
struct Published {
  Descriptor table;
  std::vector<std::uint64_t> segments;
  std::vector<Copy*> copies;
};

/// A snapshot can be reused if this is equal.
struct Wanted {
  std::shared_ptr<const Generation> generation;
  std::shared_ptr<const mesh::deck::Deck> deck;
  bool can_undo = false;
  bool can_redo = false;
  bool changed = false;
  bool operator==(const Wanted&) const = default;
};

/// Figures that depend on the elements alone and are computed once for a model.
struct PerModel {
  std::array<std::shared_ptr<const mesh::ElementBlock>, mesh::kElementClassCount> elements;
  mesh::ElementLines lines;
  mesh::ChunkedArray<mesh::PartIndex> shell_parts;
  std::shared_ptr<const mesh::TopologyChange> topology_change;
  std::shared_ptr<const std::vector<mesh::Part>> parts;
  std::vector<std::uint32_t> shells_of_part;
  std::vector<std::array<float, 2>> thicknesses_of_part;
};

bool same_chunks(const mesh::ChunkedArray<mesh::PartIndex>& a, const mesh::ChunkedArray<mesh::PartIndex>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t c = 0; c < a.chunk_count(); ++c)
    if (!a.shares_chunk(b, c)) return false;
  return true;
}

/// The smallest and largest thickness of each part's shells; zeros where a shell has none.
std::vector<std::array<float, 2>> thicknesses(const mesh::Model& model) {
  std::vector<std::array<float, 2>> found(model.parts ? model.parts->size() : 0, {0, 0});
  std::vector<std::uint8_t> known(found.size(), 0);
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const mesh::PartIndex part = model.shell_parts[s];
    if (part.value >= found.size() || model.is_removed(mesh::ShellIndex(s))) continue;
    const float thickness = mesh::quality::thickness_of(model, s);
    auto& [thinnest, thickest] = found[part.value];
    const bool first = std::exchange(known[part.value], std::uint8_t{1}) == 0;
    thinnest = first ? thickness : std::min(thinnest, thickness);
    thickest = first ? thickness : std::max(thickest, thickness);
  }
  for (auto& range : found)
    if (range[0] <= 0) range = {0, 0};
  return found;
}

std::vector<std::uint32_t> count_shells(const mesh::Model& model) {
  std::vector<std::uint32_t> counts(model.parts ? model.parts->size() : 0);
  for (std::size_t c = 0; c < model.shell_parts.chunk_count(); ++c)
    for (const mesh::PartIndex part : model.shell_parts.chunk(c))
      if (part.value < counts.size()) ++counts[part.value];
  if (model.topology_change)
    for (const mesh::ShellIndex gone : model.topology_change->removed_shells)
      if (const mesh::PartIndex part = model.shell_parts[gone.value]; part.value < counts.size()) --counts[part.value];
  return counts;
}

}  // namespace

struct SnapshotPublisher::Impl {
  explicit Impl(std::uint64_t first_number) : next_number(first_number) {}

  mutable std::mutex mutex;
  std::uint64_t next_number;  ///< of versions and segments
  std::uint64_t next_lease = 1;
  std::size_t bytes_copied = 0;
  std::array<ArraySpace, kSnapshotArrayCount> spaces;
  std::unordered_map<const Copy*, std::unique_ptr<Copy>> copies;
  std::optional<Wanted> current_of;
  std::shared_ptr<Published> current;
  std::map<std::uint64_t, std::shared_ptr<Published>> leases;
  PerModel per_model;
  mesh::document::ShellDamage damage;
  mesh::document::ClusterSigns clusters;
  std::shared_ptr<const Generation> opened_judged, opened_judged_from;  ///< see opened_as_judged()

  void look_at(const mesh::Model& model) {
    if (per_model.elements != model.elements) {
      per_model.elements = model.elements;
      per_model.lines = element_lines(model);
    }
    if (per_model.parts != model.parts || per_model.topology_change != model.topology_change ||
        !same_chunks(per_model.shell_parts, model.shell_parts)) {
      per_model.parts = model.parts;
      per_model.topology_change = model.topology_change;
      per_model.shell_parts = model.shell_parts;
      per_model.shells_of_part = count_shells(model);
      per_model.thicknesses_of_part = thicknesses(model);
    }
  }

  /// A segment with a free slot. New segments grow with the array, so that their number stays small.
  Result<Segment*> room_for(SnapshotArray array, std::size_t still_to_come) {
    ArraySpace& space = spaces[index_of(array)];
    std::size_t slots = 0;
    for (const auto& segment : space.segments) {
      if (segment->used < segment->slots) return segment.get();
      slots += segment->slots;
    }
    auto segment = std::make_unique<Segment>();
    segment->slots = std::max({still_to_come, slots / 2, std::size_t{4}});
    Result<Descriptor> memory = make_shared_memory("prismesh-snapshot", segment->slots * slot_bytes(array));
    if (!memory) return fail(std::move(memory.error()));
    Result<Mapping> mapping = Mapping::map(*memory, true);
    if (!mapping) return fail(std::move(mapping.error()));
    if (Result<void> sealed = seal_for_readers(*memory); !sealed) return fail(std::move(sealed.error()));
    segment->number = next_number++;
    segment->descriptor = std::move(*memory);
    segment->mapping = std::move(*mapping);
    space.segments.push_back(std::move(segment));
    return space.segments.back().get();
  }

  Result<std::size_t> take_slot(Segment& segment, SnapshotArray array) {
    std::size_t slot = segment.backed;
    if (!segment.free.empty()) {
      slot = segment.free.back();
      segment.free.pop_back();
    } else {
      if (Result<void> backed = reserve(segment.descriptor, slot * slot_bytes(array), slot_bytes(array)); !backed)
        return fail(std::move(backed.error()));
      ++segment.backed;
    }
    ++segment.used;
    return slot;
  }

  /// The chunk in shared memory; copies it if it isn't there yet.
  Result<Copy*> hold(SnapshotArray array, std::shared_ptr<const void> owner, std::span<const std::byte> bytes, std::size_t still_to_come) {
    ArraySpace& space = spaces[index_of(array)];
    if (const auto known = space.by_owner.find(owner.get()); known != space.by_owner.end() && known->second->bytes >= bytes.size()) {
      ++known->second->users;
      return known->second;
    }
    Result<Segment*> segment = room_for(array, still_to_come);
    if (!segment) return fail(std::move(segment.error()));
    const Result<std::size_t> slot = take_slot(**segment, array);
    if (!slot) return fail(slot.error());
    auto copy = std::make_unique<Copy>();
    copy->owner = std::move(owner);
    copy->array = array;
    copy->segment = *segment;
    copy->slot = *slot;
    copy->bytes = bytes.size();
    copy->version = next_number++;
    copy->users = 1;
    std::memcpy((*segment)->mapping.writable_bytes().data() + *slot * slot_bytes(array), bytes.data(), bytes.size());
    bytes_copied += bytes.size();
    Copy* held = copy.get();
    space.by_owner[held->owner.get()] = held;
    copies.emplace(held, std::move(copy));
    return held;
  }

  void let_go(Copy* copy) {
    if (--copy->users > 0) return;
    ArraySpace& space = spaces[index_of(copy->array)];
    if (const auto known = space.by_owner.find(copy->owner.get()); known != space.by_owner.end() && known->second == copy)
      space.by_owner.erase(known);
    copy->segment->free.push_back(copy->slot);
    --copy->segment->used;
    copies.erase(copy);
  }

  void drop(std::shared_ptr<Published>& published) {
    if (published && published.use_count() == 1)
      for (Copy* copy : published->copies) let_go(copy);
    published.reset();
  }

  /// Frees memory that no snapshot uses, except one empty segment for each array.
  void shrink() {
    for (ArraySpace& space : spaces) {
      bool kept_one = false;
      std::erase_if(space.segments, [&](const std::unique_ptr<Segment>& segment) {
        return segment->used == 0 && current && std::exchange(kept_one, true);
      });
      if (!current) std::erase_if(space.segments, [](const std::unique_ptr<Segment>& segment) { return segment->used == 0; });
    }
  }

  template <class T>
  Result<void> add(SnapshotArray array, const mesh::ChunkedArray<T>& source, Published& published, SnapshotTable& table) {
    static_assert(std::is_trivially_copyable_v<T> || std::is_same_v<T, mesh::Vec3>);
    TableArray& pieces = table.arrays[index_of(array)];
    pieces.count = source.size();
    for (std::size_t c = 0; c < source.chunk_count(); ++c) {
      const Result<Copy*> copy = hold(array, source.chunk_owner(c), std::as_bytes(source.chunk(c)), source.chunk_count() - c);
      if (!copy) return fail(copy.error());
      published.copies.push_back(*copy);
      const std::uint64_t number = (*copy)->segment->number;
      // Chunks of one array come from few segments: the list is short.
      auto place = std::find(published.segments.begin(), published.segments.end(), number);
      if (place == published.segments.end()) place = published.segments.insert(place, number);
      pieces.pieces.push_back(
          {static_cast<std::uint64_t>(place - published.segments.begin()), (*copy)->slot * slot_bytes(array), (*copy)->version});
    }
    return {};
  }

  /// What damage is measured from; made anew only when target sizes or criteria were set.
  std::shared_ptr<const Generation> opened_as_judged(const Document& document) {
    const std::shared_ptr<const mesh::document::Judging>& judging = document.current().judging;
    if (!opened_judged || opened_judged_from != document.opened || opened_judged->judging != judging) {
      opened_judged = mesh::document::opened_as_judged(document, document.current());
      opened_judged_from = document.opened;
    }
    return opened_judged;
  }

  Result<void> add_arrays(const Document& document, Published& published, SnapshotTable& table) {
    const Generation& generation = document.current();
    const mesh::Model& model = generation.model;
    Result<void> done = add(SnapshotArray::positions, model.positions, published, table);
    const auto next = [&](SnapshotArray array, const auto& source) {
      if (done) done = add(array, source, published, table);
    };
    next(SnapshotArray::node_ids, model.node_ids);
    next(SnapshotArray::node_marks, generation.node_marks);
    next(SnapshotArray::shell_nodes, model.shell_nodes);
    next(SnapshotArray::shell_ids, model.shell_ids);
    next(SnapshotArray::shell_parts, model.shell_parts);
    next(SnapshotArray::shell_marks, generation.shell_marks);
    next(SnapshotArray::shell_quality, generation.quality);
    next(SnapshotArray::shell_damage, damage.of(opened_as_judged(document), generation));
    next(SnapshotArray::line_nodes, per_model.lines.nodes);
    next(SnapshotArray::line_parts, per_model.lines.parts);
    next(SnapshotArray::clusters, clusters.of(document.opened, generation));
    return done;
  }

  SnapshotInfo describe(const Document& document, bool changed) const {
    const Generation& generation = document.current();
    SnapshotInfo info;
    info.generation = generation.number;
    info.document = document.path.string();
    info.length_unit = std::string(name(document.settings.length_unit));
    info.target_size = generation.judging ? generation.judging->deck_size : document.settings.target_size;
    info.criteria = generation.judging ? generation.judging->criteria.name : "";
    if (info.criteria.empty()) info.criteria = mesh::quality::built_in_criteria().front();
    info.counts = generation.counts;
    info.nodes = mesh::live_nodes(generation.model);
    info.selected_nodes = generation.selected_nodes;
    info.selected_shells = generation.selected_shells;
    info.can_undo = document.can_undo();
    info.can_redo = document.can_redo();
    info.changed = changed;
    const std::vector<mesh::Part> none;
    const std::vector<mesh::Part>& parts = generation.model.parts ? *generation.model.parts : none;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const bool has_state = generation.parts && p < generation.parts->size();
      const mesh::document::PartState state = has_state ? (*generation.parts)[p] : mesh::document::PartState{};
      ipc::SnapshotPart part{parts[p].id, parts[p].name, state.hidden, state.locked, per_model.shells_of_part[p], info.target_size, {}, {}};
      std::tie(part.thinnest, part.thickest) = std::tie(per_model.thicknesses_of_part[p][0], per_model.thicknesses_of_part[p][1]);
      if (generation.judging && p < generation.judging->parts.size()) {
        const mesh::quality::PartCriteria& judged = generation.judging->by_part.of(mesh::PartIndex(p));
        part.target_size = judged.target_size;
        part.size_from = judged.size_from;
        if (const auto& own = generation.judging->parts[p].criteria) part.criteria = own->name;
      }
      info.parts.push_back(std::move(part));
    }
    return info;
  }

  Result<std::shared_ptr<Published>> make(const Document& document, bool changed) {
    look_at(document.current().model);
    auto published = std::make_shared<Published>();
    SnapshotTable table;
    table.info = describe(document, changed);
    Result<void> added = add_arrays(document, *published, table);
    if (added) {
      Result<Descriptor> sealed = make_sealed_memory("prismesh-table", encode_table(table));
      if (sealed) {
        published->table = std::move(*sealed);
        return published;
      }
      added = fail(std::move(sealed.error()));
    }
    drop(published);
    return fail(std::move(added.error()));
  }

  Result<PublishedSnapshot> lease(const std::shared_ptr<Published>& published) {
    Result<Descriptor> table = published->table.duplicate();
    if (!table) return fail(std::move(table.error()));
    const std::uint64_t number = next_lease++;
    leases.emplace(number, published);
    return PublishedSnapshot{number, std::move(*table), published->segments};
  }
};

SnapshotPublisher::SnapshotPublisher(std::uint64_t first_number) : impl_(std::make_unique<Impl>(first_number)) {}
SnapshotPublisher::~SnapshotPublisher() = default;

Result<PublishedSnapshot> SnapshotPublisher::publish(const Document& document, bool changed) {
  const std::lock_guard lock(impl_->mutex);
  const Wanted wanted{document.generations[document.cursor], document.deck, document.can_undo(), document.can_redo(), changed};
  if (!impl_->current || impl_->current_of != wanted) {
    Result<std::shared_ptr<Published>> made = impl_->make(document, changed);
    if (!made) return fail(std::move(made.error()));
    std::swap(impl_->current, *made);
    impl_->current_of = wanted;
    impl_->drop(*made);
    impl_->shrink();
  }
  return impl_->lease(impl_->current);
}

Result<PublishedSnapshot> SnapshotPublisher::publish_other(const Document& document, std::size_t generation, bool changed) {
  if (generation == document.cursor) return publish(document, changed);
  Document at_it = document;
  at_it.cursor = generation;
  const std::lock_guard lock(impl_->mutex);
  Result<std::shared_ptr<Published>> made = impl_->make(at_it, changed);
  if (!made) return fail(std::move(made.error()));
  Result<PublishedSnapshot> leased = impl_->lease(*made);
  if (!leased) impl_->drop(*made);
  return leased;
}

void SnapshotPublisher::forget() {
  const std::lock_guard lock(impl_->mutex);
  impl_->current_of.reset();
  impl_->drop(impl_->current);
  impl_->per_model = {};
  impl_->damage = {};
  impl_->clusters = {};
  impl_->opened_judged.reset();
  impl_->opened_judged_from.reset();
  impl_->shrink();
}

void SnapshotPublisher::release(std::uint64_t lease) {
  const std::lock_guard lock(impl_->mutex);
  const auto held = impl_->leases.find(lease);
  if (held == impl_->leases.end()) return;
  std::shared_ptr<Published> published = std::move(held->second);
  impl_->leases.erase(held);
  impl_->drop(published);
  impl_->shrink();
}

Result<Descriptor> SnapshotPublisher::segment(std::uint64_t id) const {
  const std::lock_guard lock(impl_->mutex);
  for (const ArraySpace& space : impl_->spaces)
    for (const auto& segment : space.segments)
      if (segment->number == id) return segment->descriptor.duplicate();
  return fail("snapshot", "segment " + std::to_string(id) + " is gone");
}

std::size_t SnapshotPublisher::bytes_copied() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->bytes_copied;
}

std::size_t SnapshotPublisher::bytes_held() const {
  const std::lock_guard lock(impl_->mutex);
  std::size_t bytes = 0;
  for (const ArraySpace& space : impl_->spaces)
    for (const auto& segment : space.segments) bytes += segment->mapping.bytes().size();
  return bytes;
}

}  // namespace prismesh::ipc
