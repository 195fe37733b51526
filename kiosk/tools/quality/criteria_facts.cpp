#include "kiosk/tools/quality/criteria_facts.h"

#include <algorithm>
#include <map>

#include "mesh/quality/criteria.h"
#include "mesh/select/expression.h"

namespace prismesh::kiosk::tools::quality {

CriteriaFacts criteria_facts(const ipc::SnapshotInfo& info, const std::vector<std::filesystem::path>& files) {
  CriteriaFacts facts;
  facts.of_deck = info.criteria;
  facts.of_selection = info.selected_nodes + info.selected_shells > 0;
  std::map<std::string, std::vector<std::int64_t>> parts_of;
  for (const ipc::SnapshotPart& part : info.parts)
    if (!part.criteria.empty()) parts_of[part.criteria].push_back(part.id);
  for (const std::string_view name : mesh::quality::built_in_criteria()) facts.known.emplace_back(name);
  const auto know = [&](const std::string& criteria) {
    if (std::find(facts.known.begin(), facts.known.end(), criteria) == facts.known.end()) facts.known.push_back(criteria);
  };
  if (!info.criteria.empty()) know(info.criteria);
  for (const std::filesystem::path& file : files) know(file.lexically_normal().string());
  for (auto& [criteria, ids] : parts_of) {
    know(criteria);
    facts.own.emplace_back(criteria, mesh::select::to_expression(std::move(ids)));
  }
  return facts;
}

std::string short_criteria(const std::string& criteria) { return std::filesystem::path(criteria).filename().string(); }

}  // namespace prismesh::kiosk::tools::quality
