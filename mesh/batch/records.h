// Results, failures and studies as JSON files.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "mesh/batch/result.h"
#include "mesh/batch/study.h"

namespace prismesh::mesh::batch {

std::string result_json(const VariantResult& result);
/// Errors: the file can't be read, or is no result.
Result<VariantResult> read_result(const std::filesystem::path& file);
std::string failure_json(const Failure& failure);
Result<Failure> read_failure(const std::filesystem::path& file);

std::string study_json(const Study& study);
/// Errors: the file can't be read; it is no study; those of parse_plan.
Result<Study> read_study(const std::filesystem::path& file);

}  // namespace prismesh::mesh::batch
