#include "python/json_values.h"

#include <cmath>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "python/errors.h"

namespace prismesh::python {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;

constexpr int kMaxDepth = 32;  ///< no edit has more than a few; a list may hold itself

[[noreturn]] void refuse(const std::string& message) { raise(Error{{}, 0, message}); }

std::string type_name(py::handle value) { return py::str(py::type::handle_of(value).attr("__name__")); }

Json whole_number(py::handle value) {
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
  if (overflow != 0) refuse("the number " + std::string(py::str(value)) + " is too large for an edit");
  if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  // As the parser of JSON text has them.
  return number < 0 ? Json(std::int64_t{number}) : Json(static_cast<std::uint64_t>(number));
}

Json fraction(py::handle value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (!std::isfinite(number)) refuse("an edit can't hold the number " + std::string(py::str(value)) + ", which isn't finite");
  return number;
}

std::string text(py::handle value) {
  Py_ssize_t size = 0;
  const char* bytes = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (bytes == nullptr) {
    PyErr_Clear();
    refuse("an edit can't hold a text that isn't valid Unicode");
  }
  return {bytes, static_cast<std::size_t>(size)};
}

Json converted(py::handle value, int depth) {
  if (depth > kMaxDepth) refuse("the edit is nested more than " + std::to_string(kMaxDepth) + " deep");
  if (value.is_none()) return nullptr;
  if (py::isinstance<py::bool_>(value)) return py::cast<bool>(value);
  if (py::isinstance<py::int_>(value)) return whole_number(value);
  if (py::isinstance<py::float_>(value)) return fraction(value);
  if (py::isinstance<py::str>(value)) return text(value);
  if (py::isinstance<py::dict>(value)) {
    Json object = Json::object();
    for (const auto& [key, field] : py::reinterpret_borrow<py::dict>(value)) {
      if (!py::isinstance<py::str>(key)) refuse("the fields of an edit are named by texts, not by a value of type " + type_name(key));
      object[text(key)] = converted(field, depth + 1);
    }
    return object;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    Json array = Json::array();
    for (const py::handle item : py::reinterpret_borrow<py::sequence>(value)) array.push_back(converted(item, depth + 1));
    return array;
  }
  if (py::hasattr(value, "tolist")) return converted(value.attr("tolist")(), depth + 1);
  if (py::hasattr(value, "__fspath__")) return text(value.attr("__fspath__")());
  refuse("an edit can't hold a value of type " + type_name(value));
}

}  // namespace

Json to_json(py::handle value) { return converted(value, 0); }

py::object to_python(const nlohmann::ordered_json& json) {
  using Type = nlohmann::ordered_json::value_t;
  switch (json.type()) {
    case Type::boolean: return py::bool_(json.get<bool>());
    case Type::number_integer: return py::int_(json.get<std::int64_t>());
    case Type::number_unsigned: return py::int_(json.get<std::uint64_t>());
    case Type::number_float: {
      const double number = json.get<double>();
      return std::isfinite(number) ? py::object(py::float_(number)) : py::object(py::none());
    }
    case Type::string: return py::str(json.get_ref<const std::string&>());
    case Type::array: {
      py::list list;
      for (const auto& item : json) list.append(to_python(item));
      return list;
    }
    case Type::object: {
      py::dict dict;
      for (const auto& [key, field] : json.items()) dict[py::str(key)] = to_python(field);
      return dict;
    }
    default: return py::none();
  }
}

}  // namespace prismesh::python
