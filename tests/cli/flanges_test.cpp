// flanges lists where sheets run parallel in bands.
#include "mesh/deck/sample.h"
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Two strips of twelve quads of 10 at z = 0 and z = 1, parts 1 and 2; with sections of 1 or none.
std::string strips_text(bool sections) {
  std::string text = "*KEYWORD\n*NODE\n";
  for (int sheet = 0; sheet < 2; ++sheet)
    for (int i = 0; i <= 12; ++i)
      for (int j = 0; j < 2; ++j) text += node_card(100 * sheet + 2 * i + j + 1, 10 * i, 10 * j, sheet);
  text += "*ELEMENT_SHELL\n";
  for (int sheet = 0; sheet < 2; ++sheet)
    for (int i = 0; i < 12; ++i) {
      const int corner = 100 * sheet + 2 * i + 1;
      text += shell_card(100 * sheet + i + 1, sheet + 1, corner, corner + 2, corner + 3, corner + 1);
    }
  text += "*PART\nfloor\n         1         1\n*PART\nroof\n         2         1\n";
  if (sections) text += "*SECTION_SHELL\n         1         2\n       1.0       1.0       1.0       1.0\n";
  return text + "*END\n";
}

TEST_F(Cli, flanges_lists_bands) {
  const std::string deck = write("strips.k", strips_text(true));
  const Outcome outcome = prismesh({"flanges", deck, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json said = outcome.json();
  ASSERT_EQ(said["flanges"].size(), 1u);
  EXPECT_TRUE(said["without_thickness"].empty());
  const json& flange = said["flanges"][0];
  EXPECT_EQ(flange["parts"], (json{"part:1", "part:2"}));
  EXPECT_EQ(flange["sheets"], 2);
  EXPECT_EQ(flange["shells"], 24);
  EXPECT_EQ(flange["nodes"], 52);
  EXPECT_NEAR(flange["length"].get<double>(), 120, 1e-9);
  EXPECT_NEAR(flange["width"]["mean"].get<double>(), 10, 1e-9);
  EXPECT_NEAR(flange["width"]["min"].get<double>(), 10, 1e-9);
  EXPECT_NEAR(flange["distance"].get<double>(), 1, 1e-9);
  EXPECT_NEAR(flange["at"][0].get<double>(), 60, 10);
  EXPECT_NEAR(flange["at"][1].get<double>(), 5, 1e-9);
  EXPECT_EQ(flange["shell"], "shell:1");
  EXPECT_EQ(flange["closed"], false);
  EXPECT_GT(flange["middle"].size(), 2u);
  const std::string table = prismesh({"flanges", deck}).out;
  EXPECT_THAT(table, HasSubstr("parts  sheets  length  width  min width  distance  at (mm)\n"));
  EXPECT_THAT(table, HasSubstr("1, 2        2     120     10         10         1  ("));
}

TEST_F(Cli, flanges_takes_gap_width_and_selection) {
  const std::string deck = write("strips.k", strips_text(true));
  const auto found = [&](const std::string& of, std::vector<std::string> options) {
    options.insert(options.begin(), {"flanges", of, "--json"});
    const Outcome outcome = prismesh(options);
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    return outcome.json()["flanges"].size();
  };
  EXPECT_EQ(found(deck, {"--max-width", "10.1"}), 1u);
  EXPECT_EQ(found(deck, {"--max-width", "9.9"}), 0u);
  EXPECT_EQ(found(deck, {"--select", "shell:101"}), 1u);
  EXPECT_EQ(found(deck, {"--select", "part:2"}), 1u);
  const std::string thin = write("thin.k", strips_text(false));
  EXPECT_EQ(found(thin, {}), 0u);
  EXPECT_EQ(found(thin, {"--gap", "1.1"}), 1u);
  EXPECT_EQ(prismesh({"flanges", thin, "--json"}).json()["without_thickness"], (json{1, 2}));
  EXPECT_EQ(prismesh({"flanges", thin}).out,
            "no sheets run parallel in a band\n2 parts without a thickness: their flanges need --gap, how far apart sheets may be\n");
  EXPECT_EQ(prismesh({"flanges", deck, "--select", "shell:99"}).status, kFailed);
  for (const char* wrong : {"0", "-1", "wide", "inf"})
    EXPECT_EQ(prismesh({"flanges", deck, "--max-width", wrong}).status, kWrongUsage) << wrong;
  for (const char* wrong : {"-1", "wide", "nan"}) EXPECT_EQ(prismesh({"flanges", deck, "--gap", wrong}).status, kWrongUsage) << wrong;
}

TEST_F(Cli, flanges_puts_the_longest_first_whatever_the_unit) {
  const std::string deck = write("sample.k", mesh::deck::sample_text(2000));
  const json flanges = prismesh({"flanges", deck, "--json"}).json()["flanges"];
  ASSERT_GT(flanges.size(), 5u);
  for (std::size_t f = 1; f < flanges.size(); ++f) EXPECT_LE(flanges[f]["length"], flanges[f - 1]["length"]);
  EXPECT_EQ(prismesh({"flanges", deck, "--json", "--length-unit", "m"}).json()["flanges"], flanges);
}

}  // namespace
}  // namespace prismesh::cli
