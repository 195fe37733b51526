// penetrations lists where shells pass through each other.
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using nlohmann::json;

/// A quad in the plane z = 0, and two that stand across it from z = -1 to 5; `until`: the x at which they end.
std::string crossing_text(double until) {
  std::string text = "*KEYWORD\n*NODE\n";
  text += node_card(1, 0, 0, 0) + node_card(2, 10, 0, 0) + node_card(3, 10, 10, 0) + node_card(4, 0, 10, 0);
  text += node_card(11, 2, 5, -1) + node_card(12, until, 5, -1) + node_card(13, until, 5, 3) + node_card(14, 2, 5, 3);
  text += node_card(15, 2, 5, 5) + node_card(16, until, 5, 5);
  return text + "*ELEMENT_SHELL\n" + shell_card(1, 1, 1, 2, 3, 4) + shell_card(2, 2, 11, 12, 13, 14) + shell_card(3, 2, 14, 13, 16, 15) +
         "*END\n";
}

TEST_F(Cli, penetrations_lists_what_crosses) {
  const Outcome outcome = prismesh({"penetrations", write("crossing.k", crossing_text(8)), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json said = outcome.json();
  EXPECT_EQ(said["perforations"], 1);
  EXPECT_EQ(said["penetrations"], nullptr);
  const json& region = said["regions"][0];
  EXPECT_EQ(region["kind"], "perforation");
  EXPECT_EQ(region["a"], "part:1");
  EXPECT_EQ(region["b"], "part:2");
  EXPECT_EQ(region["shells_a"], 1);
  EXPECT_EQ(region["shells_b"], 1);
  EXPECT_NEAR(region["length"].get<double>(), 6, 1e-12);
  EXPECT_EQ(region["depth"], (json{{"max", 1.0}}));
  EXPECT_EQ(region["at"][2], -1);
  EXPECT_EQ(region["worst"], (json{"shell:1", "shell:2"}));
}

TEST_F(Cli, penetrations_says_half_through) {
  const std::string deck = write("half.k", crossing_text(12));
  EXPECT_EQ(prismesh({"penetrations", deck, "--json"}).json()["regions"][0]["depth"], nullptr);
  EXPECT_THAT(prismesh({"penetrations", deck}).out, ::testing::HasSubstr("part:1 and part:2 cross along 8 mm, half through"));
}

TEST_F(Cli, penetrations_of_a_plate_are_none) {
  const std::string deck = write("plate.k", plate_text());
  EXPECT_EQ(prismesh({"penetrations", deck, "--json"}).json()["regions"], json::array());
  EXPECT_EQ(prismesh({"penetrations", deck}).out, "no shells cross\n");
}

}  // namespace
}  // namespace prismesh::cli
