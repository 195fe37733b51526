// What the stages of `assemble` pass on. Private to assembly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// Nodes by index, and where their cards stand.
struct AssembledNodes {
  ChunkedArray<std::int64_t> ids;
  ChunkedArray<Vec3> positions;       ///< in the basic system
  ChunkedArray<std::uint8_t> holds;   ///< NodeHold bits
  std::vector<CardRun> runs;          ///< as Deck::node_runs
  std::vector<std::uint64_t> offset;  ///< as Deck::node_line
  std::shared_ptr<const IdIndex> index;
};

struct AssembledParts {
  std::shared_ptr<const std::vector<Part>> parts;  ///< ascending by id
  IdIndex index;
};

/// From the ids on cards to indices. Invalid: nobody defines it.
struct IdLookup {
  const IdIndex& nodes;
  const IdIndex& parts;

  NodeIndex node(std::int64_t id) const { return NodeIndex(nodes.find(id)); }
  PartIndex part(std::int64_t id) const {
    const std::uint32_t index = parts.find(id);
    return index == IdIndex::kNotFound ? PartIndex() : PartIndex(index);
  }
};

/// Elements that aren't in the model.
struct LeftOutElements {
  HiddenElements hidden;
  std::vector<std::int64_t> ids;  ///< of elements with a node that isn't defined
  std::vector<NodeIndex> nodes;   ///< those of their nodes that are defined: moved, they would deform an element that nobody sees
  std::vector<std::int64_t> undefined_nodes;  ///< ids; of shells, beams, solids and thick shells
  ElementCounts counts;                       ///< and of elements whose ids are defined again
};

/// Adds an element to the hidden ones, with those of its nodes that are defined.
void hide(const HiddenElements::Card& card, std::span<const NodeIndex> nodes, HiddenElements& hidden);

/// A node that the card of an element names and nobody defines.
struct UndefinedNode {
  std::string_view element_class;
  std::int64_t element = 0;  ///< ids
  std::int64_t node = 0;
  std::uint32_t file = 0;
  std::size_t offset = 0;  ///< of the element's card
};

/// Shells by index, and where their cards stand.
struct AssembledShells {
  ChunkedArray<std::int64_t> ids;
  ChunkedArray<ShellNodes> nodes;
  ChunkedArray<PartIndex> parts;
  ChunkedArray<float> thickness;
  std::shared_ptr<const std::vector<MidsideNodes>> midside;
  std::vector<CardRun> runs;          ///< as Deck::shell_runs
  std::vector<std::uint64_t> offset;  ///< as Deck::shell_line
  std::shared_ptr<const IdIndex> index;
  std::shared_ptr<const std::vector<ShellIndex>> second;  ///< as Model::second_shells
};

}  // namespace prismesh::mesh::deck
