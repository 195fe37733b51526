// Each deck of PRISMESH_MODELS: its format, its counts, the same bytes back; old cards refused.
#include <cstdlib>

#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using nlohmann::json;

class RealDecks : public Cli {
 protected:
  void SetUp() override {
    const char* models = std::getenv("PRISMESH_MODELS");
    if (models == nullptr || !std::filesystem::exists(std::filesystem::path(models) / "counts.json"))
      GTEST_SKIP() << "PRISMESH_MODELS names no folder with counts.json: REAL DECKS ARE NOT TESTED";
    Cli::SetUp();
    root = models;
    counts = json::parse(read(root / "counts.json"));
  }
  void TearDown() override {
    if (!folder.empty()) Cli::TearDown();
  }

  static int sum(const json& elements, std::initializer_list<const char*> names) {
    int total = 0;
    for (const char* name : names) total += elements.value(name, 0);
    return total;
  }

  std::filesystem::path root;
  json counts;
};

TEST_F(RealDecks, info_has_the_independent_counts) {
  std::size_t read_decks = 0;
  for (const auto& [name, expected] : counts.items()) {
    if (expected["format"] != "lsdyna") continue;
    const Outcome outcome = prismesh({"info", (root / expected["main"]).string(), "--json"});
    ASSERT_EQ(outcome.status, kDone) << name << ": " << outcome.err;
    const json info = outcome.json();
    const json& cards = expected["elements"];
    const auto cards_of = [&](const char* kind) { return info["elements"][kind].get<int>() + info["elements_left_out"][kind].get<int>(); };
    EXPECT_EQ(info["nodes"], expected["nodes"]) << name;
    EXPECT_EQ(cards_of("quad"), sum(cards, {"SHELL_QUAD"})) << name;
    EXPECT_EQ(cards_of("tri"), sum(cards, {"SHELL_TRI"})) << name;
    EXPECT_EQ(cards_of("quad8"), sum(cards, {"SHELL_QUAD_8n"})) << name;
    EXPECT_EQ(cards_of("beam"), sum(cards, {"BEAM"})) << name;
    EXPECT_EQ(cards_of("solid"), sum(cards, {"SOLID_HEX", "SOLID_PENTA", "SOLID_TET"})) << name;
    ++read_decks;
  }
  EXPECT_GT(read_decks, 20u);
}

TEST_F(RealDecks, no_edits_write_the_same_bytes) {
  for (const auto& [name, expected] : counts.items()) {
    if (expected["format"] != "lsdyna") continue;
    const std::filesystem::path deck = root / expected["main"];
    const Outcome outcome = prismesh({"edit", deck.string(), "-o", path(name + "/" + deck.filename().string())});
    if (outcome.status == kFailed) {  // an include outside the main file's folder can't be put anywhere
      EXPECT_THAT(outcome.err, HasSubstr("outside")) << name;
      EXPECT_FALSE(exists(name)) << name;
      continue;
    }
    ASSERT_EQ(outcome.status, kDone) << name << ": " << outcome.err;
    const std::filesystem::path written = folder / name;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(written)) {
      if (!entry.is_regular_file()) continue;
      const auto relative = std::filesystem::relative(entry.path(), written);
      EXPECT_EQ(read(entry.path()), read(deck.parent_path() / relative)) << name << " " << relative;
    }
  }
}

TEST_F(RealDecks, of_every_format_are_told_by_name_and_old_cards_refused) {
  for (const auto& [name, expected] : counts.items()) {
    const std::string deck = (root / expected["main"]).string();
    const Outcome outcome = prismesh({"info", deck, "--json"});
    if (name == "nastran95_d08012a") {
      EXPECT_EQ(outcome.status, kFailed);
      EXPECT_THAT(outcome.err, ::testing::AllOf(StartsWith(deck + ":17: "), HasSubstr("CQUAD1")));
      continue;
    }
    ASSERT_EQ(outcome.status, kDone) << name << ": " << outcome.err;
    const std::string format = expected["format"] == "lsdyna" ? "ls-dyna" : expected["format"].get<std::string>();
    EXPECT_EQ(outcome.json()["format"], format) << name;
    EXPECT_EQ(outcome.json()["nodes"], expected["nodes"]) << name;
  }
}

}  // namespace
}  // namespace prismesh::cli
