// What a change of a patch is worth, and whether it may be: measured on the shells it changed, as they were and as they are.
#pragma once

#include <span>
#include <vector>

#include "mesh/quality/judging.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/relax/relax.h"
#include "mesh/repair/patch.h"
#include "mesh/repair/repair.h"

namespace prismesh::mesh::repair {

/// All that a repair works with.
struct RepairContext {
  Patch& patch;
  const relax::ReferenceSurface& surface;
  const relax::Judge& judge;
  const Options& options;
  quality::Limits limits;  ///< the judge's
};

/// Measures and judges shells as they are now.
void judge_shells(const RepairContext& context, std::span<const LocalShell> shells);

/// What the changed shells weigh: failing shells most, then warnings, adjacent triangles, triangles, and how far from ideal each is.
struct Cost {
  double weight = 0;
  float worst = 1;  ///< least composite
  int failing = 0;
  int warning = 0;  ///< not failing
  int triangles = 0;
  int triangle_pairs = 0;  ///< edges between two triangles
};
Cost cost_before(const Patch& patch);
Cost cost_now(const Patch& patch);

/// Whether the mesh is whole: no shell twice or with a node twice, every edge inside a sheet has two shells, every line as many as it had,
/// and nothing is folded over.
bool conforms(const Patch& patch);

/// Whether a shell that passed fails now, or a new one fails without another being cured.
bool harms(const Patch& patch);

/// Whether what changed keeps to the surface: no new edge or centre farther off than allowed, or than what was there before.
bool keeps_to_surface(const RepairContext& context);

/// The place on the surface for a point near it; nothing if there is none close by.
std::optional<Vec3> on_surface(const RepairContext& context, const Vec3& point, const Vec3& toward, double radius);

/// Whether a node may be at a place: one of the model no farther from where it was than the options allow.
bool within_limit(const RepairContext& context, LocalNode node, const Vec3& place);

/// Moves nodes that the change touched, and that may be moved, to where their shells are best; `along_lines`: those on feature lines too.
void settle(const RepairContext& context, int sweeps, bool along_lines);

/// Twice a shell's area as a vector.
Vec3 area_normal(const Patch& patch, const Corners& corners);

}  // namespace prismesh::mesh::repair
