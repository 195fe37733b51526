// Clusters of triangles of a document: those of a generation, those that edits made worse, and those to repair.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/triangle_clusters.h"

namespace prismesh::mesh::document {

/// The clusters of a model by the deck's criteria.
std::shared_ptr<const quality::TriangleClusters> clusters_of(const Judging& judging, const Model& model);

/// For each cluster of `now` whether edits made it worse: 1 if its node has more triangles than in `opened`, or is new.
std::vector<std::uint8_t> made_worse(const Generation& opened, const Generation& now);

/// The clusters to repair: their nodes, and all shells there. Both ascend.
struct ClustersInScope {
  NodeSet nodes;
  ShellSet shells;
};

/// The clusters with a triangle in `shells`, which are those of the scope. Scope::damaged also has those with a shell that edits made or
/// reshaped, or of which they moved a node.
ClustersInScope clusters_in(const Document& document, Scope scope, const ShellSet& shells);

}  // namespace prismesh::mesh::document
