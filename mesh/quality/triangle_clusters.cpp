#include "mesh/quality/triangle_clusters.h"

#include <algorithm>
#include <array>
#include <utility>

namespace prismesh::mesh::quality {

namespace {

// Triangles of a mesh of triangles, and all its shells: their least ratio.
constexpr std::size_t kTrianglesOf = 3, kShellsOf = 4;

std::size_t place_of(PartIndex part, std::size_t parts) { return part.valid() && part.value < parts ? part.value : parts; }

/// Calls `body` with index, corners and place of part of each triangle that counts.
template <class Body>
void for_each_triangle(const Model& model, const std::vector<std::uint8_t>& meant, const ShellSet* shells, const Body& body) {
  const auto visit = [&](std::size_t s) {
    const ShellNodes& nodes = model.shell_nodes[s];
    if (!nodes.node[0].valid() || !nodes.is_triangle() || meant[place_of(model.shell_parts[s], meant.size() - 1)] != 0) return;
    body(ShellIndex(s), nodes);
  };
  if (shells != nullptr)
    for (const ShellIndex shell : *shells) visit(shell.value);
  else
    for (std::size_t s = 0; s < model.shell_count(); ++s) visit(s);
}

/// Whether no earlier corner has the same node.
bool is_first(const ShellNodes& nodes, std::size_t corner) {
  return std::find(nodes.node.begin(), nodes.node.begin() + static_cast<std::ptrdiff_t>(corner), nodes.node[corner]) ==
         nodes.node.begin() + static_cast<std::ptrdiff_t>(corner);
}

}  // namespace

std::vector<std::uint8_t> meshes_of_triangles(const Model& model) {
  const std::size_t parts = model.parts ? model.parts->size() : 0;
  std::vector<std::pair<std::size_t, std::size_t>> counts(parts + 1);  // triangles, shells
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const ShellNodes& nodes = model.shell_nodes[s];
    if (!nodes.node[0].valid()) continue;
    auto& [triangles, shells] = counts[place_of(model.shell_parts[s], parts)];
    triangles += nodes.is_triangle() ? 1 : 0;
    ++shells;
  }
  std::vector<std::uint8_t> meant;
  for (const auto& [triangles, shells] : counts) meant.push_back(triangles > 0 && kShellsOf * triangles >= kTrianglesOf * shells ? 1 : 0);
  return meant;
}

TriangleClusters find_triangle_clusters(const Model& model, double allowed, const ShellSet* shells) {
  const std::vector<std::uint8_t> meant = meshes_of_triangles(model);
  std::vector<std::uint32_t> triangles(model.node_count());
  bool any = false;
  for_each_triangle(model, meant, shells, [&](ShellIndex, const ShellNodes& nodes) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      if (is_first(nodes, corner)) any = ++triangles[nodes.node[corner].value] > allowed || any;
  });
  TriangleClusters found;
  if (!any) return found;
  for_each_triangle(model, meant, shells, [&](ShellIndex shell, const ShellNodes& nodes) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::uint32_t& count = triangles[nodes.node[corner].value];
      if (!(count > allowed)) continue;
      found.push_back({nodes.node[corner], count, shell, static_cast<std::uint8_t>(corner)});
      count = 0;  // the node is listed
    }
  });
  std::sort(found.begin(), found.end(), [](const TriangleCluster& a, const TriangleCluster& b) { return a.node < b.node; });
  return found;
}

}  // namespace prismesh::mesh::quality
