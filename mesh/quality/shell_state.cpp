#include "mesh/quality/shell_state.h"

namespace prismesh::mesh::quality {

std::string_view name(Defect defect) {
  switch (defect) {
    case Defect::not_finite: return "not_finite";
    case Defect::repeated_node: return "repeated_node";
    case Defect::no_area: break;
  }
  return "no_area";
}

}  // namespace prismesh::mesh::quality
