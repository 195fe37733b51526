#include "mesh/contact/changed_shells.h"

#include <algorithm>
#include <cstddef>

#include "mesh/contact/sort_unique.h"

namespace prismesh::mesh::contact {

ShellSet changed_shells(const Model& before, const Model& after) {
  const NodeSet moved = moved_nodes(before, after);
  ShellSet changed = shells_touching(before, moved);
  const ShellSet touched = shells_touching(after, moved);
  changed.insert(changed.end(), touched.begin(), touched.end());
  const auto &was = before.shell_nodes, &is = after.shell_nodes;
  for (std::size_t c = 0; c < std::max(was.chunk_count(), is.chunk_count()); ++c) {
    if (c < was.chunk_count() && c < is.chunk_count() && was.chunk_owner(c) == is.chunk_owner(c)) continue;
    for (std::size_t s = c * kChunkSize; s < std::min((c + 1) * kChunkSize, std::max(was.size(), is.size())); ++s)
      if (s >= was.size() || s >= is.size() || !(was[s] == is[s])) changed.emplace_back(s);
  }
  sort_unique(changed);
  return changed;
}

}  // namespace prismesh::mesh::contact
