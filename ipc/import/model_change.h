// What edits changed in a model since its deck was opened, as bytes: whoever has read the deck too makes the edited model of it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/error.h"
#include "mesh/model/model.h"

namespace prismesh::ipc {

/// `model` was made from `original` by any number of edits. Costs what differs.
std::vector<std::byte> write_model_change(const mesh::Model& original, const mesh::Model& model);

/// Returns the edited model, with the adjacency null where the structure changed. Errors: the bytes don't fit the model, with what is
/// wrong.
Result<mesh::Model> read_model_change(std::span<const std::byte> bytes, const mesh::Model& original);

}  // namespace prismesh::ipc
