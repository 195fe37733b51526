// The module prismesh._core; python/prismesh/__init__.py gives its names to users.
#include <filesystem>
#include <utility>

#include <pybind11/pybind11.h>
#include <nlohmann/json.hpp>

#include "mesh/deck/open.h"
#include "mesh/report/json.h"
#include "python/document.h"
#include "python/errors.h"
#include "python/json_values.h"
#include "python/long_work.h"
#include "python/state.h"

namespace prismesh::python {

namespace {

namespace py = pybind11;

/// What `prismesh diff A B --json` prints.
py::object diff(const py::object& a, const py::object& b, py::object progress) {
  const std::filesystem::path paths[] = {path_bytes(a), path_bytes(b)};
  LongWork work(std::move(progress));
  const auto open_one = [](const std::filesystem::path& path, const Progress& shown) {
    Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(path, shown);
    if (!opened && opened.error().file.empty()) opened.error().file = path.string();
    return opened;
  };
  const Result<nlohmann::ordered_json> compared = work.run([&](const Progress& shown) -> Result<nlohmann::ordered_json> {
    const Result<mesh::deck::OpenedDeck> first = open_one(paths[0], shown);
    if (!first) return fail(first.error());
    const Result<mesh::deck::OpenedDeck> second = open_one(paths[1], shown);
    if (!second) return fail(second.error());
    return mesh::report::diff_object(mesh::report::compare(*first, *second));
  });
  work.raise_what_stopped_it();
  if (!compared) raise(compared.error());
  return to_python(*compared);
}

}  // namespace

}  // namespace prismesh::python

PYBIND11_MODULE(_core, module) {
  namespace python = prismesh::python;
  python::define_state(module);
  python::define_document(module);
  module.def("diff", &python::diff, pybind11::arg("a"), pybind11::arg("b"), pybind11::kw_only(),
             pybind11::arg("progress") = pybind11::none());
  module.attr("__version__") = PRISMESH_VERSION;
}
