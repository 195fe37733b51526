// Answers for pairs of sheets from the standard input whether they cross, so that checker/crossings.py can compare with exact fractions.
#include <array>
#include <cstdio>
#include <iostream>
#include <vector>

#include "mesh/contact/find_perforations.h"
#include "mesh/contact/orientation.h"
#include "mesh/spatial/box_tree.h"
#include "tests/support/make_model.h"

using prismesh::mesh::Vec3;

namespace {

Vec3 read_point() {
  Vec3 point;
  std::cin >> point[0] >> point[1] >> point[2];
  return point;
}

/// Two sheets of `triangles` triangles each, which meet at the side from node 1 to 2 of their sheet.
int crosses(int triangles) {
  std::vector<prismesh::test::NodeSpec> nodes;
  std::vector<prismesh::test::ShellSpec> shells;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const int first = 10 * sheet + 1;
    for (int i = 0; i < triangles + 2; ++i) nodes.push_back({first + i, read_point()});
    for (int i = 0; i < triangles; ++i) shells.push_back({first + i, sheet + 1, {first, first + 1, first + 2 + i}});
  }
  const prismesh::mesh::Model model = prismesh::test::make_model(nodes, shells);
  const prismesh::mesh::spatial::BoxTree tree(model);
  for (const auto& crossing : prismesh::mesh::contact::find_shell_crossings(model, tree))
    if (model.shell_parts[crossing.a.value] != model.shell_parts[crossing.b.value]) return 1;
  return 0;
}

int sign_of_orientation() {
  std::array<Vec3, 4> p;
  for (Vec3& point : p) point = read_point();
  const double value = prismesh::mesh::contact::orientation(p[0], p[1], p[2], p[3]);
  return (value > 0) - (value < 0);
}

}  // namespace

int main() {
  std::string kind;
  while (std::cin >> kind) std::printf("%d\n", kind == "side" ? sign_of_orientation() : crosses(kind == "sheets" ? 2 : 1));
}
