#include "mesh/document/judging.h"

#include "mesh/quality/target_size.h"

namespace prismesh::mesh::document {

namespace {

quality::PartCriteria settled_criteria(const Judging& judging, std::size_t part) {
  const PartChoice& own = judging.parts[part];
  const TargetSize size = own.target_size.value_or(judging.target_size);
  quality::PartCriteria found = judging.guessed[part];
  if (const double* given = std::get_if<double>(&size))
    found = {*given, nullptr, quality::SizeFrom::given};
  else if (std::get<SizeGuess>(size) == SizeGuess::deck)
    found = {judging.guessed_size, nullptr, quality::SizeFrom::deck};
  if (own.criteria) found.criteria = own.criteria->criteria;
  return found;
}

}  // namespace

void settle(Judging& judging) {
  const double* given = std::get_if<double>(&judging.target_size);
  judging.deck_size = given != nullptr ? *given : judging.guessed_size;
  std::vector<quality::PartCriteria> of_parts;
  of_parts.reserve(judging.parts.size());
  for (std::size_t p = 0; p < judging.parts.size(); ++p) of_parts.push_back(settled_criteria(judging, p));
  judging.by_part = quality::share_entries(of_parts);
}

}  // namespace prismesh::mesh::document
