// The shells near others. Private to mesh/contact.
#pragma once

#include "mesh/contact/shell_triangles.h"
#include "mesh/contact/sort_unique.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// Adds to `near` the shells whose boxes are within `reach` of those of `shells`; in any order, and some more than once.
inline void add_near_shells(const spatial::BoxTree& tree, const ShellSet& shells, double reach, ShellSet& near) {
  for (const ShellIndex shell : shells) {
    if (!tree.contains(shell)) continue;
    const spatial::FloatBox box = tree.box_of(shell);
    const Vec3 low(box.low[0], box.low[1], box.low[2]), high(box.high[0], box.high[1], box.high[2]);
    if (!can_decide(low) || !can_decide(high)) continue;
    tree.near_box(low, high, reach, [&](ShellIndex other, const spatial::FloatBox&) {
      near.push_back(other);
      return true;
    });
  }
}

}  // namespace prismesh::mesh::contact
