// JSON values that several of the printed objects hold. Inner to cli: only the two sources that print JSON include it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace prismesh::cli {

/// null where there is no value.
template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace prismesh::cli
