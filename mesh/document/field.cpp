#include "mesh/document/field.h"

#include <cmath>
#include <numeric>

#include "base/parallel_for.h"
#include "mesh/model/chunked_array.h"

namespace prismesh::mesh::document {

std::size_t shells_without_value(const Model& model, const Field& field) {
  std::vector<std::size_t> without((model.shell_count() + kChunkSize - 1) / kChunkSize);
  parallel_for(model.shell_count(), kChunkSize, [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s) {
      if (model.is_removed(ShellIndex(s))) continue;
      bool has = field.on_nodes || std::isfinite(field.values[s]);
      if (field.on_nodes)
        for (const NodeIndex node : model.shell_nodes[s].node) has = has && std::isfinite(field.values[node.value]);
      without[s / kChunkSize] += has ? 0 : 1;
    }
  });
  return std::accumulate(without.begin(), without.end(), std::size_t{0});
}

}  // namespace prismesh::mesh::document
