// Mass and centre of gravity of shells.
#pragma once

#include <optional>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::quality {

/// A sum over shells; those whose thickness or density isn't known are left out.
struct MassProperties {
  double mass = 0;             ///< deck's units
  Vec3 moment = Vec3::Zero();  ///< first moment of mass: mass times position
  std::size_t shells = 0;      ///< number of shells in the sum

  MassProperties& operator+=(const MassProperties& more);
  MassProperties& operator-=(const MassProperties& less);
  std::optional<Vec3> centre() const;  ///< centre of gravity; nothing without mass
};

/// Of one shell. A quad counts as two triangles, so that its centre is right where it isn't a parallelogram.
MassProperties mass_properties(const Model& model, ShellIndex shell);
/// Of all shells; the sum doesn't depend on the number of threads.
MassProperties mass_properties(const Model& model);
MassProperties mass_properties(const Model& model, const ShellSet& shells);

}  // namespace prismesh::mesh::quality
