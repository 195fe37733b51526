// measure and cross-section.
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

/// Three quads of 10 in a row along x, the third bent upwards; parts 1, 1 and 2.
std::string bent_strip() {
  std::string text = "*KEYWORD\n*NODE\n";
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j) text += node_card(10 * i + j + 1, i < 3 ? 10 * i : 20, 10 * j, i < 3 ? 0 : 10);
  text += "*ELEMENT_SHELL\n";
  for (int i = 0; i < 3; ++i) text += shell_card(i + 1, i < 2 ? 1 : 2, 10 * i + 1, 10 * i + 11, 10 * i + 12, 10 * i + 2);
  return text + "*PART\nfloor\n         1         1\n*PART\nwall\n         2         1\n*END\n";
}

TEST_F(Cli, measure_says_distance_angle_and_radius) {
  const std::string deck = write("strip.k", bent_strip());
  const Outcome two = prismesh({"measure", deck, "1", "31"});
  EXPECT_EQ(two.status, kDone) << two.err;
  EXPECT_EQ(two.out, "node:1 to node:31: 22.3607 mm, as x y z (20, 0, 10)\nalong the surface 30 mm\n");
  const nlohmann::json three = prismesh({"measure", deck, "1", "21", "31", "--json"}).json();
  EXPECT_EQ(three["nodes"], (nlohmann::json{1, 21, 31}));
  EXPECT_NEAR(three["angle"].get<double>(), 90, 1e-9);
  EXPECT_NEAR(three["distance"].get<double>(), 22.3606797749979, 1e-9);
  EXPECT_NEAR(three["along_surface"].get<double>(), 30, 1e-9);
  EXPECT_NEAR(three["circle"]["radius"].get<double>(), 22.3606797749979 / 2, 1e-9);
  EXPECT_NEAR(three["circle"]["centre"][0].get<double>(), 10, 1e-9);
  const Outcome line = prismesh({"measure", deck, "1", "11", "21"});
  EXPECT_EQ(line.status, kDone);
  EXPECT_THAT(line.out, HasSubstr("angle at node:11 180 degrees\nno radius: the nodes lie on a line\n"));
  EXPECT_TRUE(prismesh({"measure", deck, "1", "11", "21", "--json"}).json()["circle"].is_null());
}

TEST_F(Cli, measure_and_cross_section_say_that_the_unit_is_guessed) {
  const std::string deck = write("strip.k", bent_strip());
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"measure", deck, "1", "31"}, {"cross-section", deck, "--plane", "5,0,0,1,0,0"}}) {
    const Outcome guessed = prismesh(command);
    EXPECT_EQ(guessed.status, kDone) << guessed.err;
    EXPECT_THAT(guessed.err, HasSubstr("strip.k: note: guessed length unit mm; set with --length-unit")) << command[0];
    std::vector<std::string> given = command;
    given.insert(given.end(), {"--length-unit", "m"});
    const Outcome said = prismesh(given);
    EXPECT_EQ(said.status, kDone) << said.err;
    EXPECT_THAT(said.err, Not(HasSubstr("guessed")));
  }
}

TEST_F(Cli, measure_refuses_a_node_that_isnt_there) {
  const std::string deck = write("strip.k", bent_strip());
  const Outcome outcome = prismesh({"measure", deck, "1", "33"});
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_THAT(outcome.err, HasSubstr("node 33"));
  EXPECT_THAT(outcome.err, HasSubstr("32")) << "the nearest id";
  EXPECT_EQ(outcome.out, "");
}

TEST_F(Cli, cross_section_prints_and_writes_curves) {
  const std::string deck = write("strip.k", bent_strip());
  const Outcome outcome = prismesh({"cross-section", deck, "--plane", "y=4", "-o", path("cut.csv")});
  EXPECT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(outcome.out, "3 shells, 2 curves, 30 mm\npart:1  1 curve, 20 mm\npart:2  1 curve, 10 mm\n");
  const std::string csv = read(path("cut.csv"));
  EXPECT_THAT(csv, StartsWith("curve,part,closed,x,y,z\n1,1,0,"));
  EXPECT_THAT(csv, HasSubstr("\n2,2,0,20,4,"));
  const nlohmann::json tilted = prismesh({"cross-section", deck, "--plane", "5,0,0,1,1,0", "--parts", "1", "--json"}).json();
  EXPECT_EQ(tilted["curves"].size(), 1u);
  EXPECT_EQ(tilted["curves"][0]["part"], 1);
  EXPECT_NEAR(tilted["length"].get<double>(), std::sqrt(50.0), 1e-9) << "from (5, 0) to (0, 5), where it leaves the strip";
}

TEST_F(Cli, welds_are_checked) {
  std::string text = bent_strip();
  text.insert(text.find("*ELEMENT_SHELL"), node_card(901, 5, 5, 0) + node_card(902, 5, 5, 7));
  text.insert(text.find("*END"), "*ELEMENT_BEAM\n       9       3     901     902       0\n");
  const std::string deck = write("weld.k", text);
  const Outcome outcome = prismesh({"welds", deck});
  EXPECT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(outcome.out, "1 weld, 1 finding\nloose-end 1\nbeam:9: node:902 lies 7 from the nearest sheet  at (5, 5, 3.5)\n");
  const nlohmann::json said = prismesh({"welds", deck, "--json"}).json();
  EXPECT_EQ(said["welds"], 1);
  EXPECT_EQ(said["findings"][0]["kind"], "loose-end");
  EXPECT_EQ(prismesh({"welds", write("none.k", bent_strip())}).out, "0 welds, 0 findings\n");
  EXPECT_EQ(prismesh({"welds", deck, "--pitch", "-1"}).status, kWrongUsage);
}

TEST_F(Cli, cross_section_never_overwrites_the_deck) {
  const std::string deck = write("strip.k", bent_strip());
  const Outcome outcome = prismesh({"cross-section", deck, "--plane", "y=4", "-o", path("./strip.k")});
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_THAT(outcome.err, HasSubstr("strip.k: is a file of the deck; the curves need another one"));
  EXPECT_EQ(read(deck), bent_strip());
}

TEST_F(Cli, cross_section_through_nothing_says_so) {
  const std::string deck = write("strip.k", bent_strip());
  EXPECT_EQ(prismesh({"cross-section", deck, "--plane", "x=1e300"}).out, "the plane cuts no shell\n");
  const Outcome no_normal = prismesh({"cross-section", deck, "--plane", "1,2,3,0,0,0"});
  EXPECT_EQ(no_normal.status, kFailed);
  EXPECT_EQ(no_normal.err.substr(no_normal.err.find("--plane")), "--plane: the plane's normal has no length\n");
  const Outcome no_part = prismesh({"cross-section", deck, "--plane", "x=1", "--parts", "9"});
  EXPECT_EQ(no_part.status, kFailed);
  EXPECT_THAT(no_part.err, HasSubstr("9"));
}

}  // namespace
}  // namespace prismesh::cli
