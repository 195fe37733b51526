#include "python/errors.h"

#include <stdexcept>

#include "base/progress.h"
#include "mesh/report/printable.h"

namespace prismesh::python {

namespace py = pybind11;

void raise(const Error& error) {
  const py::object kind = py::module_::import("prismesh._errors").attr(is_cancelled(error) ? "Cancelled" : "Error");
  const py::object file = error.file.empty() ? py::object(py::none()) : py::object(path_text(error.file));
  const py::object line = error.line == 0 ? py::object(py::none()) : py::object(py::int_(error.line));
  const py::object raised = kind(mesh::report::printable(error.message), file, line);
  PyErr_SetObject(kind.ptr(), raised.ptr());
  throw py::error_already_set();
}

py::str path_text(const std::string& path) {
  PyObject* text = PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<Py_ssize_t>(path.size()));
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

std::string path_bytes(py::handle path) {
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(path.ptr(), &bytes) == 0) throw py::error_already_set();
  return py::reinterpret_steal<py::bytes>(bytes);
}

}  // namespace prismesh::python
