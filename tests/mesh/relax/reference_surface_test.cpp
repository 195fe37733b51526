#include "mesh/relax/reference_surface.h"

#include <gtest/gtest.h>

#include "mesh/model/adjacency.h"
#include "tests/mesh/relax/known_surfaces.h"

namespace prismesh::test {

namespace {

using namespace mesh;

ShellSet all_shells(const Model& model) {
  ShellSet shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s) shells.emplace_back(s);
  return shells;
}

TEST(reference_surface, is_near_the_true_surface) {
  for (const KnownSurface& known : {cylinder(), cone(), torus()})
    for (const double jitter : {0.0, 0.15, 0.3}) {
      const Model model = sheet_on(known, 20, 16, jitter);
      const relax::ReferenceSurface surface(model, all_shells(model), 30);
      double farthest = 0;
      for (int i = 0; i <= 200; ++i)
        for (int j = 0; j <= 160; ++j) {
          const std::optional<relax::OnSurface> on = surface.project(known.at(i * 0.1, j * 0.1), kSize);
          ASSERT_TRUE(on);
          farthest = std::max(farthest, known.off(on->point));
        }
      EXPECT_LE(farthest, 0.1 * known.sagitta) << known.name << ", jitter " << jitter;
    }
}

}  // namespace

}  // namespace prismesh::test
