#include "mesh/relax/relax.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>

#include "mesh/quality/composite.h"
#include "mesh/quality/report.h"
#include "tests/mesh/relax/known_surfaces.h"

namespace prismesh::test {

namespace {

using namespace mesh;

ShellSet all_shells(const Model& model) {
  ShellSet shells(model.shell_count());
  for (std::size_t s = 0; s < shells.size(); ++s) shells[s] = ShellIndex(s);
  return shells;
}

NodeSet all_nodes(const Model& model) {
  NodeSet nodes(model.node_count());
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = NodeIndex(n);
  return nodes;
}

relax::Judge judge_of(double size = kSize) { return {quality::default_criteria(), size}; }

Model moved(Model model, const relax::Relaxed& relaxed) {
  for (std::size_t i = 0; i < relaxed.nodes.size(); ++i) model.positions.set(relaxed.nodes[i].value, relaxed.positions[i]);
  return model;
}

std::vector<float> composites(const Model& model, double size = kSize) {
  std::vector<float> rated(model.shell_count());
  quality::composites(model, all_shells(model), quality::default_criteria(), size, rated);
  return rated;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

relax::Relaxed relax_all(const Model& model, const relax::Options& options = {}) {
  const relax::ReferenceSurface surface(model, all_shells(model), options.feature_angle);
  return relax::relax(model, surface, all_nodes(model), judge_of(), options).value();
}

TEST(relax, stays_on_the_true_surface_and_makes_elements_better) {
  for (const KnownSurface& known : {cylinder(), cone(), torus()})
    for (const double jitter : {0.15, 0.3, 0.4}) {
      const Model before = sheet_on(known, 20, 16, jitter);
      const relax::Relaxed relaxed = relax_all(before);
      const Model after = moved(before, relaxed);
      double off = 0;
      for (const Vec3& position : relaxed.positions) off = std::max(off, known.off(position));
      const std::vector<float> was = composites(before), is = composites(after);
      std::printf("%s %.2f: rounds %d conv %d held %zu moved %zu off %.2f%% mean %.3f -> %.3f min %.3f -> %.3f far %.2f\n",
                  known.name.c_str(), jitter, relaxed.rounds, relaxed.converged, relaxed.held_back, relaxed.nodes.size(),
                  100 * off / known.sagitta, mean(was), mean(is), *std::min_element(was.begin(), was.end()),
                  *std::min_element(is.begin(), is.end()), relaxed.farthest);
      EXPECT_LE(off, 0.1 * known.sagitta) << known.name << ", jitter " << jitter;
      EXPECT_GT(mean(is), mean(was));
      EXPECT_GE(*std::min_element(is.begin(), is.end()), *std::min_element(was.begin(), was.end()));
      EXPECT_TRUE(relaxed.converged);
      const relax::Relaxed again =
          relax::relax(after, relax::ReferenceSurface(before, all_shells(before), 30), all_nodes(after), judge_of(), {}).value();
      std::printf("   again: rounds %d far %.3f\n", again.rounds, again.farthest);
    }
}

}  // namespace

}  // namespace prismesh::test
