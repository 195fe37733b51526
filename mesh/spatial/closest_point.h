// Finds the closest point of a surface: a bounding volume hierarchy over shells, for many queries. The same bits on every processor.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/surface_point.h"

namespace prismesh::mesh::spatial {

/// A tree of axis-aligned boxes. A quad counts as the two triangles at its diagonal from the first corner to the third. Positions are those
/// at construction; a triangle with a corner that isn't finite is left out. Of equally close shells the first counts. Some 220 bytes a
/// quad. Built on all cores; the tree is the same whatever their number.
class ShellTree {
 public:
  /// `nodes` are points of the surface too, without a shell.
  ShellTree(const Model& model, const ShellSet& shells, const NodeSet& nodes = {});

  /// Returns the closest point; nothing if no shell is within `radius` (inclusive), if the point isn't finite, or if the radius isn't >= 0.
  std::optional<SurfacePoint> closest(const Vec3& point, double radius = std::numeric_limits<double>::infinity()) const;
  /// Returns the distance alone. `near` is any point of the surface and becomes the closest one; the closer it is at the call, the faster
  /// the search. The result doesn't depend on it but for rounding. Precondition: not empty, `point` is finite.
  double distance(const Vec3& point, Vec3& near) const;
  /// Any point of the surface. Precondition: not empty.
  const Vec3& some_point() const { return triangles_.front().corner[0]; }
  /// Returns one point for each shell within `radius`, ascending by shell; of nodes without a shell only the nearest one.
  std::vector<SurfacePoint> within(const Vec3& point, double radius) const;
  bool empty() const { return triangles_.empty(); }

 private:
  struct Triangle {
    std::array<Vec3, 3> corner;
    ShellIndex shell;
    bool second = false;  ///< of a quad: corners 0, 2, 3
  };
  struct Node {
    Vec3 low, high;
    std::uint32_t first = 0;  ///< of triangles_ for a leaf; else the left child, which the right one follows
    std::uint32_t count = 0;  ///< triangles of a leaf; 0: not one
  };
  struct Entry;
  struct Range;
  void divide();
  void fit_boxes();
  template <class Visit>
  void walk(const Vec3& point, double& radius2, Visit&& visit) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace prismesh::mesh::spatial
