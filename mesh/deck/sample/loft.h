// Meshes a part that is swept along a line: strips of quads between stations, triangles where the number of quads across changes, round
// holes in blocks of the grid. Uses no transcendental function of the C library, so that every machine makes the same mesh.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::deck::sample {

/// A round hole in one face of a part.
struct Hole {
  std::size_t face = 0;
  double along = 0;   ///< of its centre, from the part's start
  double across = 0;  ///< of its centre, 0..1 of the face's width
  double radius = 0;
};

/// A sheet-metal part: faces side by side, swept along a line. Lengths in mm.
struct Part {
  std::int64_t id = 0;
  const char* title = "";
  double thickness = 0;
  double length = 0;
  std::size_t faces = 0;
  std::function<double(std::size_t face, double along)> width;                 ///< of a face, measured on the sheet
  std::function<Vec3(std::size_t face, double across, double along)> surface;  ///< across 0..1; faces meet at 1 and 0
  std::vector<Hole> holes;
};

/// Edge lengths that a mesh should have, mm.
struct ElementSize {
  double across = 0;
  double along = 0;
};

struct SheetMesh {
  std::vector<Vec3> nodes;
  std::vector<std::array<std::uint32_t, 4>> shells;  ///< indices into nodes; a triangle repeats its third
};

/// The number of shells that `mesh_part` will make. Costs the number of stations.
std::size_t count_shells(const Part& part, const ElementSize& size);

SheetMesh mesh_part(const Part& part, const ElementSize& size);

/// 0 before `from`, 1 after `to`, with continuous slope and curvature.
double smooth_step(double from, double to, double x);

}  // namespace prismesh::mesh::deck::sample
