#include "daemon/modeld/edit_preview.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "mesh/document/prepare.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"

namespace prismesh::modeld {

namespace {

using mesh::Model;
using mesh::ShellIndex;
using mesh::ShellSet;

ShellSet united(std::initializer_list<const ShellSet*> sets) {
  ShellSet all;
  for (const ShellSet* set : sets) all.insert(all.end(), set->begin(), set->end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Shells at the moved nodes, each taken from a model that has it.
ShellSet at_nodes(const Model& model, const mesh::NodeSet& nodes) {
  return nodes.empty() ? ShellSet() : mesh::shells_touching(model, nodes);
}

void add_shell(const mesh::document::Generation& next, ShellIndex shell, std::unordered_map<std::uint32_t, std::uint32_t>& known,
               ipc::EditPreviewed& preview) {
  const Model& model = next.model;
  ipc::PreviewedShell shown;
  shown.shell = model.shell_ids[shell.value];
  const mesh::quality::ShellState state = next.quality[shell.value];
  shown.warn = state.warn;
  shown.fail = state.fail;
  for (const mesh::NodeIndex node : model.shell(shell).node)
    if (!model.position(node).allFinite()) return;
  for (const mesh::NodeIndex node : model.shell(shell).node) {
    const auto [place, is_new] = known.try_emplace(node.value, static_cast<std::uint32_t>(preview.points.size()));
    if (is_new) {
      const mesh::Vec3& at = model.position(node);
      preview.points.push_back({at.x(), at.y(), at.z()});
    }
    shown.corners.push_back(place->second);
  }
  preview.shells.push_back(std::move(shown));
}

/// Marks the clusters of `next` at the corners of the previewed triangles, each once. `known`: nodes to their index in `preview.points`.
void add_clusters(const mesh::document::Generation& next, const std::unordered_map<std::uint32_t, std::uint32_t>& known,
                  ipc::EditPreviewed& preview) {
  std::unordered_set<std::uint32_t> crowded;
  for (const mesh::quality::TriangleCluster& cluster : *next.clusters)
    if (const auto place = known.find(cluster.node.value); place != known.end()) crowded.insert(place->second);
  for (ipc::PreviewedShell& shell : preview.shells)
    for (std::uint32_t k = 0; k < 3 && shell.corners[3] == shell.corners[2]; ++k)
      if (crowded.erase(shell.corners[k]) > 0) shell.clusters |= 1U << k;
}

/// Adds the new elements with two nodes, such as welds, and where none would be made.
void add_lines(const Model& model, const mesh::Changes& changes, ipc::EditPreviewed& preview) {
  for (std::size_t c = 0; c < changes.added_elements.size(); ++c)
    for (const std::uint32_t element : changes.added_elements[c]) {
      const mesh::ElementBlock& block = *model.elements[c];
      const std::uint32_t first = block.first_node[element];
      if (block.first_node[element + 1] - first != 2) continue;
      const mesh::Vec3 &a = model.position(block.nodes[first]), &b = model.position(block.nodes[first + 1]);
      ++preview.line_count;
      if (preview.lines.size() < ipc::kMaxPreviewedLines) preview.lines.push_back({a.x(), a.y(), a.z(), b.x(), b.y(), b.z()});
    }
  if (!preview.report.welded) return;
  for (const mesh::document::SpotLeft& spot : preview.report.welded->left_out) preview.left_out.push_back({spot.at, spot.why});
}

}  // namespace

Result<ipc::EditPreviewed> preview_edit(const mesh::document::Document& document, const mesh::document::Edit& edit, Clock* clock) {
  Result<mesh::document::Prepared> prepared = mesh::document::prepare(document, edit, {}, clock);
  if (!prepared) return fail(std::move(prepared.error()));
  const mesh::document::Generation& now = document.current();
  const mesh::document::Generation& next = *prepared->next;
  const mesh::Changes changes = mesh::changes_between(now.model, next.model);
  const mesh::NodeSet moved = mesh::moved_nodes(now.model, next.model);
  ShellSet after = at_nodes(next.model, moved);
  after = united({&after, &changes.added_shells, &changes.reshaped_shells});
  ShellSet before = at_nodes(now.model, moved);
  before = united({&before, &changes.removed_shells, &changes.reshaped_shells});

  ipc::EditPreviewed preview;
  preview.generation = now.number;
  preview.report = std::move(prepared->report);
  preview.shell_count = after.size();
  std::unordered_map<std::uint32_t, std::uint32_t> known;
  for (const ShellIndex shell : after) {
    if (preview.shells.size() == ipc::kMaxPreviewedShells) break;
    add_shell(next, shell, known, preview);
  }
  add_clusters(next, known, preview);
  add_lines(next.model, changes, preview);
  for (const ShellIndex shell : before) {
    if (preview.replaced.size() == ipc::kMaxPreviewedShells) break;
    preview.replaced.push_back(now.model.shell_ids[shell.value]);
  }
  return preview;
}

}  // namespace prismesh::modeld
