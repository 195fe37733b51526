// penetrations lists where shells cross or are too close.
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

/// A quad of 10 x 10 in the plane z = 0, two more beside each other at `height`, and one far away; part 1 is 1 thick, part 2 is 2 thick,
/// part 3 has no section.
std::string plates_text(double height) {
  std::string text = "*KEYWORD\n*NODE\n";
  text += node_card(1, 0, 0, 0) + node_card(2, 10, 0, 0) + node_card(3, 10, 10, 0) + node_card(4, 0, 10, 0);
  text += node_card(11, 2, 2, height) + node_card(12, 5, 2, height) + node_card(13, 5, 8, height) + node_card(14, 2, 8, height);
  text += node_card(15, 8, 2, height) + node_card(16, 8, 8, height);
  text += node_card(21, 0, 0, 50) + node_card(22, 10, 0, 50) + node_card(23, 10, 10, 50) + node_card(24, 0, 10, 50);
  text += "*ELEMENT_SHELL\n" + shell_card(1, 1, 1, 2, 3, 4) + shell_card(2, 2, 11, 12, 13, 14) + shell_card(3, 2, 12, 15, 16, 13) +
          shell_card(4, 3, 21, 22, 23, 24);
  text += "*PART\nfloor\n         1         1\n*PART\nroof\n         2         2\n";
  text += "*SECTION_SHELL\n         1         2\n       1.0       1.0       1.0       1.0\n";
  text += "*SECTION_SHELL\n         2         2\n       2.0       2.0       2.0       2.0\n";
  return text + "*END\n";
}

TEST_F(Cli, penetrations_lists_what_is_too_close) {
  const std::string deck = write("plates.k", plates_text(1.25));
  const Outcome outcome = prismesh({"penetrations", deck, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json said = outcome.json();
  EXPECT_EQ(said["perforations"], 0);
  EXPECT_EQ(said["penetrations"], 1);
  EXPECT_EQ(said["without_thickness"], (json{3}));
  const json& region = said["regions"][0];
  EXPECT_EQ(region["kind"], "penetration");
  EXPECT_EQ(region["a"], "part:1");
  EXPECT_EQ(region["b"], "part:2");
  EXPECT_EQ(region["shells_a"], 1);
  EXPECT_EQ(region["shells_b"], 2);
  EXPECT_NEAR(region["depth"]["max"].get<double>(), 0.25, 1e-12);
  EXPECT_NEAR(region["depth"]["mean"].get<double>(), 0.25, 1e-12);
  EXPECT_NEAR(region["area"].get<double>(), 36, 1e-12);
  EXPECT_NEAR(region["at"][2].get<double>(), 0.625, 1e-12);
  EXPECT_EQ(region["worst"][0], "shell:1");
  EXPECT_EQ(region["joined"], false);
  EXPECT_EQ(region["contact"], nullptr);
  EXPECT_EQ(region["clear"], true);
  EXPECT_EQ(region["why"], "");
  EXPECT_EQ(region["thickness_from"], "section");
  EXPECT_FALSE(region.contains("length"));
  EXPECT_THAT(prismesh({"penetrations", deck}).out, ::testing::HasSubstr("part:1 floor and part:2 roof are too close, 0.25 mm deep"));
}

TEST_F(Cli, penetrations_takes_thicknesses_and_names_from_the_decks_contacts) {
  // The two plates are 1 and 2 thick, 1.25 apart: 0.25 too close by their sections.
  const auto regions = [&](const std::string& contact, std::vector<std::string> options = {}) {
    std::string text = plates_text(1.25);
    text.insert(text.size() - 5, contact);
    options.insert(options.begin(), {"penetrations", write("plates.k", text), "--json"});
    const Outcome outcome = prismesh(options);
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    return outcome.json()["regions"];
  };
  const std::string sides =
      "*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_ID\n        32Floor and roof\n         1         2         3         3\n\n";
  const json thicker = regions(sides + "       0.0       0.0       1.5       2.0\n");
  ASSERT_EQ(thicker.size(), 1u);
  EXPECT_NEAR(thicker[0]["depth"]["max"].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(thicker[0]["contact"], "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE 32 Floor and roof");
  EXPECT_EQ(thicker[0]["thickness_from"], "contact");
  EXPECT_EQ(regions(sides + "       0.0       0.0       0.0       0.0       0.5       0.5\n").size(), 0u)
      << "half as thick: they are clear";
  const json by_section = regions(sides + "       0.0       0.0       1.5       2.0\n", {"--thickness", "section"});
  ASSERT_EQ(by_section.size(), 1u);
  EXPECT_NEAR(by_section[0]["depth"]["max"].get<double>(), 0.25, 1e-12);
  EXPECT_EQ(by_section[0]["thickness_from"], "section");
  // Another pair's contact: the plates have the thickness of their sections, and nothing keeps them apart.
  const json unseen = regions("*CONTACT_AUTOMATIC_SINGLE_SURFACE\n         3         0         3\n\n\n");
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_EQ(unseen[0]["contact"], nullptr);
}

TEST_F(Cli, penetrations_takes_thickness_gap_and_selection) {
  const std::string deck = write("plates.k", plates_text(1.75));
  const auto regions = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"penetrations", deck, "--json"});
    const Outcome outcome = prismesh(options);
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    return outcome.json()["regions"];
  };
  EXPECT_TRUE(regions({}).empty());
  EXPECT_TRUE(regions({"--thickness", "section"}).empty());
  const json given = regions({"--thickness", "2"});
  ASSERT_EQ(given.size(), 1u);
  EXPECT_EQ(given[0]["thickness_from"], "given");
  EXPECT_NEAR(given[0]["depth"]["max"].get<double>(), 0.25, 1e-12);
  const json apart = regions({"--gap", "0.5"});
  ASSERT_EQ(apart.size(), 1u);
  EXPECT_EQ(apart[0]["kind"], "clearance");
  EXPECT_THAT(prismesh({"penetrations", deck, "--gap", "0.5"}).out, ::testing::HasSubstr("are apart by less than the gap, 0.25 mm deep"));
  EXPECT_EQ(prismesh({"penetrations", deck, "--gap", "0.5", "--json"}).json()["penetrations"], 0);
  EXPECT_EQ(regions({"--thickness", "2", "--select", "shell:3"})[0]["shells_b"], 1);
  EXPECT_TRUE(regions({"--thickness", "2", "--select", "part:3"}).empty());
  EXPECT_EQ(prismesh({"penetrations", deck, "--select", "shell:99"}).status, kFailed);
  for (const char* wrong : {"0", "-1", "thick", "nan", "1mm"})
    EXPECT_EQ(prismesh({"penetrations", deck, "--thickness", wrong}).status, kWrongUsage) << wrong;
  for (const char* wrong : {"-1", "wide", "inf"}) EXPECT_EQ(prismesh({"penetrations", deck, "--gap", wrong}).status, kWrongUsage) << wrong;
}

