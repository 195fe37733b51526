#include "mesh/report/id_list.h"

namespace prismesh::mesh::report {

std::string id_list(const std::vector<std::int64_t>& ids) {
  std::string list;
  for (std::size_t i = 0; i < ids.size();) {
    std::size_t last = i;
    while (last + 1 < ids.size() && ids[last + 1] == ids[last] + 1) ++last;
    if (!list.empty()) list += ',';
    list += std::to_string(ids[i]);
    if (last > i) list += (last == i + 1 ? "," : "-") + std::to_string(ids[last]);
    i = last + 1;
  }
  return list;
}

}  // namespace prismesh::mesh::report
