// Finds free endings: what lies between the origin, or the axis of a rotation, and free edges, and is held nowhere. Private to mesh/shape.
// Nodes are local to a patch. Source: the system's paper, see docs/shaping.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesh/shape/axis.h"
#include "mesh/shape/cut_line.h"
#include "mesh/shape/free_edge.h"
#include "mesh/spatial/patch.h"

namespace prismesh::mesh::shape {

/// A free ending has at least this share of its cut's length in free edges. So a patch that is held nearly all around has none.
inline constexpr double kMinFreeShare = 1.0 / 3;

/// Marks the nodes that paths over the patch's shells connect to `start`.
std::vector<std::uint8_t> connected_to(const spatial::Patch& patch, std::uint32_t start);

/// The line where the distance from the border is `distance`: the pieces of it at the nodes of `origin`.
CutLine cut_at_distance(const spatial::Patch& patch, std::span<const double> from_border, double distance,
                        std::span<const std::uint32_t> origin);

/// The line where the plane through the axis cuts the connected nodes: the pieces of it nearest to the axis. The plane is perpendicular to
/// the mean direction, near the axis, in which the distance from the border grows, seen along the axis. Nothing where there is no such
/// direction.
std::optional<CutLine> cut_at_axis(const spatial::Patch& patch, std::span<const double> from_border,
                                   std::span<const std::uint8_t> connected, const Axis& axis);

/// Marks the nodes of free endings: the connected nodes that no path from the border reaches across the line, in pieces with free edges
/// that aren't holes and are long enough (kMinFreeShare); and the nodes of the line at these pieces. `border` nodes are never marked.
std::vector<std::uint8_t> find_free_endings(const spatial::Patch& patch, const FreeEdges& free_edges,
                                            std::span<const std::uint8_t> connected, std::span<const std::uint8_t> border,
                                            const CutLine& line);

/// The unmarked nodes of shells that the line crosses at marked nodes, each with its distance from the line.
std::vector<std::pair<std::uint32_t, double>> distances_before(const spatial::Patch& patch, const CutLine& line,
                                                               std::span<const std::uint8_t> marked);

}  // namespace prismesh::mesh::shape
