// The real decks PRISMESH_MODELS points to: counts against an independent counter's, saving byte for byte, and an edit of one
// node that changes one line.
#include <cstdlib>
#include <iostream>
#include <map>

#include <nlohmann/json.hpp>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
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

  /// Name and counts of every deck; of one format if it is named. Those that are refused are left out.
  std::vector<std::pair<std::string, nlohmann::json>> decks(const std::string& format = "") const {
    std::vector<std::pair<std::string, nlohmann::json>> out;
    for (const auto& [id, deck] : counts_.items())
      if (id != "nastran95_d08012a" && (format.empty() || deck["format"] == format)) out.emplace_back(id, deck);
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

/// How counts.json calls the kinds of elements of each class. tests/checker looks at the words themselves.
const std::map<std::string, std::vector<const char*>> kClasses = {
    {"quad", {"SHELL_QUAD", "CQUAD4", "CQUADR", "SHELL", "S4"}},
    {"tri", {"SHELL_TRI", "CTRIA3", "CTRIAR", "SH3N"}},
    {"quad8", {"SHELL_QUAD_8n", "CQUAD8", "CQUAD", "S8", "S8R"}},
    {"tri6", {"SHELL_TRI_6n", "CTRIA6", "S6"}},
    {"beam", {"BEAM", "CBAR", "CBEAM", "CROD", "CONROD", "CTUBE", "CBEND", "TRUSS", "B32"}},
    {"solid", {"SOLID_HEX", "SOLID_PENTA", "SOLID_TET", "CHEXA", "CPENTA", "CTETRA", "BRICK", "C3D8"}},
    {"tshell", {"TSHELL"}},
};

TEST_F(RealDecks, have_the_counts_of_the_independent_counter) {
  EXPECT_EQ(decks().size(), 54u);
  for (const auto& [id, wanted] : decks()) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    const Deck& deck = *opened->deck;
    const ElementCounts& cards = deck.element_cards;
    EXPECT_EQ(opened->model.node_index->size(), wanted["nodes"]);
    const auto sum = [&, elements = wanted["elements"]](const char* kind) {
      std::size_t total = 0;
      for (const char* name : kClasses.at(kind)) total += elements.value(name, std::size_t{0});
      return total;
    };
    EXPECT_EQ(cards.quad, sum("quad"));
    EXPECT_EQ(cards.tri, sum("tri"));
    EXPECT_EQ(cards.quad8, sum("quad8"));
    EXPECT_EQ(cards.tri6, sum("tri6"));
    EXPECT_EQ(cards.beam, sum("beam"));
    EXPECT_EQ(cards.solid, sum("solid"));
    EXPECT_EQ(cards.tshell, sum("tshell"));
    EXPECT_EQ(cards.shells() - cards.quad8 - cards.tri6, wanted["shells"].get<std::size_t>() - sum("quad8") - sum("tri6"));
    // The counter knows nothing of *INCLUDE_PATH_RELATIVE, along which this one is found.
    auto missing = wanted["missing_includes"].get<std::vector<std::string>>();
    if (id == "bolt_a_missing_include") std::erase(missing, "material_props.k");
    EXPECT_EQ(deck.missing_files, missing);
  }
}

TEST_F(RealDecks, have_the_parts_of_the_independent_counter) {
  // The counter takes only some of a Nastran deck's properties and only an Abaqus deck's shell sections for parts: tests/checker.
  for (const char* format : {"lsdyna", "radioss"})
    for (const auto& [id, wanted] : decks(format)) {
      const auto opened = deck::open(path(wanted));
      ASSERT_OPENED(opened);
      std::size_t defined = 0;
      for (const Part& part : *opened->model.parts) defined += part.defined;
      EXPECT_EQ(defined, wanted["parts_defined"]) << id;
    }
}

TEST_F(RealDecks, of_the_nineteen_seventies_are_refused_by_the_card) {
  const auto opened = deck::open(path(counts_["nastran95_d08012a"]));
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("CQUAD1"), std::string::npos) << opened.error().text();
  EXPECT_GT(opened.error().line, 0);
}

TEST_F(RealDecks, are_saved_byte_for_byte) {
  for (const auto& [id, wanted] : decks()) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    const DeckFolder folder;
    const auto saved = save(*opened->deck, opened->model, opened->model, folder / path(wanted).filename().string());
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(saved->files_written.size(), opened->deck->files.size());
    EXPECT_EQ(content(folder / path(wanted).filename().string()), content(path(wanted)));
    for (std::size_t i = 1; i < opened->deck->files.size(); ++i) {
      const SourceFile& file = opened->deck->files[i];
      EXPECT_EQ(content(folder.path() / file.relative), content(file.path)) << file.path;
    }
  }
}

/// What is left of a coordinate in the field that each format has: Nastran's small field holds eight characters.
double accuracy(Format format) { return format == Format::nastran ? 1e-3 : 1e-10; }

TEST_F(RealDecks, moving_one_node_changes_one_card) {
  std::size_t edited = 0;
  for (const auto& [id, wanted] : decks()) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    const std::size_t count = opened->model.node_count();
    if (count == 0) continue;
    ++edited;
    for (const std::size_t node : {std::size_t{0}, count / 2}) {
      if (opened->model.node_holds[node]) continue;
      Model model = opened->model;
      model.positions.set(node, model.positions[node] + Vec3(0.1, 1.0 / 3, -2));
      const DeckFolder folder;
      const auto saved = save(*opened->deck, opened->model, model, folder / path(wanted).filename().string());
      ASSERT_TRUE(saved) << saved.error().text();
      EXPECT_GE(saved->lines_changed, 1u);
      EXPECT_LE(saved->lines_changed, wanted["format"] == "nastran" ? 2u : 1u);
      std::size_t differ = lines_that_differ(content(folder / path(wanted).filename().string()), content(path(wanted)));
      for (std::size_t i = 1; i < opened->deck->files.size(); ++i) {
        const SourceFile& file = opened->deck->files[i];
        differ += lines_that_differ(content(folder.path() / file.relative), content(file.path));
      }
      EXPECT_EQ(differ, saved->lines_changed);
      const auto again = deck::open(folder / path(wanted).filename().string());
      ASSERT_OPENED(again);
      ASSERT_EQ(moved_nodes(opened->model, again->model), std::vector<NodeIndex>{NodeIndex(node)});
      const double scale = model.positions[node].cwiseAbs().maxCoeff();
      EXPECT_LT((again->model.positions[node] - model.positions[node]).norm(), accuracy(opened->deck->format) * std::max(1.0, scale));
    }
  }
  EXPECT_EQ(edited, 52u);
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
