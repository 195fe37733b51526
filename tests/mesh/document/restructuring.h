// Changes of structure as a repair asks for them, made by hand, on documents of real text.
#pragma once

#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/document/history.h"
#include "mesh/document/restructure.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {

/// A sheet of columns x rows quads of 5 mm as an LS-DYNA deck, in two parts (left and right half), with a set of nodes and one of shells.
inline std::string sheet_deck(int columns, int rows) {
  std::string text = "*KEYWORD\n*NODE\n";
  char line[128];
  const auto node = [&](int i, int j) { return 1 + i + j * (columns + 1); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", node(i, j), 5.0 * i, 5.0 * j, 0.25 * ((i + j) % 2));
      text += line;
    }
  text += "*ELEMENT_SHELL\n";
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1 + i + j * columns, 2 * i < columns ? 1 : 2, node(i, j), node(i + 1, j),
                    node(i + 1, j + 1), node(i, j + 1));
      text += line;
    }
  // so that parts have a triangle behind which others can stand
  text += "*SET_NODE_LIST\n         1\n         1         2         3         4\n";
  text += "*SET_SHELL_LIST\n         2\n         1         2\n";
  text +=
      "*PART\nleft\n         1         1         1\n*PART\nright\n         2         1         1\n*SECTION_SHELL\n         1         2\n"
      "       1.5       1.5       1.5       1.5\n*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n*END\n";
  return text;
}

inline Document open_text(const std::filesystem::path& path, const std::string& text, std::size_t history_bytes = std::size_t{1} << 30) {
  put_content(path, text);
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 5.0;  // of all parts
  options.history_bytes = history_bytes;
  return open(path, options).value();
}

/// A change under way: new indices count on from the model's.
struct Change {
  const Model& model;
  repair::Restructuring want;

  NodeIndex add_node(const NodeOrigin& origin) {
    Vec3 at = Vec3::Zero();
    for (std::size_t p = 0; p < static_cast<std::size_t>(origin.count()); ++p) at += origin.weight[p] * place(origin.parent[p]);
    want.new_nodes.push_back({at, origin});
    return NodeIndex(model.node_count() + want.new_nodes.size() - 1);
  }
  Vec3 place(NodeIndex node) const {
    return node.value < model.node_count() ? model.position(node) : want.new_nodes[node.value - model.node_count()].position;
  }
  void add_shell(ShellIndex parent, NodeIndex a, NodeIndex b, NodeIndex c, NodeIndex d) {
    want.new_shells.push_back({{{a, b, c, d}}, parent});
  }
  void reshape(ShellIndex shell, NodeIndex a, NodeIndex b, NodeIndex c, NodeIndex d) { want.reshaped.push_back({shell, {{a, b, c, d}}}); }

