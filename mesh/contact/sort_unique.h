// Makes an ascending list without repetitions. Private to mesh/contact.
#pragma once

#include <algorithm>
#include <vector>

namespace prismesh::mesh::contact {

template <class Entry>
void sort_unique(std::vector<Entry>& entries) {
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
}

}  // namespace prismesh::mesh::contact
