// Target sizes and criteria by part on the command line, and the settings file beside a deck.
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::Not;

/// The plate of 5 mm, part 7, and one of 4 x 4 quads of 100 mm, part 8.
class CliSizes : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    std::string text = plate_text();
    std::string cards = "*NODE\n";
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 4; ++i) cards += node_card(501 + j * 5 + i, 100 * i, 100 * j, 50);
    cards += "*ELEMENT_SHELL\n";
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const int a = 501 + j * 5 + i;
        cards += shell_card(2001 + j * 4 + i, 8, a, a + 1, a + 6, a + 5);
      }
    cards += "*PART\nroof\n         8         3         2\n";
    deck = write("two.k", text.replace(text.find("*END"), 0, cards));
  }
  /// Part's id, size, where it comes from, criteria; in the order of the deck.
  static std::vector<std::string> judged(const nlohmann::json& parts) {
    std::vector<std::string> all;
    for (const auto& part : parts)
      all.push_back(part["id"].dump() + " " + part["target_size"].dump() + " " + part["target_size_from"].get<std::string>() + " " +
                    part["criteria"].get<std::string>());
    return all;
  }

  std::string deck;
};

TEST_F(CliSizes, each_part_is_judged_by_its_own_edges) {
  const Outcome check = prismesh({"check", deck, "--json"});
  ASSERT_EQ(check.status, kDone) << check.err;
  EXPECT_EQ(check.json()["fail"], 0);
  EXPECT_EQ(check.json()["warn"], 0);
  EXPECT_THAT(judged(check.json()["parts"]), ElementsAre("7 5.0 part default", "8 100.0 part default"));
  EXPECT_EQ(check.json()["target_size"], 5.0);
  EXPECT_EQ(check.json()["target_size_guessed"], true);
  EXPECT_THAT(judged(prismesh({"info", deck, "--json"}).json()["parts"]), ElementsAre("7 5.0 part default", "8 100.0 part default"));
  EXPECT_THAT(prismesh({"info", deck}).out, HasSubstr("target size  5 to 100 mm (guessed)\n"));
  EXPECT_THAT(prismesh({"info", deck}).out, HasSubstr("roof  16 quads, 0 triangles, 1.2 mm thick, target size 100 mm (guessed)\n"));
  EXPECT_THAT(prismesh({"check", deck}).out, HasSubstr("target size 5 to 100 mm (guessed), criteria default\n"));
}

TEST_F(CliSizes, one_size_for_all_and_sizes_of_some) {
  for (const char* one : {"5", "deck"}) {
    const Outcome check = prismesh({"check", deck, "--json", "--target-size", one});
    EXPECT_EQ(check.json()["fail"], 16) << one;
    EXPECT_EQ(check.json()["target_size_guessed"], one == std::string("deck"));
  }
  const Outcome some = prismesh({"check", deck, "--json", "--target-size", "deck", "--target-size", "90@part:8", "--criteria", "strict@7"});
  ASSERT_EQ(some.status, kDone) << some.err;
  EXPECT_THAT(judged(some.json()["parts"]), ElementsAre("7 5.0 deck strict", "8 90.0 given default"));
  EXPECT_THAT(prismesh({"check", deck, "--criteria", "strict@7"}).out, HasSubstr("criteria default, strict by part\n"));
  EXPECT_THAT(prismesh({"info", deck, "--criteria", "strict@7"}).out, HasSubstr("target size 5 mm (guessed), criteria strict\n"));
}

TEST_F(CliSizes, mistakes_are_told) {
  EXPECT_EQ(prismesh({"check", deck, "--target-size", "5mm@7"}).status, kWrongUsage);
  const Outcome unknown = prismesh({"check", deck, "--target-size", "5@99"});
  EXPECT_EQ(unknown.status, kFailed);
  EXPECT_THAT(unknown.err, StartsWith("expression:1: "));
  EXPECT_EQ(prismesh({"check", deck, "--criteria", "gone.toml@7"}).status, kFailed);
}

TEST_F(CliSizes, a_criteria_file_may_have_an_at_in_its_name) {
  const std::string file = write("ours@home.toml", "name = \"ours\"\n[metrics.aspect]\nfail_above = 3\n");
  EXPECT_THAT(judged(prismesh({"check", deck, "--json", "--criteria", file}).json()["parts"]),
              ElementsAre("7 5.0 part ours", "8 100.0 part ours"));
  EXPECT_THAT(judged(prismesh({"check", deck, "--json", "--criteria", file + "@8"}).json()["parts"]),
              ElementsAre("7 5.0 part default", "8 100.0 part ours"));
}

