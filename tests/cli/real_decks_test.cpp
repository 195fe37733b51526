// Every public deck there is: its counts, the same bytes back, and a refusal that names the format that isn't read yet.
#include <algorithm>
#include <cctype>
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
    EXPECT_EQ(info["nodes"], expected["nodes"]) << name;
    EXPECT_EQ(info["elements"]["quad"], sum(cards, {"SHELL_QUAD"})) << name;
    EXPECT_EQ(info["elements"]["tri"], sum(cards, {"SHELL_TRI"})) << name;
    EXPECT_EQ(info["elements"]["quad8"], sum(cards, {"SHELL_QUAD_8n"})) << name;
    EXPECT_EQ(info["elements"]["beam"], sum(cards, {"BEAM"})) << name;
    EXPECT_EQ(info["elements"]["solid"], sum(cards, {"SOLID_HEX", "SOLID_PENTA", "SOLID_TET"})) << name;
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

TEST_F(RealDecks, other_formats_are_refused_by_name) {
  for (const auto& [name, expected] : counts.items()) {
    if (expected["format"] == "lsdyna") continue;
    const std::string deck = (root / expected["main"]).string();
    const Outcome outcome = prismesh({"info", deck});
    EXPECT_EQ(outcome.status, kFailed) << name;
    EXPECT_THAT(outcome.err, StartsWith(deck)) << name;
    std::string err = outcome.err;
    std::transform(err.begin(), err.end(), err.begin(), [](unsigned char c) { return std::tolower(c); });
    EXPECT_THAT(err, HasSubstr(expected["format"].get<std::string>())) << name;
  }
}

}  // namespace
}  // namespace prismesh::cli
