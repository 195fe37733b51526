// The real Radioss decks PRISMESH_MODELS points to: counts against an independent counter's, saving byte for byte, and an edit of one node
// that changes one line.
#include <cstdlib>
#include <iostream>

#include <nlohmann/json.hpp>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

class RealRadiossDecks : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* models = std::getenv("PRISMESH_MODELS");
    if (!models || !fs::exists(fs::path(models) / "counts.json")) {
      std::cout << "PRISMESH_MODELS doesn't point to the real decks: THE TESTS ON THEM ARE SKIPPED\n";
      GTEST_SKIP();
    }
    models_ = models;
    std::ifstream in(models_ / "counts.json");
    const nlohmann::json counts = nlohmann::json::parse(in);
    for (const auto& [id, deck] : counts.items())
      if (deck["format"] == "radioss") decks_.emplace_back(id, deck);
    ASSERT_EQ(decks_.size(), 10u);
  }
  fs::path path(const nlohmann::json& deck) const { return models_ / deck["main"].get<std::string>(); }
  Result<OpenedDeck> open(std::string_view id) const {
    for (const auto& [name, deck] : decks_)
      if (name == id) return deck::open(path(deck));
    return fail("", "no such deck");
  }

  fs::path models_;
  std::vector<std::pair<std::string, nlohmann::json>> decks_;
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

TEST_F(RealRadiossDecks, have_the_counts_of_the_independent_counter) {
  for (const auto& [id, wanted] : decks_) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    EXPECT_EQ(opened->deck->format, Format::radioss);
    EXPECT_EQ(opened->model.node_count(), wanted["nodes"]);
    std::map<std::string, std::size_t, std::less<>> kinds;
    for (const auto& [word, count] : wanted["elements"].items()) kinds[word] = count;
    EXPECT_EQ(opened->deck->element_kinds, kinds);
    EXPECT_EQ(opened->deck->element_cards.shells(), wanted["shells"]);
    EXPECT_EQ(opened->model.shell_count(), wanted["shells"]);
    std::size_t defined = 0;
    for (const Part& part : *opened->model.parts) defined += part.defined;
    EXPECT_EQ(defined, wanted["parts_defined"]);
    EXPECT_EQ(opened->model.parts->size(), wanted["parts_with_elements"]);
    EXPECT_EQ(opened->deck->missing_files, wanted["missing_includes"].get<std::vector<std::string>>());
    EXPECT_EQ(warning(*opened->deck, "missing-include").count, wanted["missing_includes"].empty() ? 0u : 1u);
    for (const Warning& warning : opened->deck->warnings)
      EXPECT_TRUE(warning.kind == "missing-include" || warning.kind.substr(0, 7) == "unused-") << warning.kind << ": " << warning.message;
  }
}

TEST_F(RealRadiossDecks, are_saved_byte_for_byte) {
  for (const auto& [id, wanted] : decks_) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    const DeckFolder folder;
    const auto saved = save(*opened->deck, opened->model, opened->model, folder / "main_0000.rad");
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(saved->files_written.size(), opened->deck->files.size());
    EXPECT_EQ(content(folder / "main_0000.rad"), content(path(wanted)));
    for (std::size_t i = 1; i < opened->deck->files.size(); ++i) {
      const SourceFile& file = opened->deck->files[i];
      EXPECT_EQ(content(folder.path() / file.relative), content(file.path)) << file.path;
    }
  }
}

