// Models of several sheets, each a grid of shells with a part of its own, for tests of contact.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/contact/find_perforations.h"
#include "tests/support/make_model.h"

namespace prismesh::test {

struct SheetsThatMeet {
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;

  /// Adds columns x rows quads, node (i, j) at place(i, j).
  SheetsThatMeet& add(std::int64_t part, int columns, int rows, const std::function<mesh::Vec3(int i, int j)>& place) {
    const auto first = static_cast<std::int64_t>(nodes.size()) + 1, stride = std::int64_t{columns} + 1;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, place(i, j)});
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const std::int64_t corner = first + i + j * stride;
        shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, part, {corner, corner + 1, corner + 1 + stride, corner + stride}});
      }
    return *this;
  }
  /// A plate in the plane z = 0: 10 x 10 shells of size 1 about the origin.
  SheetsThatMeet& add_plate(std::int64_t part = 1) {
    return add(part, 10, 10, [](int i, int j) { return mesh::Vec3(i - 5, j - 5, 0); });
  }
  mesh::Model model() const { return make_model(nodes, shells); }
};

inline std::vector<mesh::contact::Perforation> perforations_of(const mesh::Model& model) {
  return mesh::contact::find_perforations(model, mesh::spatial::BoxTree(model));
}
inline std::vector<mesh::contact::Perforation> perforations_of(const SheetsThatMeet& sheets) { return perforations_of(sheets.model()); }

}  // namespace prismesh::test
