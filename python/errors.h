// Turns the project's errors into exceptions of Python. Inner to python.
#pragma once

#include <pybind11/pybind11.h>

#include "base/error.h"

namespace prismesh::python {

/// Raises prismesh.Error with the file, the line and the sentence; prismesh.Cancelled for work that was told to stop. Needs the GIL.
[[noreturn]] void raise(const Error& error);

/// The value, or the exception.
template <class T>
T value_or_raise(Result<T>&& result) {
  if (!result) raise(result.error());
  return std::move(*result);
}

/// A path as the file system has it: bytes that aren't UTF-8 become what os.fsdecode makes of them.
pybind11::str path_text(const std::string& path);
/// What os.fspath makes of a str or path-like object, as the file system's bytes. Raises TypeError for others.
std::string path_bytes(pybind11::handle path);

}  // namespace prismesh::python
