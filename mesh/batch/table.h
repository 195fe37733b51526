// All variants of a study with what became of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mesh/batch/plan.h"
#include "mesh/batch/result.h"

namespace prismesh::mesh::batch {

enum class RowState : std::uint8_t { failed, missing, refused, done };  ///< in the order in which people look at them
std::string_view name(RowState state);

struct Row {
  std::size_t number = 0;  ///< of the variant, from 1
  std::string key, deck, script;
  std::vector<ParameterValue> values;
  RowState state = RowState::missing;
  std::string reason;                   ///< of a failure or refusal
  std::optional<VariantResult> result;  ///< of those that are refused or done
};

struct Table {
  std::string name, plan_file;
  std::vector<std::string> parameters;
  std::string length_unit;  ///< empty: no result yet
  std::vector<Row> rows;    ///< ascending by number
  std::size_t count(RowState state) const;
};

}  // namespace prismesh::mesh::batch