TEST_F(RealRadiossDecks, moving_one_node_changes_one_line) {
  for (const auto& [id, wanted] : decks_) {
    SCOPED_TRACE(id);
    const auto opened = deck::open(path(wanted));
    ASSERT_OPENED(opened);
    for (const std::size_t node : {std::size_t{0}, opened->model.node_count() / 2, opened->model.node_count() - 1}) {
      Model model = opened->model;
      model.positions.set(node, model.positions[node] + Vec3(0.1, 1.0 / 3, -2));
      const DeckFolder folder;
      const auto saved = save(*opened->deck, opened->model, model, folder / "main_0000.rad");
      ASSERT_TRUE(saved) << saved.error().text();
      EXPECT_EQ(saved->lines_changed, 1u);
      std::size_t differ = lines_that_differ(content(folder / "main_0000.rad"), content(path(wanted)));
      for (std::size_t i = 1; i < opened->deck->files.size(); ++i) {
        const SourceFile& file = opened->deck->files[i];
        differ += lines_that_differ(content(folder.path() / file.relative), content(file.path));
      }
      EXPECT_EQ(differ, 1u);
      const auto again = deck::open(folder / "main_0000.rad");
      ASSERT_OPENED(again);
      ASSERT_EQ(moved_nodes(opened->model, again->model), std::vector<NodeIndex>{NodeIndex(node)});
      const double scale = model.positions[node].cwiseAbs().maxCoeff();
      EXPECT_LT((again->model.positions[node] - model.positions[node]).norm(), 1e-14 * std::max(1.0, scale));
    }
  }
}

TEST_F(RealRadiossDecks, have_the_positions_and_corners_that_their_cards_give) {
  const auto bumper = open("bumper_beam_rad");
  ASSERT_OPENED(bumper);
  EXPECT_EQ(position_of(bumper->model, 49), Vec3(-39.977531474559, -9.9789830563853, 75));
  EXPECT_EQ(corners_of(bumper->model, 5691), (std::array<std::int64_t, 4>{5966, 5968, 5969, 5965}));
  EXPECT_EQ(corners_of(bumper->model, 5873), (std::array<std::int64_t, 4>{6158, 6157, 6161, 6161}));
  const auto seat = open("seat_adyrel_rad");
  ASSERT_OPENED(seat);
  EXPECT_EQ(position_of(seat->model, 7), Vec3(-364.71102345537, -.02689546309995, 279.76724152829));
  // The include is a whole deck with its own /BEGIN and /END.
  const auto sled = open("hiii05_sled_rad");
  ASSERT_OPENED(sled);
  EXPECT_EQ(position_of(sled->model, 15000001), Vec3(-145.26891997002, -620.44439991733, 907.850612089373));
  EXPECT_EQ(position_of(sled->model, 4), Vec3(32.094988098671, -726.54834725132, 731.248094230065));
}

TEST_F(RealRadiossDecks, know_their_thicknesses_materials_and_unit) {
  const auto part = [](const Result<OpenedDeck>& opened, std::int64_t id) {
    return (*opened->model.parts)[opened->model.find_part(id).value];
  };
  const auto cra = open("cra2_rad");
  ASSERT_OPENED(cra);
  EXPECT_EQ(part(cra, 1).name, "PID 1");
  EXPECT_EQ(part(cra, 1).thickness, 1.5);
  const auto tube = open("box1bl_rad");
  ASSERT_OPENED(tube);
  EXPECT_EQ(part(tube, 1).density, 7.80000028E-6);
  EXPECT_EQ(part(tube, 1).youngs_modulus, 205);
  EXPECT_EQ(part(tube, 1).poissons_ratio, .300000012);
  const auto blank = open("dbend_rad");
  ASSERT_OPENED(blank);
  EXPECT_EQ(part(blank, 1).thickness, .74000001);  // TYPE9
  EXPECT_EQ(part(blank, 1).youngs_modulus, 206000);
  const auto seat = open("seat_adyrel_rad");
  ASSERT_OPENED(seat);
  EXPECT_FALSE(part(seat, 11).limits_time_step);
  EXPECT_EQ(seat->deck->length_unit, LengthUnit::mm);
  const auto test = open("luchete_test_rad");
  ASSERT_OPENED(test);
  EXPECT_EQ(part(test, 1).thickness, 7e-4);  // behind a card that is a blank line
  EXPECT_EQ(test->deck->length_unit, LengthUnit::m);
}

}  // namespace
}  // namespace prismesh::mesh::deck
