#include "mesh/repair/operation.h"

namespace prismesh::mesh::repair {

std::string_view name(Operation operation) {
  switch (operation) {
    case Operation::split: return "split";
    case Operation::collapse: return "collapse";
    case Operation::merge: return "merge";
    case Operation::swap: return "swap";
    case Operation::move: break;
  }
  return "move";
}

}  // namespace prismesh::mesh::repair
