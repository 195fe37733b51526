// The surface on which shells meet in contact, where it lies beside their nodes.
#pragma once

#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// Returns the model with its shells moved by `offset` (one a shell, deck's length unit) along their normals. A node that several shells
/// share is moved so that all their offsets are kept where they stand on each other, and by their mean where they lie in a plane: by least
/// squares. So bends keep both sides' distances. A node of shells without an offset stays, bit for bit. Costs a copy of the positions that
/// change. Shells without area don't count. Precondition: adjacency; offsets are finite.
Model contact_surface(const Model& model, const std::vector<double>& offset);

}  // namespace prismesh::mesh::contact
