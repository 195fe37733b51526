// Python's values as JSON and back. Inner to python.
#pragma once

#include <pybind11/pybind11.h>
#include <nlohmann/json_fwd.hpp>

namespace prismesh::python {

/// None, bool, int, float, str, paths, lists, tuples, dicts, and what has `tolist`: NumPy's arrays and numbers. Raises prismesh.Error for
/// others, for numbers that JSON can't hold and for nesting without end.
nlohmann::json to_json(pybind11::handle value);

/// Objects become dicts with the same order. Numbers that aren't finite become None, as in the text that the command line prints.
pybind11::object to_python(const nlohmann::ordered_json& json);

}  // namespace prismesh::python