  /// A quad into two triangles.
  void split(ShellIndex shell) {
    const auto n = model.shell(shell).node;
    reshape(shell, n[0], n[1], n[2], n[2]);
    add_shell(shell, n[0], n[2], n[3], n[3]);
  }
  /// A quad into four triangles about a new node.
  void star(ShellIndex shell) {
    const auto n = model.shell(shell).node;
    const NodeIndex middle = add_node(centre_origin(model.shell(shell)));
    reshape(shell, n[0], n[1], middle, middle);
    for (std::size_t i = 1; i < 4; ++i) add_shell(shell, n[i], n[(i + 1) % 4], middle, middle);
  }
  /// Two shells that share an edge are cut across it: quads into quads.
  void cut_across(ShellIndex a, ShellIndex b, NodeIndex from, NodeIndex to) {
    const NodeIndex middle = add_node(edge_origin(from, to));
    for (const ShellIndex shell : {a, b}) {
      const auto n = model.shell(shell).node;
      std::size_t i = 0;
      while (!((n[i] == from && n[(i + 1) % 4] == to) || (n[i] == to && n[(i + 1) % 4] == from))) ++i;
      const NodeIndex p = n[i], q = n[(i + 1) % 4], r = n[(i + 2) % 4], s = n[(i + 3) % 4];
      reshape(shell, p, middle, s, s);
      add_shell(shell, middle, q, r, r);
      add_shell(shell, middle, r, s, s);
    }
  }
  /// The edge becomes its first end; shells at it become triangles or go.
  bool collapse(NodeIndex keep, NodeIndex gone) {
    for (const ShellIndex shell : model.adjacency->shells_of(gone)) {
      const ShellNodes& nodes = model.shell(shell);
      std::vector<NodeIndex> corners;
      for (int i = 0; i < nodes.corners(); ++i) {
        const NodeIndex node = nodes.node[static_cast<std::size_t>(i)] == gone ? keep : nodes.node[static_cast<std::size_t>(i)];
        if (corners.empty() || corners.back() != node) corners.push_back(node);
      }
      if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
      if (corners.size() < 3)
        want.removed_shells.push_back(shell);
      else
        reshape(shell, corners[0], corners[1], corners[2], corners.size() == 4 ? corners[3] : corners[2]);
    }
    want.removed_nodes.push_back(gone);
    return true;
  }
  repair::Restructuring finish() {
    std::sort(want.reshaped.begin(), want.reshaped.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::sort(want.removed_shells.begin(), want.removed_shells.end());
    std::sort(want.removed_nodes.begin(), want.removed_nodes.end());
    std::sort(want.moved.begin(), want.moved.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return want;
  }
};

/// What prepare() makes of a change; for the journal it goes under the name of a split.
inline Result<Prepared> prepare_change(const Document& document, const repair::Restructuring& change) {
  auto next = std::make_shared<Generation>(document.current());
  Prepared prepared;
  if (const Result<void> done = restructure(document, change, *next, prepared.report); !done) return fail(done.error());
  next->number = document.next_number;
  next->made_by = "split";
  next->own_bytes = own_bytes(document.current(), *next);
  prepared.next = std::move(next);
  prepared.report.before = document.current().counts;
  prepared.report.after = prepared.next->counts;
  return prepared;
}

inline EditReport must_change(Document& document, const repair::Restructuring& change) {
  Result<Prepared> prepared = prepare_change(document, change);
  if (!prepared) {
    ADD_FAILURE() << prepared.error().text();
    return {};
  }
  EditReport report = prepared->report;
  commit(document, std::move(*prepared));
  return report;
}

/// Some changes far enough from each other, by chance; may be empty.
inline repair::Restructuring any_change(const Model& model, std::mt19937& random, std::size_t most) {
  Change change{model, {}};
  std::set<std::uint32_t> busy;  // nodes
  const auto free = [&](const ShellSet& shells) {
    for (const ShellIndex shell : shells)
      for (const NodeIndex node : model.shell(shell).node)
        if (busy.contains(node.value)) return false;
    for (const ShellIndex shell : shells)
      for (const NodeIndex node : model.shell(shell).node) busy.insert(node.value);
    return true;
  };
  for (std::size_t i = 0; i < most; ++i) {
    const ShellIndex shell(random() % model.shell_count());
    if (model.is_removed(shell)) continue;
    const ShellNodes& nodes = model.shell(shell);
    const auto around = [&](NodeIndex node) {
      const auto shells = model.adjacency->shells_of(node);
      return ShellSet(shells.begin(), shells.end());
    };
    switch (random() % 4) {
      case 0:
        if (!nodes.is_triangle() && free({shell})) change.split(shell);
        break;
      case 1:
        if (!nodes.is_triangle() && free({shell})) change.star(shell);
        break;
      case 2: {
        const auto of_edge = model.adjacency->shells_of(model.adjacency->find_edge(nodes.node[0], nodes.node[1]));
        const ShellSet both(of_edge.begin(), of_edge.end());
        if (both.size() == 2 && !model.shell(both[0]).is_triangle() && !model.shell(both[1]).is_triangle() && free(both))
          change.cut_across(both[0], both[1], nodes.node[0], nodes.node[1]);
        break;
      }
      default: {
        const NodeIndex keep = nodes.node[0], gone = nodes.node[1];
        ShellSet both = around(keep);
        for (const ShellIndex other : around(gone)) both.push_back(other);
        // neither of the set's nodes goes, and the sheet keeps its border
        if (gone.value < 4 || around(gone).size() != 4 || !free(both)) break;
        change.collapse(keep, gone);
        const Vec3 middle = 0.5 * (model.position(keep) + model.position(gone));
        change.want.moved.emplace_back(keep, middle);
      }
    }
  }
  return change.finish();
}

}  // namespace prismesh::mesh::document
