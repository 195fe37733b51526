// The shape of a band of shells: its sides, its middle curve, its width. Private to mesh/connections.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::connections {

using BorderEdge = std::pair<NodeIndex, NodeIndex>;

struct BandShape {
  std::vector<Vec3> middle;
  std::array<std::vector<Vec3>, 2> sides;
  bool closed = false;
  double length = 0;
  double mean_width = 0;
  double min_width = 0;
};

/// What a strip of this border and area would measure, straight or curved. Nothing if no strip has so short a border.
struct StripSize {
  double length = 0;
  double width = 0;
};
std::optional<StripSize> strip_size(double border, double area);

/// The lines of border edges, each of its nodes in order, the longest first; a closed line doesn't repeat its first node.
std::vector<std::vector<NodeIndex>> border_lines(const Model& model, const std::vector<BorderEdge>& border);

/// The shape of the band with these border edges and this area. Nothing if it is wider than `max_width` or shorter than `min_length_share`
/// widths. How it is found: find_flanges.h.
std::optional<BandShape> band_shape(const Model& model, const std::vector<BorderEdge>& border, double area, double max_width,
                                    double min_length_share);

}  // namespace prismesh::mesh::connections
