#include "mesh/document/clusters.h"

#include <algorithm>

#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

std::size_t triangles_at(const Model& model, NodeIndex node) {
  const std::span<const ShellIndex> shells = model.adjacency->shells_of(node);
  return static_cast<std::size_t>(
      std::count_if(shells.begin(), shells.end(), [&](ShellIndex shell) { return model.shell(shell).is_triangle(); }));
}

/// Whether the shell is new, or has other corners or corners at other places than in `opened`.
bool is_touched(const Model& opened, const Model& model, ShellIndex shell) {
  if (shell.value >= opened.shell_count() || opened.shell(shell).node != model.shell(shell).node) return true;
  const std::array<NodeIndex, 4>& corners = model.shell(shell).node;
  return std::any_of(corners.begin(), corners.end(), [&](NodeIndex node) { return opened.position(node) != model.position(node); });
}

}  // namespace

std::shared_ptr<const quality::TriangleClusters> clusters_of(const Judging& judging, const Model& model) {
  return std::make_shared<const quality::TriangleClusters>(
      quality::find_triangle_clusters(model, judging.criteria.criteria->warn_triangles_at_node));
}

std::vector<std::uint8_t> made_worse(const Generation& opened, const Generation& now) {
  std::vector<std::uint8_t> worse;
  for (const quality::TriangleCluster& cluster : *now.clusters) {
    const bool is_new = cluster.node.value >= opened.model.node_count();
    worse.push_back(is_new || cluster.triangles > triangles_at(opened.model, cluster.node) ? 1 : 0);
  }
  return worse;
}

ClustersInScope clusters_in(const Document& document, Scope scope, const ShellSet& shells) {
  const Generation& now = document.current();
  const Model& opened = document.opened->model;
  const auto is_in_scope = [&](ShellIndex shell) {
    return std::binary_search(shells.begin(), shells.end(), shell) || (scope == Scope::damaged && is_touched(opened, now.model, shell));
  };
  ClustersInScope found;
  for (const quality::TriangleCluster& cluster : *now.clusters) {
    const std::span<const ShellIndex> about = now.model.adjacency->shells_of(cluster.node);
    if (std::none_of(about.begin(), about.end(), [&](ShellIndex s) { return now.model.shell(s).is_triangle() && is_in_scope(s); }))
      continue;
    found.nodes.push_back(cluster.node);
    found.shells.insert(found.shells.end(), about.begin(), about.end());
  }
  std::sort(found.shells.begin(), found.shells.end());
  found.shells.erase(std::unique(found.shells.begin(), found.shells.end()), found.shells.end());
  return found;
}

}  // namespace prismesh::mesh::document
