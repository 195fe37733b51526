// A state of a document as arrays. Inner to python.
#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "mesh/document/generation.h"

namespace prismesh::python {

/// Registers State and ChunkedArray.
void define_state(pybind11::module_& module);

/// A state that stays as it is, whatever is edited afterwards.
struct State {
  std::shared_ptr<const mesh::document::Generation> generation;
};

}  // namespace prismesh::python
