// How figures depend on parameters, as small pictures. Private to mesh/batch.
#pragma once

#include <string>

#include "mesh/batch/table.h"

namespace prismesh::mesh::batch {

/// A section of the page; empty where no parameter is a number or nothing is done.
std::string scatter_section(const Table& table);

}  // namespace prismesh::mesh::batch
