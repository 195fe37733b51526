// Edits that change what a model is made of, as the tests of every format make them.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/open.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {

/// A model being edited.
struct Growing {
  explicit Growing(const OpenedDeck& opened) : deck(*opened.deck), original(opened.model), model(opened.model), ids(*opened.deck, model) {}
  Growing(const Growing&) = delete;

  NodeIndex node(std::int64_t id) const { return model.find_node(id); }
  ShellIndex shell(std::int64_t id) const { return model.find_shell(id); }

  /// A node in the middle of an edge; the same one if it is asked for again.
  NodeIndex middle(NodeIndex a, NodeIndex b) {
    const auto key = std::minmax(a, b);
    if (const auto known = middles.find(key); known != middles.end()) return known->second;
    return middles[key] = add(edge_origin(key.first, key.second));
  }
  NodeIndex add(const NodeOrigin& origin) {
    Vec3 at = Vec3::Zero();
    for (std::size_t p = 0; p < static_cast<std::size_t>(origin.count()); ++p) at += origin.weight[p] * model.position(origin.parent[p]);
    const auto id = ids.node(origin);
    EXPECT_TRUE(id) << id.error().text();
    return add_node(model, id.value_or(0), at, origin);
  }
  ShellIndex child(ShellIndex parent, NodeIndex a, NodeIndex b, NodeIndex c, NodeIndex d) {
    const auto id = ids.shell(parent);
    EXPECT_TRUE(id) << id.error().text();
    return add_shell(model, id.value_or(0), {{a, b, c, d}}, parent);
  }

  /// A quad into four; it keeps its id for the piece at its first corner.
  void split_in_four(ShellIndex shell) {
    const auto n = model.shell(shell).node;
    const NodeIndex ab = middle(n[0], n[1]), bc = middle(n[1], n[2]), cd = middle(n[2], n[3]), da = middle(n[3], n[0]);
    const NodeIndex centre = add(centre_origin(model.shell(shell)));
    set_shell_nodes(model, shell, {{n[0], ab, centre, da}});
    child(shell, ab, n[1], bc, centre);
    child(shell, centre, bc, n[2], cd);
    child(shell, da, centre, cd, n[3]);
  }

  /// A shell with one more node on its edge from corner `edge` on becomes triangles.
  void split_at_edge(ShellIndex shell, int edge, NodeIndex middle_node) {
    const ShellNodes nodes = model.shell(shell);
    const int corners = nodes.corners();
    const auto corner = [&](int i) { return nodes.node[static_cast<std::size_t>((edge + i) % corners)]; };
    if (corners == 3) {
      set_shell_nodes(model, shell, {{corner(0), middle_node, corner(2), corner(2)}});
      child(shell, middle_node, corner(1), corner(2), corner(2));
      return;
    }
    set_shell_nodes(model, shell, {{corner(0), middle_node, corner(3), corner(3)}});
    child(shell, middle_node, corner(1), corner(2), corner(2));
    child(shell, middle_node, corner(2), corner(3), corner(3));
  }

  /// A quad into four, and its neighbours so that they fit.
  void split_conforming(ShellIndex shell) {
    const auto n = model.shell(shell).node;
    struct Neighbour {
      ShellIndex shell;
      int edge;
      NodeIndex a, b;
    };
    std::vector<Neighbour> neighbours;
    for (std::size_t e = 0; e < 4; ++e) {
      const NodeIndex a = n[e], b = n[(e + 1) % 4];
      const EdgeIndex edge = original.adjacency->find_edge(a, b);
      for (const ShellIndex other : original.adjacency->shells_of(edge)) {
        if (other == shell) continue;
        const ShellNodes& nodes = original.shell(other);
        for (int i = 0; i < nodes.corners(); ++i)
          if (std::minmax(nodes.node[static_cast<std::size_t>(i)], nodes.node[static_cast<std::size_t>((i + 1) % nodes.corners())]) ==
              std::minmax(a, b))
            neighbours.push_back({other, i, a, b});
      }
    }
    split_in_four(shell);
    for (const Neighbour& other : neighbours) split_at_edge(other.shell, other.edge, middle(other.a, other.b));
  }

  const Deck& deck;
  const Model& original;
  Model model;
  NewIds ids;
  std::map<std::pair<NodeIndex, NodeIndex>, NodeIndex> middles;
};

/// The entities by id: positions, corners and parts. What two models have to have alike to be the same.
struct ByIds {
  std::map<std::int64_t, std::array<double, 3>> nodes;
  std::map<std::int64_t, std::pair<std::array<std::int64_t, 4>, std::int64_t>> shells;
};

inline ByIds by_ids(const Model& model) {
  ByIds out;
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if (!model.is_removed(NodeIndex(n))) {
      const Vec3& at = model.positions[n];
      out.nodes[model.node_ids[n]] = {at[0], at[1], at[2]};
    }
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    auto& [corners, part] = out.shells[model.shell_ids[s]];
    for (std::size_t c = 0; c < 4; ++c) corners[c] = model.node_ids[model.shell_nodes[s].node[c].value];
    part = model.shell_parts[s].valid() ? (*model.parts)[model.shell_parts[s].value].id : 0;
  }
  return out;
}

/// Positions within `tolerance` of the model's size, everything else exactly.
inline void expect_same(const Model& a, const Model& b, double tolerance = 1e-12) {
  const ByIds x = by_ids(a), y = by_ids(b);
  EXPECT_EQ(x.shells, y.shells);
  ASSERT_EQ(x.nodes.size(), y.nodes.size());
  double size = 1;
  for (const auto& [id, at] : x.nodes)
    for (const double value : at) size = std::max(size, std::abs(value));
  for (const auto& [id, at] : x.nodes) {
    const auto other = y.nodes.find(id);
    ASSERT_NE(other, y.nodes.end()) << "node " << id;
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(at[k], other->second[k], tolerance * size) << "node " << id;
  }
}

/// Lines that go and lines that come: as few as can be where the texts are short; else those that one text has more often than the
/// other, wherever they stand.
struct LineDifference {
  std::vector<std::string> gone, come;
};

inline LineDifference line_difference(const std::string& before, const std::string& after) {
  const auto lines_of = [](const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      lines.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    return lines;
  };
  const std::vector<std::string> a = lines_of(before), b = lines_of(after);
  LineDifference out;
  if (a.size() * b.size() <= 1'000'000) {
    // The longest common subsequence of the rests, from the end.
    std::vector<std::vector<std::size_t>> common(a.size() + 1, std::vector<std::size_t>(b.size() + 1, 0));
    for (std::size_t i = a.size(); i-- > 0;)
      for (std::size_t j = b.size(); j-- > 0;)
        common[i][j] = a[i] == b[j] ? common[i + 1][j + 1] + 1 : std::max(common[i + 1][j], common[i][j + 1]);
    for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
      if (i < a.size() && j < b.size() && a[i] == b[j])
        ++i, ++j;
      else if (j == b.size() || (i < a.size() && common[i + 1][j] >= common[i][j + 1]))
        out.gone.push_back(a[i++]);
      else
        out.come.push_back(b[j++]);
    }
    return out;
  }
  std::map<std::string, std::ptrdiff_t> count;
  for (const std::string& line : a) --count[line];
  for (const std::string& line : b) ++count[line];
  for (const auto& [line, more] : count) {
    for (std::ptrdiff_t i = more; i < 0; ++i) out.gone.push_back(line);
    for (std::ptrdiff_t i = more; i > 0; --i) out.come.push_back(line);
  }
  return out;
}

}  // namespace prismesh::mesh::deck
