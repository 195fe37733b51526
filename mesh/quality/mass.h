// The mass of shells and where its centre lies.
#pragma once

#include <optional>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::quality {

/// A sum over shells; those whose thickness or density isn't known count for nothing.
struct Weight {
  double mass = 0;             ///< deck's units
  Vec3 moment = Vec3::Zero();  ///< mass times place
  std::size_t shells = 0;      ///< whose mass is known

  Weight& operator+=(const Weight& more);
  Weight& operator-=(const Weight& less);
  std::optional<Vec3> centre() const;  ///< nothing without mass
};

/// A quad as two triangles, so that the centre of a slanted one is right.
Weight weigh_shell(const Model& model, ShellIndex shell);
/// All shells; the sum doesn't depend on the number of threads.
Weight weigh_model(const Model& model);
Weight weigh_shells(const Model& model, const ShellSet& shells);

}  // namespace prismesh::mesh::quality
