// Entities of one kind as marks, and what an entity of any class means among them. Private to mesh/select.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/select/chosen.h"
#include "mesh/select/parse.h"

namespace prismesh::mesh::select {

using Marks = std::vector<std::uint8_t>;  ///< by index of the kind's entities: 1 if it is in the set

/// The class of elements kept in Model::elements, or nothing for nodes, parts and shells.
std::optional<ElementClass> block_class(ItemClass item_class);

class Marking {
 public:
  Marking(const Model& model, Kind kind) : model_(model), kind_(kind) {}

  Kind kind() const { return kind_; }
  Marks nothing() const;
  Marks everything() const;  ///< but what was removed from the model
  /// The ids of a class of entities.
  const IdIndex& ids_of(ItemClass entity);
  /// Marks what an entity means among those of the kind: a shell its nodes, a node the parts around it, ...
  void mark(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value);
  /// Marks the entities with the ids first, first + step, ... last. False: there are none.
  bool mark_ids(Marks& marks, ItemClass entity, std::int64_t first, std::int64_t last, std::int64_t step, std::uint8_t value);
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

  const Model& model_;
  Kind kind_;
  std::array<std::unique_ptr<IdIndex>, kItemClassCount> indices_;
  std::vector<std::uint32_t> part_first_;
  std::vector<std::uint32_t> part_shells_;
};

}  // namespace prismesh::mesh::select
