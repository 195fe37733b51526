#include "mesh/batch/records.h"

#include "base/file.h"
#include "mesh/batch/study_definition.h"

namespace prismesh::mesh::batch {

namespace {

template <class T>
Result<T> read_json(const std::filesystem::path& file, const char* what) {
  const Result<FileBytes> bytes = read_file(file);
  if (!bytes) return fail(bytes.error());
  const json::Json read = json::Json::parse(bytes->text(), nullptr, false);
  T value;
  if (read.is_discarded()) return fail(file.string(), std::string(what) + " isn't JSON");
  if (const json::Problem problem = json::read(read, value, json::Author::program))
    return fail(file.string(), std::string(what) + " " + *problem);
  return value;
}

}  // namespace

std::string result_json(const VariantResult& result) { return json::to_line(json::to_json(result)) + "\n"; }
Result<VariantResult> read_result(const std::filesystem::path& file) { return read_json<VariantResult>(file, "the result of a variant"); }
std::string failure_json(const Failure& failure) { return json::to_line(json::to_json(failure)) + "\n"; }
Result<Failure> read_failure(const std::filesystem::path& file) { return read_json<Failure>(file, "the failure of a variant"); }

std::string study_json(const Study& study) { return json::to_line(json::to_json(study)) + "\n"; }

Result<Study> read_study(const std::filesystem::path& file) {
  Result<Study> study = read_json<Study>(file, "the study");
  if (!study) return study;
  Result<Plan> plan = parse_plan(study->plan_text, study->plan_file);
  if (!plan) return fail(plan.error());
  study->plan = std::move(*plan);
  if (study->decks.size() != study->plan.decks.size() || study->scripts.size() != study->plan.scripts.size())
    return fail(file.string(), "the study doesn't fit its plan");
  return study;
}

}  // namespace prismesh::mesh::batch
