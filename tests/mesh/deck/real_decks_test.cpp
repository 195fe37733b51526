// The real decks PRISMESH_MODELS points to: counts against an independent counter's, saving byte for byte, and an edit of one
// node that changes one line.
#include <cstdlib>
#include <iostream>

#include <nlohmann/json.hpp>

#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

class RealDecks : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* models = std::getenv("PRISMESH_MODELS");
    if (!models || !fs::exists(fs::path(models) / "counts.json")) {
      std::cout << "PRISMESH_MODELS doesn't point to the real decks: THE TESTS ON THEM ARE SKIPPED\n";
      GTEST_SKIP();
    }
    models_ = models;
    std::ifstream in(models_ / "counts.json");
    counts_ = nlohmann::json::parse(in);
  }

  /// Name and counts of every deck of a format.
  std::vector<std::pair<std::string, nlohmann::json>> decks(const std::string& format) const {
    std::vector<std::pair<std::string, nlohmann::json>> out;
    for (const auto& [id, deck] : counts_.items())
      if ((deck["format"] == "lsdyna") == (format == "lsdyna") && (format == "lsdyna" || deck["format"] == format))
        out.emplace_back(id, deck);
    return out;
  }
  fs::path path(const nlohmann::json& deck) const { return models_ / deck["main"].get<std::string>(); }

  fs::path models_;
  nlohmann::json counts_;
};

std::size_t lines_that_differ(const std::string& a, const std::string& b) {
  std::size_t differ = 0;
  std::string_view x = a, y = b;
  while (!x.empty() || !y.empty()) {
    const std::size_t i = std::min(x.find('\n'), x.size()), j = std::min(y.find('\n'), y.size());
    differ += x.substr(0, i) != y.substr(0, j);
    x.remove_prefix(std::min(i + 1, x.size()));
    y.remove_prefix(std::min(j + 1, y.size()));
  }
  return differ;
}

TEST_F(RealDecks, have_the_counts_of_the_independent_counter) {
  const auto all = decks("lsdyna");
  EXPECT_EQ(all.size(), 21u);
  for (const auto& [id, wanted] : all) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    const Deck& deck = *opened->deck;
    const ElementCounts& cards = deck.element_cards;
    EXPECT_EQ(opened->model.node_count(), wanted["nodes"]);
    const auto sum = [&, elements = wanted["elements"]](std::initializer_list<const char*> names) {
      std::size_t total = 0;
      for (const char* name : names) total += elements.value(name, std::size_t{0});
      return total;
    };
    EXPECT_EQ(cards.quad, sum({"SHELL_QUAD"}));
    EXPECT_EQ(cards.tri, sum({"SHELL_TRI"}));
    EXPECT_EQ(cards.quad8, sum({"SHELL_QUAD_8n"}));
    EXPECT_EQ(cards.tri6, sum({"SHELL_TRI_6n"}));
    EXPECT_EQ(cards.beam, sum({"BEAM"}));
    EXPECT_EQ(cards.solid, sum({"SOLID_HEX", "SOLID_PENTA", "SOLID_TET"}));
    EXPECT_EQ(cards.tshell, sum({"TSHELL"}));
    EXPECT_EQ(cards.other, sum({"DISCRETE", "MASS", "SPH"}));
    EXPECT_EQ(cards.shells(), wanted["shells"]);
    std::size_t defined = 0;
    for (const Part& part : *opened->model.parts) defined += part.defined;
    EXPECT_EQ(defined, wanted["parts_defined"]);
    // The counter knows nothing of *INCLUDE_PATH_RELATIVE, along which this one is found.
    auto missing = wanted["missing_includes"].get<std::vector<std::string>>();
    if (id == "bolt_a_missing_include") std::erase(missing, "material_props.k");
    EXPECT_EQ(deck.missing_files, missing);
  }
}

TEST_F(RealDecks, are_saved_byte_for_byte) {
  for (const auto& [id, wanted] : decks("lsdyna")) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    const DeckFolder folder;
    const auto saved = save(*opened->deck, opened->model, opened->model, folder / "main.k");
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(saved->files_written.size(), opened->deck->files.size());
    EXPECT_EQ(content(folder / "main.k"), content(path(wanted)));
    for (std::size_t i = 1; i < opened->deck->files.size(); ++i) {
      const SourceFile& file = opened->deck->files[i];
      EXPECT_EQ(content(folder.path() / file.relative), content(file.path)) << file.path;
    }
  }
}

TEST_F(RealDecks, moving_one_node_changes_one_line) {
  std::size_t edited = 0;
  for (const auto& [id, wanted] : decks("lsdyna")) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    if (opened->model.node_count() == 0) continue;
    ++edited;
    for (const std::size_t node : {std::size_t{0}, opened->model.node_count() / 2, opened->model.node_count() - 1}) {
      Model model = opened->model;
      model.positions.set(node, model.positions[node] + Vec3(0.1, 1.0 / 3, -2));
      const DeckFolder folder;
      const auto saved = save(*opened->deck, opened->model, model, folder / "main.k");
      ASSERT_TRUE(saved) << saved.error().text();
      EXPECT_EQ(saved->lines_changed, 1u);
      std::size_t differ = lines_that_differ(content(folder / "main.k"), content(path(wanted)));
      for (std::size_t i = 1; i < opened->deck->files.size(); ++i) {
        const SourceFile& file = opened->deck->files[i];
        differ += lines_that_differ(content(folder.path() / file.relative), content(file.path));
      }
      EXPECT_EQ(differ, 1u);
      const auto again = deck::open(folder / "main.k");
      ASSERT_OPENED(again);
      ASSERT_EQ(moved_nodes(opened->model, again->model), std::vector<NodeIndex>{NodeIndex(node)});
      const double scale = model.positions[node].cwiseAbs().maxCoeff();
      EXPECT_LT((again->model.positions[node] - model.positions[node]).norm(), 1e-10 * std::max(1.0, scale));
    }
  }
  EXPECT_EQ(edited, 19u);
}

TEST_F(RealDecks, of_other_formats_are_refused_by_name) {
  for (const auto& [format, words] :
       {std::pair("nastran", "a Nastran deck"), std::pair("radioss", "a Radioss deck"), std::pair("abaqus", "an Abaqus deck")}) {
    const auto all = decks(format);
    EXPECT_GT(all.size(), 4u) << format;
    for (const auto& [id, deck] : all) {
      const auto opened = deck::open(path(deck));
      ASSERT_FALSE(opened) << id;
      EXPECT_EQ(opened.error().message, std::string("looks like ") + words + "; this version reads LS-DYNA") << id;
    }
  }
}

TEST_F(RealDecks, know_their_time_step_and_thickness) {
  const auto time_step = [&](const char* id) {
    const auto opened = deck::open(path(counts_[id]));
    EXPECT_TRUE(opened);
    return opened->deck->time_step.scale;
  };
  EXPECT_DOUBLE_EQ(time_step("birdball"), 0.6700001);
  EXPECT_DOUBLE_EQ(time_step("jp_test_k"), 0.1);
  EXPECT_DOUBLE_EQ(time_step("pillars_open_airbag_v135"), 0.9);
  const auto car = deck::open(path(counts_["gsa_car6_comma"]));
  ASSERT_OPENED(car);
  const Part& bumper = (*car->model.parts)[car->model.find_part(2).value];
  EXPECT_TRUE(bumper.thickness.has_value());
  EXPECT_EQ(bumper.density, 7.8e-8);
  EXPECT_FALSE((*car->model.parts)[car->model.find_part(8).value].limits_time_step);
}

}  // namespace
}  // namespace prismesh::mesh::deck