TEST_F(CliSizes, settings_are_kept_beside_the_deck_when_asked_for) {
  ASSERT_EQ(prismesh({"check", deck, "--target-size", "50@8"}).status, kDone);
  EXPECT_FALSE(exists("two.k.prismesh.toml")) << "nobody asked to keep it";
  const Outcome kept = prismesh({"check", deck, "--target-size", "50@8", "--criteria", "strict", "--save-settings"});
  ASSERT_EQ(kept.status, kDone);
  EXPECT_THAT(kept.err, HasSubstr("two.k.prismesh.toml: note: "));
  EXPECT_THAT(judged(prismesh({"info", deck, "--json"}).json()["parts"]), ElementsAre("7 5.0 part strict", "8 50.0 given strict"));
  EXPECT_THAT(judged(prismesh({"info", deck, "--json", "--target-size", "5"}).json()["parts"]),
              ElementsAre("7 5.0 given strict", "8 5.0 given strict"));
  write("two.k.prismesh.toml", "\ntarget_sise = 5\n");
  const Outcome refused = prismesh({"info", deck});
  EXPECT_EQ(refused.status, kFailed);
  EXPECT_EQ(refused.err,
            path("two.k.prismesh.toml") + ":2: a deck's settings file has no \"target_sise\"; the nearest known is \"target_size\"\n");
  write("two.k.prismesh.toml", "[[parts]]\non = \"99\"\ntarget_size = 5\n");
  EXPECT_THAT(prismesh({"info", deck}).err, StartsWith(path("two.k.prismesh.toml") + ":2: \"99\", column 1: "));
}

TEST_F(CliSizes, an_edit_that_sets_a_size_keeps_it_beside_what_is_written) {
  const Outcome moved = prismesh({"edit", deck, "--edit", R"({"edit": "translate", "by": [0, 0, 1], "on": "117"})", "-o", path("moved.k")});
  ASSERT_EQ(moved.status, kDone);
  EXPECT_FALSE(exists("moved.k.prismesh.toml"));
  const Outcome set =
      prismesh({"edit", deck, "--edit", R"({"edit": "set_target_size", "size": 5, "on": "8"})", "-o", path("out.k"), "--json"});
  ASSERT_EQ(set.status, kDone) << set.err;
  EXPECT_EQ(set.json()["before"]["fail"], 0);
  EXPECT_EQ(set.json()["after"]["fail"], 16);
  EXPECT_EQ(read(path("out.k")), read(deck)) << "a target size isn't part of the deck";
  EXPECT_EQ(prismesh({"check", path("out.k"), "--json"}).json()["fail"], 16);
  ASSERT_EQ(prismesh({"edit", path("out.k"), "-o", path("copy.k")}).status, kDone);
  EXPECT_EQ(prismesh({"check", path("copy.k"), "--json"}).json()["fail"], 16) << "a copy keeps the settings";
}

TEST_F(CliSizes, an_edit_that_sets_criteria_keeps_them_beside_what_is_written) {
  write("short.toml", "name = \"short\"\n[metrics.max_length]\nfail_above = 0.5\n");
  const std::string script = write("edits.jsonl",
                                   "{\"edit\": \"set_criteria\", \"criteria\": \"strict\", \"on\": \"all\"}\n"
                                   "{\"edit\": \"set_criteria\", \"criteria\": \"short.toml\", \"on\": \"part:8\"}\n");
  const Outcome set = prismesh({"edit", deck, "--script", script, "-o", path("out.k")});
  ASSERT_EQ(set.status, kDone) << set.err;
  EXPECT_THAT(set.out, HasSubstr("set_criteria: 0 nodes moved; warn 0 -> 0, fail 0 -> 16\n  part 8: criteria short, before strict\n"));
  EXPECT_EQ(read(path("out.k")), read(deck)) << "criteria aren't part of the deck";
  const Outcome check = prismesh({"check", path("out.k"), "--json"});
  EXPECT_EQ(check.json()["fail"], 16);
  EXPECT_EQ(check.json()["criteria"], "strict");
  EXPECT_THAT(judged(check.json()["parts"]), ElementsAre("7 5.0 part strict", "8 100.0 part short"));
  const std::string text = prismesh({"check", path("out.k")}).out;
  EXPECT_THAT(text, HasSubstr("criteria strict, short by part\n"));
  EXPECT_THAT(text, HasSubstr("    size  criteria  name\n"));
  EXPECT_THAT(text, HasSubstr("     100  short     roof\n"));
  EXPECT_THAT(prismesh({"check", deck}).out, HasSubstr("    size  name\n")) << "one for all needs no column";
  const std::string info = prismesh({"info", path("out.k")}).out;
  EXPECT_THAT(info, HasSubstr("criteria     strict, short by part\n"));
  EXPECT_THAT(info, HasSubstr("target size 100 mm (guessed), criteria short\n"));
  EXPECT_EQ(prismesh({"info", path("out.k"), "--json"}).json()["criteria"], "strict");
  const Outcome unknown = prismesh({"edit", deck, "--edit", R"({"edit": "set_criteria", "criteria": "gone.toml"})", "-o", path("no.k")});
  EXPECT_EQ(unknown.status, kFailed);
  EXPECT_THAT(unknown.err, HasSubstr("gone.toml: there is no such file, and no built-in criteria of this name"));
  EXPECT_FALSE(exists("no.k"));
}

}  // namespace
}  // namespace prismesh::cli
