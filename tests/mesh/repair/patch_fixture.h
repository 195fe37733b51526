// All of a small model as a patch, with all that operations on it need.
#pragma once

#include "mesh/quality/criteria.h"
#include "mesh/repair/acceptance.h"
#include "mesh/repair/strips.h"
#include "tests/mesh/repair/sheets.h"

namespace prismesh::mesh::repair {

/// A patch of a whole model, to try operations in.
struct PatchFixture {
  explicit PatchFixture(Model made, Rules forbidden = {})
      : model(std::move(made)),
        surface(model, all_shells(model), options.relax.feature_angle),
        rules(std::move(forbidden)),
        patch(model, all_shells(model), 1, rules, options.relax.feature_angle),
        context{patch, surface, criteria, options, quality::limits_for(criteria)} {}

  Refusal divide(const Strip& strip, int pieces = 2, bool absorbs = true) {
    patch.begin();
    return divide_strip(context, strip, pieces, absorbs);
  }
  Refusal collapse(const Strip& strip) {
    patch.begin();
    return collapse_strip(context, strip);
  }
  Model after() const { return carried_out(model, patch.result().change); }
  LocalShell shell(std::size_t s) const { return patch.find(shell_at(s)); }

  Model model;
  Options options;
  quality::SizedCriteria criteria{quality::default_criteria(), 1};
  relax::ReferenceSurface surface;
  Rules rules;
  Patch patch;
  RepairContext context;
};

}  // namespace prismesh::mesh::repair
