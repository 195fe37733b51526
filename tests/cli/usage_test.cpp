#include <iostream>

#include <sys/resource.h>

#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

TEST_F(Cli, version_and_help) {
  EXPECT_EQ(prismesh({"--version"}).out, "prismesh " PRISMESH_VERSION "\n");
  const Outcome help = prismesh({"--help"});
  EXPECT_EQ(help.status, kDone);
  for (const char* command : {"info", "check", "edit", "replay", "diff", "distance", "penetrations", "flanges", "welds", "measure",
                              "cross-section", "sample", "bench"})
    EXPECT_THAT(help.out, HasSubstr(command));
  const Outcome edit_help = prismesh({"edit", "--help"});
  EXPECT_EQ(edit_help.status, kDone);
  EXPECT_THAT(edit_help.out, HasSubstr("--journal"));
  EXPECT_EQ(edit_help.err, "");
}

TEST_F(Cli, wrong_usage_is_status_2_and_a_sentence) {
  struct Wrong {
    std::vector<std::string> args;
    const char* says;
  };
  const Wrong all[] = {
      {{}, "subcommand"},
      {{"chekc", "a.k"}, "there is no command \"chekc\"; the nearest is \"check\""},
      {{"info"}, "prismesh info: DECK is required"},
      {{"info", "a.k", "b.k"}, "b.k"},
      {{"edit", "a.k"}, "--output is required"},
      {{"edit", "a.k", "-o", "b.k", "--frobnicate"}, "--frobnicate"},
      {{"info", "a.k", "--length-unit", "yard"}, "yard"},
      {{"info", "a.k", "--target-size", "0"}, "greater than 0"},
      {{"info", "a.k", "--target-size", "-3"}, "greater than 0"},
      {{"info", "a.k", "--target-size", "5mm"}, "greater than 0"},
      {{"info", "a.k", "--target-size", "nan"}, "greater than 0"},
      {{"sample", "--elements", "1999", "-o", "s.k"}, "2000"},
      {{"sample", "--elements", "5000001", "-o", "s.k"}, "5000000"},
      {{"sample"}, "--output is required"},
      {{"distance", "a.k", "--from", "1"}, "--to is required"},
      {{"diff", "a.k"}, "B is required"},
      {{"measure", "a.k", "1"}, "B is required"},
      {{"measure", "a.k", "1", "two"}, "two"},
      {{"cross-section", "a.k"}, "--plane is required"},
      {{"cross-section", "a.k", "--plane", "w=3"}, "must be like x=120"},
      {{"cross-section", "a.k", "--plane", "x=nan"}, "must be like x=120"},
      {{"cross-section", "a.k", "--plane", "1,2,3,4,5"}, "must be like x=120"},
      {{"cross-section", "a.k", "--plane", "1,2,3,4,5,6,7"}, "must be like x=120"},
      {{"edit", "a.k", "-o", ""}, "output: names no file"},
      {{"replay", "a.journal", "a.k", "-o", ""}, "output: names no file"},
      {{"sample", "-o", ""}, "output: names no file"},
      {{"info", ""}, "DECK: names no file"},
      {{"pair", "station"}, "prismesh pair: CODE is required"},
      {{"push", ""}, "DECK: names no file"},
      {{"pull", "model", "-o", ""}, "output: names no file"},
      {{"stations", "forget"}, "STATION is required"},
      {{"intake"}, "subcommand"},
      {{"intake", "code", "--allow", "everything"}, "everything"},
      {{"diff", "a.k", ""}, "B: names no file"},
      {{"edit", "a.k", "-o", "b.k", "--script", ""}, "--script: names no file"},
      {{"edit", "a.k", "-o", "b.k", "--journal", ""}, "--journal: names no file"},
  };
  for (const Wrong& wrong : all) {
    const Outcome outcome = prismesh(wrong.args);
    EXPECT_EQ(outcome.status, kWrongUsage) << wrong.says;
    EXPECT_THAT(outcome.err, HasSubstr(wrong.says));
    EXPECT_THAT(outcome.err, StartsWith("prismesh"));
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST_F(Cli, common_options_stand_before_or_after_the_command) {
  const std::string deck = write("plate.k", plate_text());
  for (const auto& args : {std::vector<std::string>{"--target-size", "2.5", "--length-unit", "in", "--json", "info", deck},
                           std::vector<std::string>{"info", deck, "--json", "--length-unit", "in", "--target-size", "2.5"}}) {
    const Outcome outcome = prismesh(args);
    ASSERT_EQ(outcome.status, kDone) << outcome.err;
    EXPECT_EQ(outcome.json()["target_size"], 2.5);
    EXPECT_EQ(outcome.json()["length_unit"], "in");
    EXPECT_EQ(outcome.json()["target_size_guessed"], false);
  }
}

#if !defined(PRISMESH_ADDRESS_SANITIZER) && !defined(PRISMESH_THREAD_SANITIZER)
TEST_F(Cli, too_little_memory_is_a_sentence) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto in_little_memory = [&] {
    const rlimit limit{200'000'000, 200'000'000};
    setrlimit(RLIMIT_AS, &limit);
    const std::vector<std::string> args{"sample", "--elements", "5000000", "-o", path("large.k")};
    const int status = run(args, std::cout, std::cerr);
    // This process runs the test from its beginning, with a folder of its own.
    const bool left_nothing = names().empty();
    std::filesystem::remove_all(folder);
    std::exit(left_nothing ? status : 99);
  };
  EXPECT_EXIT(in_little_memory(), ::testing::ExitedWithCode(kFailed), "prismesh sample: there isn't enough memory");
}
#endif

}  // namespace
}  // namespace prismesh::cli
