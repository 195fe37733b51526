// JSON values in several of the printed objects. Only sources that write JSON include it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace prismesh::mesh::report {

/// The value, or null without one.
template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace prismesh::mesh::report
