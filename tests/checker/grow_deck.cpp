// Divides edges of a deck's shells and takes shells away, so that the checker can look at what saving makes of it:
//   grow_deck DECK OUT EDGES REMOVED
// About EDGES edges, far apart, get a node in their middle, with every shell at them cut in two, and REMOVED other shells go, with the
// nodes that nothing uses any more. Prints what was done as JSON, or says why it can't be saved (status 1).
#include <cstdlib>
#include <iostream>
#include <set>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "mesh/model/topology_change.h"

namespace {

using namespace prismesh;
using namespace prismesh::mesh;

struct Edge {
  NodeIndex a, b;
};

class Grower {
 public:
  explicit Grower(const deck::OpenedDeck& opened) : original_(opened.model), model(opened.model), ids_(*opened.deck, model) {
    shells_at_.resize(model.node_count());
    for (std::size_t i = 0; i < model.shell_count(); ++i)
      for (int k = 0; k < model.shell_nodes[i].corners(); ++k)
        shells_at_[model.shell_nodes[i].node[static_cast<std::size_t>(k)].value].push_back(ShellIndex(i));
    for (const MidsideNodes& midside : *model.midside) touched_.insert(midside.shell.value);
  }

  /// The first edge of a shell, if no shell at it was touched before.
  Result<bool> divide_first_edge(ShellIndex shell) {
    if (touched_.count(shell.value)) return false;
    const ShellNodes& nodes = model.shell(shell);
    const Edge edge{nodes.node[0], nodes.node[1]};
    const std::vector<ShellIndex> around = shells_with(edge);
    for (const ShellIndex one : around)
      if (touched_.count(one.value) || degenerate(model.shell(one))) return false;
    const Result<std::int64_t> id = ids_.node(edge_origin(edge.a, edge.b));
    if (!id) return tl::unexpected(id.error());
    const Vec3 middle = (model.position(edge.a) + model.position(edge.b)) / 2;
    const NodeIndex node = add_node(model, *id, middle, edge_origin(edge.a, edge.b));
    for (const ShellIndex one : around) {
      touched_.insert(one.value);
      if (const Result<void> divided = cut_in_two(one, edge, node); !divided) return tl::unexpected(divided.error());
    }
    ++edges;
    return true;
  }

  bool remove(ShellIndex shell) {
    if (!touched_.insert(shell.value).second) return false;
    remove_shell(model, shell);
    ++removed;
    return true;
  }

  Model take() { return model; }
  std::size_t edges = 0, cut = 0, removed = 0;

 private:
  static bool degenerate(const ShellNodes& nodes) {
    std::set<std::uint32_t> corners;
    for (int k = 0; k < nodes.corners(); ++k) corners.insert(nodes.node[static_cast<std::size_t>(k)].value);
    return static_cast<int>(corners.size()) != nodes.corners();
  }

  std::vector<ShellIndex> shells_with(const Edge& edge) const {
    std::vector<ShellIndex> out;
    for (const ShellIndex shell : shells_at_[edge.a.value]) {
      const ShellNodes& nodes = model.shell(shell);
      const auto n = static_cast<std::size_t>(nodes.corners());
      for (std::size_t k = 0; k < n; ++k) {
        const NodeIndex x = nodes.node[k], y = nodes.node[(k + 1) % n];
        if ((x == edge.a && y == edge.b) || (x == edge.b && y == edge.a)) out.push_back(shell);
      }
    }
    return out;
  }

  /// The old shell keeps the second half of the edge; a triangle takes the first with the corner before it.
  Result<void> cut_in_two(ShellIndex shell, const Edge& edge, NodeIndex middle) {
    const ShellNodes old = model.shell(shell);
    const auto n = static_cast<std::size_t>(old.corners());
    std::size_t k = 0;
    while (!((old.node[k] == edge.a && old.node[(k + 1) % n] == edge.b) || (old.node[k] == edge.b && old.node[(k + 1) % n] == edge.a))) ++k;
    const NodeIndex first = old.node[k], before = old.node[(k + n - 1) % n];
    ShellNodes kept = old;
    kept.node[k] = middle;
    if (n == 3) kept.node[3] = kept.node[2];
    const Result<std::int64_t> id = ids_.shell(shell);
    if (!id) return tl::unexpected(id.error());
    set_shell_nodes(model, shell, kept);
    add_shell(model, *id, {{first, middle, before, before}}, shell);
    ++cut;
    return {};
  }

  const Model& original_;
  Model model;
  deck::NewIds ids_;
  std::vector<std::vector<ShellIndex>> shells_at_;
  std::set<std::uint32_t> touched_;
};

int refuse(const Error& error) {
  std::cerr << error.text() << '\n';
  return 1;
}

int grow(const char* from, const char* to, std::size_t edges, std::size_t removed) {
  const auto opened = deck::open(from);
  if (!opened) return refuse(opened.error());
  Grower grower(*opened);
  const std::size_t shells = opened->model.shell_count();
  for (std::size_t i = 0; i < edges && shells > 0; ++i)
    if (const Result<bool> done = grower.divide_first_edge(ShellIndex(i * shells / edges)); !done) return refuse(done.error());
  for (std::size_t i = 0; i < removed && shells > 0; ++i) grower.remove(ShellIndex((2 * i + 1) * shells / (2 * removed + 1)));
  const Model grown = grower.take();
  const auto saved = deck::save(*opened->deck, opened->model, grown, to);
  if (!saved) return refuse(saved.error());
  std::cout << "{\"nodes_added\": " << grower.edges << ", \"elements_added\": " << grower.cut << ", \"elements_changed\": " << grower.cut
            << ", \"elements_removed\": " << grower.removed << ", \"lines_changed\": " << saved->lines_changed << "}\n";
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::cerr << "grow_deck DECK OUT EDGES REMOVED\n";
    return 2;
  }
  return grow(arguments[1], arguments[2], std::strtoul(arguments[3], nullptr, 10), std::strtoul(arguments[4], nullptr, 10));
}
