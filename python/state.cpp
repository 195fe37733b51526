#include "python/state.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "mesh/document/selection.h"
#include "python/errors.h"

namespace prismesh::python {

namespace {

namespace py = pybind11;
using mesh::Model;
using mesh::document::Generation;

// What NumPy is told of the types of chunks.
static_assert(sizeof(mesh::Vec3) == 3 * sizeof(double) && sizeof(mesh::ShellNodes) == 4 * sizeof(std::uint32_t) &&
              sizeof(mesh::PartIndex) == sizeof(std::uint32_t) && sizeof(mesh::NodeIndex) == sizeof(std::uint32_t));

/// A read-only array at `data`, of `width` numbers an entry, which keeps `owner` alive. `width` 0: one number, and no second axis.
template <class Number>
py::array view(const void* data, std::size_t count, std::size_t width, std::shared_ptr<const void> owner) {
  auto held = std::make_unique<std::shared_ptr<const void>>(std::move(owner));
  const py::capsule base(held.get(), [](void* pointer) { delete static_cast<std::shared_ptr<const void>*>(pointer); });
  held.release();
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(count)};
  if (width > 0) shape.push_back(static_cast<py::ssize_t>(width));
  py::array array(py::dtype::of<Number>(), shape, {}, data, base);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// An array in chunks, as views and as a copy.
struct Chunks {
  std::vector<py::array> views;  ///< never empty
  std::size_t size = 0;

  py::array copied() const {
    const py::array& first = views.front();
    std::vector<py::ssize_t> shape(first.shape(), first.shape() + first.ndim());
    shape[0] = static_cast<py::ssize_t>(size);
    py::array all(first.dtype(), shape);
    auto* to = static_cast<char*>(all.mutable_data());
    for (const py::array& each : views) {
      std::memcpy(to, each.data(), static_cast<std::size_t>(each.nbytes()));
      to += each.nbytes();
    }
    return all;
  }
};

template <class Number, class T>
Chunks chunks_of(const mesh::ChunkedArray<T>& array, std::size_t width = 0) {
  Chunks chunks;
  chunks.size = array.size();
  for (std::size_t c = 0; c < array.chunk_count(); ++c)
    chunks.views.push_back(view<Number>(array.chunk(c).data(), array.chunk(c).size(), width, array.chunk_owner(c)));
  if (chunks.views.empty()) chunks.views.push_back(view<Number>(nullptr, 0, width, nullptr));
  return chunks;
}

py::array_t<std::int64_t> ids(const mesh::ChunkedArray<std::int64_t>& all, const auto& wanted) {
  py::array_t<std::int64_t> array(static_cast<py::ssize_t>(wanted.size()));
  std::int64_t* to = array.mutable_data();
  for (const auto index : wanted) *to++ = all[index.value];
  std::sort(array.mutable_data(), to);
  return array;
}

/// 0 ok, 1 warn, 2 fail, 3 removed.
py::array_t<std::uint8_t> shell_grades(const State& state) {
  const auto& quality = state.generation->quality;
  py::array_t<std::uint8_t> grades(static_cast<py::ssize_t>(quality.size()));
  std::uint8_t* to = grades.mutable_data();
  for (std::size_t s = 0; s < quality.size(); ++s)
    *to++ = quality[s].is_removed()                            ? 3
            : quality[s].grade() == mesh::quality::Grade::fail ? 2
            : quality[s].grade() == mesh::quality::Grade::warn ? 1
                                                               : 0;
  return grades;
}

py::array_t<std::int64_t> part_ids(const State& state) {
  const std::vector<mesh::Part>& parts = *state.generation->model.parts;
  py::array_t<std::int64_t> array(static_cast<py::ssize_t>(parts.size()));
  std::int64_t* to = array.mutable_data();
  for (const mesh::Part& part : parts) *to++ = part.id;
  return array;
}

py::dict elements(const State& state, const std::string& element_class) {
  for (int c = 1; c < mesh::kElementClassCount; ++c) {
    if (name(static_cast<mesh::ElementClass>(c)) != element_class) continue;
    const std::shared_ptr<const mesh::ElementBlock>& block = state.generation->model.elements[static_cast<std::size_t>(c)];
    py::dict arrays;
    arrays["ids"] = view<std::int64_t>(block->id.data(), block->id.size(), 0, block);
    arrays["parts"] = view<std::uint32_t>(block->part.data(), block->part.size(), 0, block);
    arrays["first_node"] = view<std::uint32_t>(block->first_node.data(), block->first_node.size(), 0, block);
    arrays["nodes"] = view<std::uint32_t>(block->nodes.data(), block->nodes.size(), 0, block);
    return arrays;
  }
  std::string known;
  for (int c = 1; c < mesh::kElementClassCount; ++c) known += (c > 1 ? ", " : "") + std::string(name(static_cast<mesh::ElementClass>(c)));
  raise(Error{{}, 0, "there is no class of elements \"" + element_class + "\"; the classes are " + known});
}

template <class Number, class T>
auto member(mesh::ChunkedArray<T> Model::*array, std::size_t width = 0) {
  return [array, width](const State& state) { return chunks_of<Number>(state.generation->model.*array, width); };
}

}  // namespace

void define_state(py::module_& module) {
  py::class_<Chunks>(module, "ChunkedArray")
      .def("__len__", [](const Chunks& chunks) { return chunks.size; })
      .def_property_readonly("shape",
                             [](const Chunks& chunks) {
                               const py::array& first = chunks.views.front();
                               return first.ndim() == 1 ? py::make_tuple(chunks.size) : py::make_tuple(chunks.size, first.shape(1));
                             })
      .def_property_readonly("dtype", [](const Chunks& chunks) { return chunks.views.front().dtype(); })
      .def_property_readonly("chunks", [](const Chunks& chunks) { return chunks.size == 0 ? std::vector<py::array>() : chunks.views; })
      .def("copy", &Chunks::copied)
      .def(
          "__array__",
          [](const Chunks& chunks, const py::object& dtype, const py::object& copy) -> py::object {
            if (copy.is(py::bool_(false))) throw py::value_error("the array is in chunks, so a whole one is a copy; .chunks are views");
            return dtype.is_none() ? py::object(chunks.copied()) : chunks.copied().attr("astype")(dtype);
          },
          py::arg("dtype") = py::none(), py::arg("copy") = py::none());

  py::class_<State>(module, "State")
      .def_property_readonly("made_by", [](const State& state) { return state.generation->made_by; })
      .def_property_readonly("node_ids", member<std::int64_t>(&Model::node_ids))
      .def_property_readonly("positions", member<double>(&Model::positions, 3))
      .def_property_readonly("node_holds", member<std::uint8_t>(&Model::node_holds))
      .def_property_readonly("shell_ids", member<std::int64_t>(&Model::shell_ids))
      .def_property_readonly("shell_nodes", member<std::uint32_t>(&Model::shell_nodes, 4))
      .def_property_readonly("shell_parts", member<std::uint32_t>(&Model::shell_parts))
      .def_property_readonly("shell_thickness", member<float>(&Model::shell_thickness))
      .def_property_readonly("shell_grades", &shell_grades)
      .def_property_readonly("part_ids", &part_ids)
      .def_property_readonly(
          "selected_nodes",
          [](const State& state) { return ids(state.generation->model.node_ids, mesh::document::selected_nodes(*state.generation)); })
      .def_property_readonly(
          "selected_shells",
          [](const State& state) { return ids(state.generation->model.shell_ids, mesh::document::selected_shells(*state.generation)); })
      .def("elements", &elements, py::arg("element_class"));
}

}  // namespace prismesh::python
