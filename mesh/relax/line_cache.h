// The feature lines at the nodes of a model, computed when first used. Private to mesh/relax.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>

#include "mesh/model/model.h"
#include "mesh/relax/feature_lines.h"
#include "mesh/relax/zeroed_memory.h"

namespace prismesh::mesh::relax {

/// The feature edges at a node, borders between parts among them.
struct NodeLines {
  LineEnds ends;
  bool pass_through = false;  ///< relax::passes_through
};

/// Costs next to nothing before it is used, however large the model. Thread-safe.
class LineCache {
 public:
  /// `model` must outlive it and stay as it is.
  LineCache(const Model& model, double cos_limit);

  const NodeLines& at(NodeIndex node) const;
  /// Whether the edge of a shell between two nodes is a feature edge.
  bool is_feature(ShellIndex shell, NodeIndex a, NodeIndex b) const;
  const Model& model() const { return model_; }

 private:
  const NodeLines& make(NodeIndex node) const;

  const Model& model_;
  double cos_limit_;
  ZeroedMemory<std::atomic<const NodeLines*>> known_;  ///< by node; null: not known
  mutable std::mutex mutex_;
  mutable std::deque<NodeLines> made_;
};

}  // namespace prismesh::mesh::relax
