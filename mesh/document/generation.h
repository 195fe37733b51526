// A generation: the model after an edit, with the selection, the parts' states and the judgement of every shell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mesh/document/judging.h"
#include "mesh/model/chunked_array.h"
#include "mesh/model/model.h"
#include "mesh/quality/mass.h"
#include "mesh/quality/report.h"
#include "mesh/quality/triangle_clusters.h"
#include "mesh/select/expression.h"

namespace prismesh::mesh::document {

struct PartState {
  bool hidden = false;
  bool locked = false;  ///< its nodes don't move
  bool operator==(const PartState&) const = default;
};

/// Bits of Generation::node_marks. The last two follow from the part states.
enum NodeMark : std::uint8_t {
  kSelected = 1,
  kLocked = 2,  ///< an element of a locked part uses the node
  kHidden = 4,  ///< elements use the node, all of hidden parts
};

struct DeckRelations;  // mesh/document/deck_relations.h

/// A value that shares what it didn't change with the generations before and after it.
struct Generation {
  Model model;
  ChunkedArray<std::uint8_t> node_marks;   ///< NodeMark bits
  ChunkedArray<std::uint8_t> shell_marks;  ///< selected shells, when elements or parts were selected
  select::EntityKind selection_kind = select::EntityKind::node;
  std::size_t selected_nodes = 0;
  std::size_t selected_shells = 0;
  std::shared_ptr<const std::vector<PartState>> parts;  ///< by PartIndex
  /// The surface that relaxing and repairing hold nodes on: the model as it was opened or last shaped. Never null once opened.
  std::shared_ptr<const Model> surface;
  std::shared_ptr<const DeckRelations> relations;  ///< never null once opened
  std::shared_ptr<const Judging> judging;          ///< what the parts' shells are judged by; never null once opened
  ChunkedArray<quality::ShellState> quality;
  quality::Counts counts;  ///< all shells
  /// Of the model, by the document's criteria. Never null.
  std::shared_ptr<const quality::TriangleClusters> clusters = std::make_shared<const quality::TriangleClusters>();
  quality::MassProperties weight;  ///< of all shells; updated with each edit, so its last digits depend on the edits before
  std::uint64_t number = 0;        ///< counts up over the document's life, never reused
  std::string made_by;             ///< the edit's name; "open" for the first
  std::size_t own_bytes = 0;       ///< of chunks that the generation before doesn't share: what keeping that one costs
};

}  // namespace prismesh::mesh::document
