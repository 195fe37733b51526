#include "mesh/document/judge_parts.h"

#include <utility>
#include <vector>

#include "mesh/document/clusters.h"

namespace prismesh::mesh::document {

namespace {

bool are_judged_alike(const Judging& before, const Judging& now, PartIndex part) {
  const quality::SizedCriteria a = sized(before).of(part), b = sized(now).of(part);
  return a.target_size == b.target_size && &a.criteria == &b.criteria;
}

}  // namespace

void judge_by(std::shared_ptr<const Judging> judging, Generation& generation) {
  const std::shared_ptr<const Judging> before = std::exchange(generation.judging, std::move(judging));
  const Judging& now = *generation.judging;
  const Model& model = generation.model;
  std::vector<bool> is_changed(now.parts.size(), false);
  for (std::size_t p = 0; p < now.parts.size(); ++p)
    is_changed[p] = p >= before->parts.size() || !are_judged_alike(*before, now, PartIndex(p));
  const bool others_changed = !are_judged_alike(*before, now, PartIndex());
  ShellSet shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const PartIndex part = model.shell_parts[s];
    if ((part.valid() ? is_changed[part.value] : others_changed) && !model.is_removed(ShellIndex(s))) shells.emplace_back(s);
  }
  if (!shells.empty()) quality::rejudge(model, sized(now), shells, generation.quality, generation.counts);
  if (before->criteria.criteria->warn_triangles_at_node != now.criteria.criteria->warn_triangles_at_node)
    generation.clusters = clusters_of(now, model);
}

}  // namespace prismesh::mesh::document
