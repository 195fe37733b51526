#include "mesh/document/chosen_criteria.h"

#include <utility>

namespace prismesh::mesh::document {

Result<ChosenCriteria> load_chosen_criteria(const std::string& name, double time_step_scale) {
  Result<std::string> text = quality::criteria_text(name);
  if (!text) return fail(std::move(text.error()));
  return read_chosen_criteria(name, std::move(*text), time_step_scale);
}

Result<ChosenCriteria> read_chosen_criteria(const std::string& name, std::string text, double time_step_scale) {
  if (text.size() > quality::kMaxCriteriaBytes) return fail(name, "a criteria file has at most 1 MiB");
  Result<quality::Criteria> criteria = quality::parse_criteria(text, name);
  if (!criteria) return fail(std::move(criteria.error()));
  if (criteria->name.empty()) criteria->name = std::filesystem::path(name).filename().string();
  criteria->time_step_scale = time_step_scale;
  return ChosenCriteria{name, std::make_shared<const quality::Criteria>(std::move(*criteria)),
                        std::make_shared<const std::string>(std::move(text))};
}

ChosenCriteria default_choice(double time_step_scale) {
  auto criteria = std::make_shared<quality::Criteria>(quality::default_criteria());
  criteria->time_step_scale = time_step_scale;
  return {"", std::move(criteria), std::make_shared<const std::string>()};
}

bool is_same_choice(const ChosenCriteria& a, const ChosenCriteria& b) {
  return a.name == b.name && (a.text == b.text || (a.text && b.text && *a.text == *b.text));
}

ChosenCriteria shared_choice(const Judging& judging, ChosenCriteria chosen) {
  if (is_same_choice(judging.criteria, chosen)) return judging.criteria;
  for (const PartChoice& part : judging.parts)
    if (part.criteria && is_same_choice(*part.criteria, chosen)) return *part.criteria;
  return chosen;
}

std::string criteria_place(const std::string& name, const std::filesystem::path& folder) {
  if (quality::is_built_in_criteria(name)) return name;
  const std::string place = (folder / name).lexically_normal().string();
  return quality::is_built_in_criteria(place) ? "./" + place : place;  // ./strict is a file
}

}  // namespace prismesh::mesh::document