TEST_F(Cli, penetrations_says_where_a_weld_joins) {
  std::string text = plates_text(1.25);
  text.insert(text.find("*PART"), "*CONSTRAINED_SPOTWELD\n         3        16\n");
  EXPECT_EQ(prismesh({"penetrations", write("welded.k", text), "--json"}).json()["regions"][0]["joined"], true);
  EXPECT_THAT(prismesh({"penetrations", write("welded.k", text)}).out, ::testing::HasSubstr("; joined there"));
}

TEST_F(Cli, penetrations_of_selected_shells_that_cross) {
  const std::string deck = write("crossing.k", crossing_text(8));
  EXPECT_EQ(prismesh({"penetrations", deck, "--select", "shell:2", "--json"}).json()["perforations"], 1);
  EXPECT_EQ(prismesh({"penetrations", deck, "--select", "shell:3", "--json"}).json()["perforations"], 0);
}

TEST_F(Cli, penetrations_lists_what_crosses) {
  const Outcome outcome = prismesh({"penetrations", write("crossing.k", crossing_text(8)), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json said = outcome.json();
  EXPECT_EQ(said["perforations"], 1);
  EXPECT_EQ(said["penetrations"], 0);
  EXPECT_EQ(said["without_thickness"], (json{1, 2}));
  const json& region = said["regions"][0];
  EXPECT_EQ(region["kind"], "perforation");
  EXPECT_EQ(region["a"], "part:1");
  EXPECT_EQ(region["b"], "part:2");
  EXPECT_EQ(region["shells_a"], 1);
  EXPECT_EQ(region["shells_b"], 1);
  EXPECT_NEAR(region["length"].get<double>(), 6, 1e-12);
  EXPECT_EQ(region["depth"], (json{{"max", 1.0}, {"mean", 1.0}}));
  EXPECT_NEAR(region["area"].get<double>(), 24, 1e-12);
  EXPECT_EQ(region["joined"], false);
  EXPECT_EQ(region["contact"], nullptr);
  EXPECT_EQ(region["clear"], false);
  EXPECT_EQ(region["why"], "part 1 and part 2 have no thickness: say which gap is to be left");
  EXPECT_EQ(region["thickness_from"], "none");
  EXPECT_EQ(region["at"][2], -1);
  EXPECT_EQ(region["worst"], (json{"shell:1", "shell:2"}));
}

TEST_F(Cli, penetrations_tries_what_is_clear_in_a_large_deck_only_when_asked) {
  const std::string deck = path("large.k"), moved = path("moved.k");
  ASSERT_EQ(prismesh({"sample", "--elements", "110000", "-o", deck}).status, kDone);
  const Outcome edited = prismesh({"edit", deck, "--edit", R"({"edit":"select","expr":"part:5","kind":"part"})", "--edit",
                                   R"({"edit":"translate","by":[0,30,0]})", "-o", moved});
  ASSERT_EQ(edited.status, kDone) << edited.err;
  const json untried = prismesh({"penetrations", moved, "--json"}).json()["regions"];
  const json tried = prismesh({"penetrations", moved, "--json", "--clear"}).json()["regions"];
  ASSERT_EQ(untried.size(), 2U) << "the reinforcement's two ends pass through the pillar";
  ASSERT_EQ(tried.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(untried[i]["clear"], false);
    EXPECT_THAT(untried[i]["why"].get<std::string>(), ::testing::HasSubstr("--clear"));
    EXPECT_EQ(tried[i]["clear"], true) << tried[i]["why"];
  }
}

TEST_F(Cli, penetrations_says_half_through) {
  const std::string deck = write("half.k", crossing_text(12));
  EXPECT_EQ(prismesh({"penetrations", deck, "--json"}).json()["regions"][0]["depth"], nullptr);
  EXPECT_THAT(prismesh({"penetrations", deck}).out, ::testing::HasSubstr("part:1 and part:2 cross along 8 mm, half through"));
}

TEST_F(Cli, penetrations_of_a_plate_are_none) {
  const std::string deck = write("plate.k", plate_text());
  EXPECT_EQ(prismesh({"penetrations", deck, "--json"}).json()["regions"], json::array());
  EXPECT_EQ(prismesh({"penetrations", deck}).out, "no shells cross or are too close\n");
}

}  // namespace
}  // namespace prismesh::cli
