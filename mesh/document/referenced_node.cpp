#include "mesh/document/referenced_node.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "mesh/select/region.h"

namespace prismesh::mesh::document {

Result<NodeIndex> find_referenced_node(const Model& model, const NodeReference& reference) {
  if (model.node_count() == 0) return fail("", "the model has no nodes");
  if (const auto* point = std::get_if<std::array<double, 3>>(&reference))
    return select::nearest_node(model, Vec3((*point)[0], (*point)[1], (*point)[2]));
  const std::int64_t id = std::get<std::int64_t>(reference);
  const NodeIndex node = model.find_node(id);
  if (node.valid()) return node;
  const IdIndex& ids = *model.node_index;
  std::size_t rank = std::min(ids.lower_bound(id), ids.size() - 1);
  if (rank > 0 && ids.at(rank).first > id && id - ids.at(rank - 1).first <= ids.at(rank).first - id) --rank;
  return fail("", "there is no node " + std::to_string(id) + "; the nearest id is " + std::to_string(ids.at(rank).first));
}

}  // namespace prismesh::mesh::document
