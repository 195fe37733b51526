// Sets of entities of one kind as marks, and the translation of entities of other classes into this kind. Private to mesh/select.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/references.h"
#include "mesh/select/chosen.h"
#include "mesh/select/parse.h"

namespace prismesh::mesh::select {

using Marks = std::vector<std::uint8_t>;  ///< by index of the kind's entities: 1 if it is in the set

/// The ids first, first + step, ... up to last.
struct SteppedIdRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;
};

/// The class of elements kept in Model::elements, or nothing for nodes, parts and shells.
std::optional<ElementClass> block_class(ItemClass item_class);

class Marking {
 public:
  Marking(const Model& model, EntityKind kind) : model_(model), kind_(kind) {}

  EntityKind kind() const { return kind_; }
  Marks nothing() const;
  Marks everything() const;  ///< that exists: without what was removed from the model
  /// The ids of a class of entities.
  const IdIndex& ids_of(ItemClass entity);
  /// Marks the entities of the kind that belong to an entity of any class: of a shell its nodes, of a node the parts around it, ...
  void mark(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value);
  /// Marks the entities with ids of the range. False: there are none. `of_shared`: which shell an id stands for that a quad and a triangle
  /// have; any: both.
  bool mark_ids(Marks& marks, ItemClass entity, const SteppedIdRange& range, std::uint8_t value, ShellKind of_shared = ShellKind::any);
  Chosen chosen(const Marks& marks) const;

 private:
  template <class Body>
  void each_shell(const Body& body) const;
  void mark_nodes(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value);
  void mark_shells(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value);
  void mark_parts(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value);
  void mark_shell_nodes(Marks& marks, std::uint32_t shell, std::uint8_t value);
  void mark_part_blocks(PartIndex part, Marks& marks, std::uint8_t value) const;
  std::span<const std::uint32_t> shells_of(PartIndex part);

  bool mark_shell_ids(Marks& marks, const SteppedIdRange& range, std::uint8_t value, ShellKind of_shared);
  std::vector<std::int64_t> ids_with_corners(ItemClass entity);

  const Model& model_;
  EntityKind kind_;
  std::array<std::unique_ptr<IdIndex>, kItemClassCount> indices_;
  std::array<std::vector<std::uint32_t>, kItemClassCount> shells_;  ///< of quad and tri: the shell of each entry of the index
  std::vector<std::uint32_t> part_first_;
  std::vector<std::uint32_t> part_shells_;
};

}  // namespace prismesh::mesh::select
