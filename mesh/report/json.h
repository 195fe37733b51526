// The JSON objects that `info`, `check`, `edit` and `diff` print and that the Python package returns. Scripts rely on their fields.
#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"
#include "mesh/report/check_figures.h"
#include "mesh/report/comparison.h"

namespace prismesh::mesh::report {

nlohmann::ordered_json info_object(const document::Document& document);
nlohmann::ordered_json check_object(const document::Document& document, const CheckFigures& figures);
nlohmann::ordered_json edit_object(const document::EditReport& report);
nlohmann::ordered_json diff_object(const Difference& difference);
/// Null without figures.
nlohmann::ordered_json field_object(const std::optional<FieldFigures>& field);

}  // namespace prismesh::mesh::report
