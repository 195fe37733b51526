#include <gtest/gtest.h>

#include <array>
#include <string>

#include "mesh/quality/target_size.h"
#include "tests/mesh/relax/relaxing.h"
#include "tests/support/real_deck.h"

namespace prismesh::test {

namespace {

using namespace mesh;

/// The last three are rough: relaxed without a look at the elements, strips of theirs would fold over.
constexpr std::array kDecks = {"bumper_beam_rad", "hatprofile", "joint_screw", "wheel_k", "simplecar_nas", "seat_adyrel_rad"};

/// Nodes inside sheets slid by up to a third of an element, as a careless slide would.
Model slid(const Model& model, const relax::ReferenceSurface& surface) {
  const NodeSet nodes = all_nodes(model);
  const std::vector<relax::Freedom> freedoms = relax::node_freedoms(model, nodes, 30);
  Model out = model;
  for (std::size_t n = 0; n < nodes.size(); n += 3) {
    if (freedoms[n] != relax::Freedom::surface) continue;
    const ShellIndex shell = model.adjacency->shells_of(nodes[n]).front();
    const ShellNodes& corners = model.shell(shell);
    const int at = corners.node[0] == nodes[n] ? 1 : 0;
    const Vec3 towards = model.position(corners.node[at]) - model.position(nodes[n]);
    out.positions.set(n, surface.follow(shell, model.position(nodes[n]) + 0.33 * noise(static_cast<int>(n), 0, 1) * towards).point);
  }
  return out;
}

TEST(relax_real_decks, makes_nothing_worse_and_slid_meshes_better) {
  const auto decks = real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS names no folder of decks";
  for (const char* name : kDecks) {
    SCOPED_TRACE(name);
    const Model original = open_real(*decks, name);
    const double size = quality::guess_target_size(original);  // one for all parts
    const relax::ReferenceSurface surface(original, all_shells(original), 30);
    for (const bool by_sliding : {false, true}) {
      const Model before = by_sliding ? slid(original, surface) : original;
      const relax::Relaxed relaxed = relax::relax({before, surface, criteria_of(size), {}}, all_nodes(before)).value();
      EXPECT_TRUE(relaxed.converged) << relaxed.rounds << " rounds";
      const Model after = moved(before, relaxed);
      expect_nothing_worse(before, after, size);
      const std::vector<float> was = composites(before, size), is = composites(after, size);
      const auto bad = [](const std::vector<float>& values) {
        return std::count_if(values.begin(), values.end(), [](float v) { return v < 0; });
      };
      EXPECT_LE(bad(is), bad(was));
      if (by_sliding) {
        EXPECT_GT(mean(is), mean(was));
      }
    }
  }
}

/// Elements of a rough mesh lean otherwise once they are relaxed: edges become creases of the mesh that are none of the surface, and
/// creases of the surface become flat.
TEST(relax_real_decks, keeps_corners_and_lines_however_often) {
  const auto decks = real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS names no folder of decks";
  const Model original = open_real(*decks, "seat_adyrel_rad");
  const double size = quality::guess_target_size(original);  // one for all parts
  const relax::ReferenceSurface surface(original, all_shells(original), 30);
  const std::vector<relax::Freedom> freedoms = relax::node_freedoms(original, all_nodes(original), 30);
  Model model = original;
  for (int time = 0; time < 3; ++time)
    model = moved(model, relax::relax({model, surface, criteria_of(size), {}}, all_nodes(model)).value());
  std::size_t changed_classes = 0, moved_corners = 0, off_lines = 0;
  const std::vector<relax::Freedom> by_mesh = relax::node_freedoms(model, all_nodes(model), 30);
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    const Vec3& place = model.position(NodeIndex(n));
    changed_classes += by_mesh[n] != freedoms[n] ? 1 : 0;
    if (freedoms[n] == relax::Freedom::fixed) moved_corners += place != original.position(NodeIndex(n)) ? 1 : 0;
    if (freedoms[n] == relax::Freedom::line) {
      const std::optional<relax::OnLine> line = surface.find_line(place, size);
      off_lines += line && line->distance <= 1e-3 * size ? 0 : 1;
    }
  }
  EXPECT_GT(changed_classes, 50u);  // or it was no trial
  EXPECT_EQ(moved_corners, 0u);
  EXPECT_EQ(off_lines, 0u);
}

}  // namespace

}  // namespace prismesh::test
