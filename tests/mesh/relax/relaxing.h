// What tests of relaxing have in common.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/deterministic_math.h"
#include "mesh/quality/composite.h"
#include "mesh/quality/report.h"
#include "mesh/relax/freedom.h"
#include "mesh/relax/relax.h"
#include "tests/mesh/relax/known_surfaces.h"
#include "tests/support/whole_model.h"

namespace prismesh::test {

inline mesh::quality::SizedCriteria criteria_of(double size = kSize) { return {mesh::quality::default_criteria(), size}; }

inline mesh::Model moved(mesh::Model model, const mesh::relax::Relaxed& relaxed) {
  for (std::size_t i = 0; i < relaxed.nodes.size(); ++i) model.positions.set(relaxed.nodes[i].value, relaxed.positions[i]);
  return model;
}

inline std::vector<float> composites(const mesh::Model& model, double size = kSize) {
  std::vector<float> rated(model.shell_count());
  mesh::quality::composites(model, all_shells(model), {mesh::quality::default_criteria(), size}, rated);
  return rated;
}

inline double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

inline double least(const std::vector<float>& values) { return *std::min_element(values.begin(), values.end()); }

inline mesh::relax::Relaxed relax_all(const mesh::Model& model, const mesh::relax::Options& options = {}) {
  const mesh::relax::ReferenceSurface surface(model, all_shells(model), options.feature_angle);
  return mesh::relax::relax({model, surface, criteria_of(), options}, all_nodes(model)).value();
}

/// By each metric, and by the composite's least.
inline void expect_nothing_worse(const mesh::Model& before, const mesh::Model& after, double size) {
  const auto was = mesh::quality::judge_model(before, {mesh::quality::default_criteria(), size});
  const auto is = mesh::quality::judge_model(after, {mesh::quality::default_criteria(), size});
  std::size_t new_fails = 0, new_warnings = 0;
  for (std::size_t s = 0; s < was.size(); ++s) {
    new_fails += (is[s].fail & ~was[s].fail) != 0 ? 1 : 0;
    new_warnings += (is[s].warn & ~was[s].warn) != 0 ? 1 : 0;
  }
  EXPECT_EQ(new_fails, 0u);
  EXPECT_EQ(new_warnings, 0u);
  EXPECT_GE(least(composites(after, size)), least(composites(before, size)));
}

}  // namespace prismesh::test
