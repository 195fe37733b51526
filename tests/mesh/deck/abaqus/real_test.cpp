// The real Abaqus and CalculiX decks PRISMESH_MODELS points to: counts against an independent counter's, saving, an edit of one node.
#include <cstdlib>
#include <iostream>

#include <nlohmann/json.hpp>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

class RealAbaqusDecks : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* models = std::getenv("PRISMESH_MODELS");
    if (!models || !fs::exists(fs::path(models) / "counts.json")) {
      std::cout << "PRISMESH_MODELS doesn't point to the real decks: THE TESTS ON THEM ARE SKIPPED\n";
      GTEST_SKIP();
    }
    std::ifstream in(fs::path(models) / "counts.json");
    const nlohmann::json counts = nlohmann::json::parse(in);
    for (const auto& [id, deck] : counts.items())
      if (deck["format"] == "abaqus") decks_.push_back({id, fs::path(models) / deck["main"].get<std::string>(), deck});
    ASSERT_EQ(decks_.size(), 5u);
  }

  struct Real {
    std::string id;
    fs::path path;
    nlohmann::json wanted;
  };
  std::vector<Real> decks_;
};

TEST_F(RealAbaqusDecks, have_the_counts_of_the_independent_counter) {
  for (const Real& real : decks_) {
    SCOPED_TRACE(real.id);
    const auto opened = deck::open(real.path);
    ASSERT_OPENED(opened);
    const Deck& deck = *opened->deck;
    EXPECT_EQ(deck.format, Format::abaqus);
    EXPECT_EQ(opened->model.node_count(), real.wanted["nodes"]);
    EXPECT_EQ(opened->model.shell_count(), real.wanted["shells"]);
    EXPECT_EQ(deck.element_cards.shells(), real.wanted["shells"]);
    EXPECT_EQ(nlohmann::json(deck.element_kinds), real.wanted["elements"]);
    EXPECT_EQ(deck.missing_files, real.wanted["missing_includes"].get<std::vector<std::string>>());
    for (const Warning& warning : deck.warnings) {
      // jp_model_inp has no section at all.
      EXPECT_TRUE(warning.kind == "undefined-part" && real.id == "jp_model_inp") << warning.message;
    }
    // The counter counts *SHELL SECTION only, and elements by the set of their *ELEMENT.
    std::size_t shell_sections = 0;
    for (const Part& part : *opened->model.parts) shell_sections += part.thickness.has_value();
    EXPECT_EQ(shell_sections, real.wanted["parts_defined"]);
    const auto sets = real.wanted["parts_with_elements"].get<std::size_t>();
    // In ccx_wire one *ELEMENT set holds beams and shells that have a section each.
    EXPECT_EQ(opened->model.parts->size(), real.id == "ccx_wire" ? sets + 1 : sets);
  }
}

TEST_F(RealAbaqusDecks, are_saved_byte_for_byte_and_change_a_line_for_a_node) {
  for (const Real& real : decks_) {
    SCOPED_TRACE(real.id);
    const auto opened = deck::open(real.path);
    ASSERT_OPENED(opened);
    const DeckFolder folder;
    ASSERT_TRUE(save(*opened->deck, opened->model, opened->model, folder / "main.inp"));
    const std::string before = content(real.path);
    EXPECT_EQ(content(folder / "main.inp"), before);
    for (const std::size_t node : {std::size_t{0}, opened->model.node_count() / 2, opened->model.node_count() - 1}) {
      Model model = opened->model;
      model.positions.set(node, model.positions[node] + Vec3(0.1, 1.0 / 3, -2));
      const auto saved = save(*opened->deck, opened->model, model, folder / "main.inp");
      ASSERT_TRUE(saved) << saved.error().text();
      EXPECT_EQ(saved->lines_changed, 1u);
      const std::string after = content(folder / "main.inp");
      const std::size_t line = opened->deck->node_line[node];
      EXPECT_EQ(after.substr(0, line), before.substr(0, line));
      EXPECT_EQ(after.substr(after.find('\n', line)), before.substr(before.find('\n', line)));
      const auto again = deck::open(folder / "main.inp");
      ASSERT_OPENED(again);
      EXPECT_EQ(moved_nodes(opened->model, again->model), std::vector<NodeIndex>{NodeIndex(node)});
      EXPECT_LT((again->model.positions[node] - model.positions[node]).norm(), 1e-14 * model.positions[node].norm());
    }
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
