#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

std::string_view name(Metric metric) {
  switch (metric) {
    case Metric::warpage: return "warpage";
    case Metric::aspect: return "aspect";
    case Metric::skew: return "skew";
    case Metric::jacobian: return "jacobian";
    case Metric::taper: return "taper";
    case Metric::min_angle_quad: return "min_angle_quad";
    case Metric::max_angle_quad: return "max_angle_quad";
    case Metric::min_angle_tri: return "min_angle_tri";
    case Metric::max_angle_tri: return "max_angle_tri";
    case Metric::min_length: return "min_length";
    case Metric::max_length: break;
  }
  return "max_length";
}

std::string_view unit_of(Metric metric, std::string_view length_unit) {
  switch (metric) {
    case Metric::min_length:
    case Metric::max_length: return length_unit;
    case Metric::aspect:
    case Metric::jacobian:
    case Metric::taper: return {};
    default: return "deg";
  }
}

bool is_of_triangles(Metric metric) { return metric == Metric::min_angle_tri || metric == Metric::max_angle_tri; }

}  // namespace prismesh::mesh::quality
