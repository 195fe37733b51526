// Shells of real decks are divided, their neighbours fitted, and a free one removed: what is saved is the same model, and only the lines
// that had to differ do.
#include <cstdlib>
#include <iostream>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "mesh/model/adjacency.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

/// Quads spread over the deck, each with its neighbours, none touching another's.
std::vector<ShellIndex> some_quads(const Model& model, std::size_t wanted) {
  std::vector<ShellIndex> out;
  std::set<ShellIndex> taken;
  const std::size_t step = std::max<std::size_t>(1, model.shell_count() / (wanted * 7));
  for (std::size_t s = 0; s < model.shell_count() && out.size() < wanted; s += step) {
    const ShellNodes& nodes = model.shell(ShellIndex(s));
    if (nodes.is_triangle()) continue;
    std::set<ShellIndex> around{ShellIndex(s)};
    bool once = true;
    for (std::size_t e = 0; e < 4; ++e)
      for (const ShellIndex other : model.adjacency->shells_of(model.adjacency->find_edge(nodes.node[e], nodes.node[(e + 1) % 4])))
        if (other != ShellIndex(s)) once &= around.insert(other).second;
    for (const ShellIndex shell : around) once &= !taken.contains(shell);
    if (!once) continue;
    taken.insert(around.begin(), around.end());
    out.push_back(ShellIndex(s));
  }
  return out;
}

TEST(GrowingRealDecks, are_saved_as_they_are_and_only_where_they_differ) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (!models || !fs::exists(fs::path(models) / "counts.json")) {
    std::cout << "PRISMESH_MODELS doesn't point to the real decks: THE TESTS ON THEM ARE SKIPPED\n";
    GTEST_SKIP();
  }
  for (const char* name :
       {"hatprofile/Hatprofile.k", "gsa_car6_comma/car6_crash.k", "wheel_k/wheel.k", "pillars_open_airbag_v135/open_airbag_v135.k",
        "bird_strike_composite/input.k", "joint_screw/EXP_SC_JOINT_SCREW.key", "simplecar_nas/full_car.nas",
        "bumper_beam_rad/Bumper_Beam_AP_meshed_0000.rad", "jp_model_inp/model.inp"}) {
    SCOPED_TRACE(name);
    const auto opened = deck::open(fs::path(models) / name);
    ASSERT_OPENED(opened);
    Growing edit(*opened);
    std::size_t split = 0;
    for (const ShellIndex quad : some_quads(opened->model, 5)) {
      const Model before = edit.model;
      edit.split_conforming(quad);
      const auto may = can_save(edit.deck, edit.original, edit.model);
      if (may)
        ++split;
      else
        edit.model = before, std::cout << name << ": " << may.error().text() << '\n';
    }
    EXPECT_GT(split, 0u);
    const DeckFolder folder;
    const auto saved = save(edit.deck, edit.original, edit.model, folder / "main.k");
    ASSERT_TRUE(saved) << saved.error().text();
    const auto again = deck::open(folder / "main.k");
    ASSERT_OPENED(again);
    // Nastran's eight columns hold "-1331.88" in a car of 4140.
    expect_same(again->model, edit.model, edit.deck.format == Format::nastran ? 3e-6 : 1e-6);
    EXPECT_EQ(saved->shells_added, live_shells(edit.model) - edit.original.shell_count());
    const LineDifference lines = line_difference(content(fs::path(models) / name), content(folder / "main.k"));
    EXPECT_GE(lines.come.size(), saved->shells_added + saved->nodes_added);
    if (edit.deck.files.size() == 1) {
      EXPECT_LE(std::max(lines.come.size(), lines.gone.size()), saved->lines_changed);
    }
    std::cout << name << ": " << split << " divided, " << saved->nodes_added << " nodes, " << saved->shells_added << " shells, "
              << saved->shells_changed << " changed, " << saved->set_cards_changed << " sets, " << saved->lines_changed << " lines\n";
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
