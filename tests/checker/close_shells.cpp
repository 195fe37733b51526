// Reads a model of two sheets from the standard input and prints its shells that are too close, so that checker/closeness.py can compare.
#include <array>
#include <cstddef>
#include <cstdio>
#include <iostream>
#include <vector>

#include "mesh/contact/close_shells.h"
#include "mesh/spatial/box_tree.h"
#include "tests/support/make_model.h"

/// For each model: the numbers of nodes and shells, the gap; the nodes; the shells with their thickness and four nodes, counted from 0.
int main() {
  using namespace prismesh::mesh;
  std::size_t node_count = 0, shell_count = 0;
  double gap = 0;
  while (std::cin >> node_count >> shell_count >> gap) {
    std::vector<Vec3> nodes(node_count);
    for (Vec3& node : nodes) std::cin >> node[0] >> node[1] >> node[2];
    std::vector<std::array<int, 4>> shells(shell_count);
    contact::ContactThickness thickness;
    thickness.of_shell.resize(shell_count);
    for (std::size_t s = 0; s < shell_count; ++s) {
      std::cin >> thickness.of_shell[s];
      for (int& node : shells[s]) std::cin >> node;
    }
    const Model model = prismesh::test::make_shells(nodes, shells);
    const auto found = contact::find_close_shells(model, spatial::BoxTree(model), thickness, gap);
    std::printf("%zu\n", found.size());
    for (const contact::CloseShells& close : found)
      std::printf("%u %u %.17g %.17g %d\n", close.a.value, close.b.value, close.distance, close.depth, close.touch_at_edge ? 1 : 0);
  }
}
