// bench: what it measures, its table and its JSON; the times themselves aren't tested here.
#include <cstdlib>
#include <functional>

#include "base/clock.h"
#include "cli/bench_work.h"
#include "cli/measure.h"
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using nlohmann::json;

const std::vector<std::string> kAllFigures{"open",        "quality", "select_region", "drag_begin", "drag_step", "slide_step", "lift",
                                           "lift_beside", "undo",    "relax",         "relax_all",  "repair",    "save",       "copy"};

/// Works for as many milliseconds as the list says, run by run; the processor for a quarter of it.
struct ManualWork {
  ManualClock wall, cpu;
  std::vector<int> ms;
  std::size_t runs = 0;

  Result<Timing> measure(const RepetitionLimits& limits = {}) {
    TimedWork work;
    work.prepare = [&] { wall.advance_ns(7'000'000'000); };  // isn't measured
    work.run = [&]() -> Result<void> {
      const std::int64_t ns = ms[runs++ % ms.size()] * std::int64_t{1'000'000};
      wall.advance_ns(ns);
      cpu.advance_ns(ns / 4);
      return {};
    };
    return cli::measure(work, {wall, cpu}, limits);
  }
};

TEST(Measure, median_and_minimum_of_what_is_measured_alone) {
  ManualWork odd{{}, {}, {300, 100, 200}};
  const Result<Timing> timing = odd.measure();
  ASSERT_TRUE(timing.has_value());
  EXPECT_EQ(timing->runs, 3u);
  EXPECT_DOUBLE_EQ(timing->median_ms, 200);
  EXPECT_DOUBLE_EQ(timing->min_ms, 100);
  EXPECT_DOUBLE_EQ(timing->cpu_ms, 50);
  ManualWork even{{}, {}, {100, 100, 140, 160}};
  EXPECT_DOUBLE_EQ(even.measure()->median_ms, 120) << "the mean of the two in the middle";
}

TEST(Measure, quick_work_is_repeated_until_there_is_enough_and_slow_work_at_least_three_times) {
  EXPECT_EQ((ManualWork{{}, {}, {50}}).measure()->runs, 10u) << "half a second";
  EXPECT_EQ((ManualWork{{}, {}, {0}}).measure()->runs, RepetitionLimits{}.max_runs);
  EXPECT_EQ((ManualWork{{}, {}, {700}}).measure()->runs, 3u);
  EXPECT_EQ((ManualWork{{}, {}, {2000}}).measure()->runs, 2u) << "more than three seconds are too much";
  EXPECT_EQ((ManualWork{{}, {}, {9000}}).measure()->runs, 1u);
}

TEST(Measure, an_error_ends_it) {
  ManualClock clock;
  int runs = 0;
  TimedWork work;
  work.run = [&]() -> Result<void> {
    ++runs;
    return fail("a.k", "no");
  };
  const Result<Timing> timing = measure(work, {clock, clock});
  ASSERT_FALSE(timing.has_value());
  EXPECT_EQ(timing.error().text(), "a.k: no");
  EXPECT_EQ(runs, 1);
}

class BenchCommand : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    std::filesystem::create_directories(folder / "tmp");
    if (const char* set = std::getenv("TMPDIR")) before_ = set;
    ::setenv("TMPDIR", path("tmp").c_str(), 1);
  }
  void TearDown() override {
    EXPECT_TRUE(std::filesystem::is_empty(folder / "tmp")) << "nothing stays in the folder for temporary files";
    if (before_)
      ::setenv("TMPDIR", before_->c_str(), 1);
    else
      ::unsetenv("TMPDIR");
    Cli::TearDown();
  }

  static std::vector<std::string> names_of(const json& bench) {
    std::vector<std::string> names;
    for (const json& figure : bench["figures"]) names.push_back(figure["name"]);
    return names;
  }
  static json figure(const json& bench, const std::string& name) {
    for (const json& each : bench["figures"])
      if (each["name"] == name) return each;
    return nullptr;
  }

 private:
  std::optional<std::string> before_;
};

/// All numbers of a figure are there and make sense together.
void expect_measured(const json& figure) {
  SCOPED_TRACE(figure.dump());
  EXPECT_GE(figure["runs"].get<int>(), 1);
  for (const char* field : {"median_ms", "min_ms", "cpu_ms"}) {
    ASSERT_TRUE(figure[field].is_number());
    EXPECT_GE(figure[field].get<double>(), 0);
  }
  EXPECT_LE(figure["min_ms"].get<double>(), figure["median_ms"].get<double>());
  int sizes = 0;
  for (const char* unit : {"bytes", "nodes", "shells"}) {
    if (!figure.contains(unit)) continue;
    ++sizes;
    EXPECT_GT(figure[unit].get<std::size_t>(), 0u);
    EXPECT_GT(figure[std::string(unit) + "_per_s"].get<double>(), 0);
  }
  EXPECT_EQ(sizes, 1);
}

TEST_F(BenchCommand, measures_every_figure_of_a_deck_and_leaves_it_as_it_is) {
  const std::string text = plate_text();
  const std::string deck = write("plate.k", text);
  const auto before = names();
  const Outcome outcome = prismesh({"bench", deck, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << "one object in a line";
  const json bench = outcome.json();
  EXPECT_EQ(bench["version"], PRISMESH_VERSION);
  EXPECT_GE(bench["threads"].get<int>(), 1);
  EXPECT_TRUE(bench["processor"].is_null() || bench["processor"].is_string());
  EXPECT_EQ(bench["deck"], deck);
  EXPECT_EQ(bench["format"], "ls-dyna");
  EXPECT_EQ(bench["bytes"], text.size());
  EXPECT_EQ(bench["nodes"], 35);
  EXPECT_EQ(bench["shells"], 24);
  EXPECT_THAT(bench["patch"]["centre"].get<std::string>(), StartsWith("node:1"));
  EXPECT_GT(bench["patch"]["nodes"].get<int>(), 0);
  EXPECT_GT(bench["patch"]["shells"].get<int>(), 0);
  EXPECT_EQ(names_of(bench), kAllFigures);
  for (const json& each : bench["figures"]) {
    EXPECT_TRUE(each["note"].is_null() || each["name"] == "relax_all") << each;
    expect_measured(each);
  }
  EXPECT_EQ(figure(bench, "open")["bytes"], text.size());
  EXPECT_EQ(figure(bench, "copy")["bytes"], text.size());
  EXPECT_EQ(figure(bench, "quality")["shells"], 24);
  EXPECT_EQ(figure(bench, "relax_all")["nodes"], 35);
  EXPECT_EQ(figure(bench, "relax_all")["note"], "nothing to relax: every node is where it is best") << "as the plate was read";
  EXPECT_EQ(figure(bench, "lift_beside")["nodes"], figure(bench, "lift")["nodes"]) << "only the nodes that it names move";
  EXPECT_EQ(figure(bench, "select_region")["shells"], 24) << "a flat plate is one region";
  EXPECT_EQ(read(deck), text);
  EXPECT_EQ(names(), before);
}

TEST_F(BenchCommand, works_on_all_formats) {
  std::string nastran = "BEGIN BULK\n", radioss_nodes, radioss_shells, abaqus_nodes, abaqus_shells;
  for (int j = 0; j <= 8; ++j)
    for (int i = 0; i <= 8; ++i) {
      const int id = 1 + 9 * j + i;
      char line[96];
      std::snprintf(line, sizeof line, "GRID,%d,,%d.,%d.,0.\n", id, 5 * i, 5 * j);
      nastran += line;
      std::snprintf(line, sizeof line, "%10d%20d%20d%20d\n", id, 5 * i, 5 * j, 0);
      radioss_nodes += line;
      std::snprintf(line, sizeof line, "%d, %d., %d., 0.\n", id, 5 * i, 5 * j);
      abaqus_nodes += line;
      if (i == 8 || j == 8) continue;
      const int shell = 1 + 8 * j + i;
      std::snprintf(line, sizeof line, "CQUAD4,%d,7,%d,%d,%d,%d\n", shell, id, id + 1, id + 10, id + 9);
      nastran += line;
      std::snprintf(line, sizeof line, "%10d%10d%10d%10d%10d\n", shell, id, id + 1, id + 10, id + 9);
      radioss_shells += line;
      std::snprintf(line, sizeof line, "%d, %d, %d, %d, %d\n", shell, id, id + 1, id + 10, id + 9);
      abaqus_shells += line;
    }
  nastran += "PSHELL,7,2,1.2\nMAT1,2,210000.,,.3,7.85-9\nENDDATA\n";
  const std::string units = "                  kg                  mm                  ms\n";
  const std::string radioss = "#RADIOSS STARTER\n/BEGIN\ndeck\n      2022         0\n" + units + units + "/NODE\n" + radioss_nodes +
                              "/PART/7\nplate\n         7         8         0\n/SHELL/7\n" + radioss_shells + "/END\n";
  const std::string abaqus = "*NODE\n" + abaqus_nodes + "*ELEMENT, TYPE=S4R, ELSET=PLATE\n" + abaqus_shells;
  const std::pair<const char*, std::string> decks[] = {
      {"nastran", write("plate.bdf", nastran)}, {"radioss", write("plate_0000.rad", radioss)}, {"abaqus", write("plate.inp", abaqus)}};
  for (const auto& [format, deck] : decks) {
    SCOPED_TRACE(format);
    const std::string text = read(deck);
    const Outcome outcome = prismesh({"bench", deck, "--json"});
    ASSERT_EQ(outcome.status, kDone) << outcome.err;
    const json bench = outcome.json();
    EXPECT_EQ(bench["format"], format);
    EXPECT_EQ(bench["shells"], 64);
    EXPECT_EQ(names_of(bench), kAllFigures);
    for (const json& each : bench["figures"]) expect_measured(each);
    EXPECT_EQ(read(deck), text);
  }
}

TEST_F(BenchCommand, the_table_has_a_line_for_each_figure_below_machine_and_deck) {
  const std::string deck = write("plate.k", plate_text());
  const Outcome outcome = prismesh({"bench", deck, "quality|drag"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  std::istringstream lines(outcome.out);
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  ASSERT_EQ(all.size(), 7u) << outcome.out;
  EXPECT_THAT(all[0], ::testing::ContainsRegex("^prismesh " PRISMESH_VERSION ", [0-9]+ threads?"));
  EXPECT_THAT(all[1], StartsWith(deck + ": ls-dyna, 24 shells, 35 nodes, "));
  EXPECT_THAT(all[2], StartsWith("patch for drag, lift, relax and repair: "));
  EXPECT_THAT(all[3], StartsWith("figure"));
  EXPECT_THAT(all[4], StartsWith("quality "));
  EXPECT_THAT(all[4], HasSubstr(" 24 shells "));
  EXPECT_THAT(all[5], StartsWith("drag_begin "));
  EXPECT_THAT(all[6], StartsWith("drag_step "));
}

TEST_F(BenchCommand, a_filter_chooses_figures_by_their_names) {
  const std::string deck = write("plate.k", plate_text());
  const std::pair<const char*, std::vector<std::string>> filters[] = {
      {"drag", {"drag_begin", "drag_step"}},
      {"^(open|save)$", {"open", "save"}},
      {"QUAL", {"quality"}},
      {"", kAllFigures},
  };
  for (const auto& [filter, wanted] : filters) {
    const Outcome outcome = prismesh({"bench", deck, filter, "--json"});
    ASSERT_EQ(outcome.status, kDone) << outcome.err;
    EXPECT_EQ(names_of(outcome.json()), wanted) << filter;
  }
}

TEST_F(BenchCommand, without_a_deck_the_sample_is_measured) {
  const Outcome outcome = prismesh({"bench", "--elements", "2000", "quality", "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json bench = outcome.json();
  EXPECT_TRUE(bench["deck"].is_null());
  EXPECT_NEAR(bench["shells"].get<double>(), 2000, 20);
  EXPECT_EQ(names_of(bench), std::vector<std::string>{"quality"});
  const Outcome text = prismesh({"bench", "--elements", "2000", "open"});
  EXPECT_THAT(text.out, HasSubstr("\ngenerated sample: ls-dyna, "));
}

TEST_F(BenchCommand, the_patch_has_about_as_many_nodes_as_wanted_where_they_fit) {
  const auto patch_of = [&](const char* nodes) {
    const Outcome outcome = prismesh({"bench", "--elements", "20000", "--patch", nodes, "^lift$", "--json"});
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    return outcome.json()["patch"]["nodes"].get<int>();
  };
  EXPECT_NEAR(patch_of("50"), 50, 25) << "one ring more or less";
  EXPECT_NEAR(patch_of("1000"), 1000, 130);
  EXPECT_NEAR(patch_of("100000"), 600, 100) << "no part has so many: the next size that fits";
}

TEST_F(BenchCommand, wrong_usage_says_what_is_right) {
  const std::string deck = write("plate.k", plate_text());
  const std::pair<std::vector<std::string>, const char*> all[] = {
      {{"bench", deck, "["}, "the filter \"[\" is no regular expression"},
      {{"bench", deck, "("}, "no regular expression"},
      {{"bench", deck, std::string(500, '(')}, "more than 100 characters"},
      {{"bench", deck, "frames"},
       "no figure matches \"frames\"; the figures are open, quality, select_region, drag_begin, drag_step, slide_step, lift, lift_beside, "
       "undo, relax, relax_all, repair, save, copy"},
      {{"bench", path("absent.k")}, "there is no deck \""},
      {{"bench", "frames"}, "there is no deck \"frames\", and no figure matches \"frames\"; the figures are open, "},
      {{"bench", deck, "--elements", "5000"}, "--elements is the size of the sample"},
      {{"bench", "--elements", "1999"}, "2000"},
      {{"bench", deck, "--patch", "0"}, "--patch"},
      {{"bench", deck, "open", "save"}, "save"},
      {{"bench", deck, "--frobnicate"}, "--frobnicate"},
  };
  for (const auto& [args, says] : all) {
    const Outcome outcome = prismesh(args);
    EXPECT_EQ(outcome.status, kWrongUsage) << says;
    EXPECT_THAT(outcome.err, HasSubstr(says));
    EXPECT_THAT(outcome.err, StartsWith("prismesh bench: "));
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST_F(BenchCommand, a_bad_deck_is_refused_with_its_place) {
  std::string text = plate_text();
  text.replace(text.find("*ELEMENT_SHELL\n") + 15, 8, "    1O01");
  const std::string deck = write("plate.k", text);
  const Outcome outcome = prismesh({"bench", deck, "--json"});
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_THAT(outcome.err, ::testing::ContainsRegex("plate.k:40: "));
  EXPECT_EQ(outcome.out, "");
  const Outcome absent = prismesh({"bench", path("absent.k"), "open"});
  EXPECT_EQ(absent.status, kFailed) << "with a filter behind it, it is meant to be a deck";
  EXPECT_THAT(absent.err, StartsWith(path("absent.k")));
}

TEST_F(BenchCommand, what_a_deck_does_not_allow_is_said_on_its_line) {
  const std::string nodes =
      "*KEYWORD\n*NODE\n" + node_card(1, 0, 0, 0) + node_card(2, 5, 0, 0) + node_card(3, 5, 5, 0) + node_card(4, 0, 5, 0);
  const std::string beams = write("beams.k", nodes + "*ELEMENT_BEAM\n       1       1       1       2       3\n*END\n");
  const Outcome no_shells = prismesh({"bench", beams, "--json"});
  ASSERT_EQ(no_shells.status, kDone) << no_shells.err;
  json bench = no_shells.json();
  EXPECT_EQ(names_of(bench), kAllFigures);
  EXPECT_TRUE(bench["patch"].is_null());
  expect_measured(figure(bench, "open"));
  expect_measured(figure(bench, "save"));
  EXPECT_THAT(prismesh({"bench", beams, "save"}).out, HasSubstr("  the deck as it was read, flushed to disk\n"));
  for (const char* name : {"quality", "select_region", "drag_begin", "drag_step", "slide_step", "lift", "lift_beside", "undo", "relax",
                           "relax_all", "repair"}) {
    const json each = figure(bench, name);
    EXPECT_EQ(each["note"], "the deck has no shells") << name;
    EXPECT_EQ(each["runs"], 0);
    EXPECT_TRUE(each["median_ms"].is_null());
  }

  std::string held = "*KEYWORD\n*PARAMETER\nR  height       0.0\n*NODE\n";
  for (int n = 0; n < 4; ++n) {
    char line[96];
    std::snprintf(line, sizeof line, "%8d%16.6f%16.6f         &height\n", n + 1, 5.0 * (n == 1 || n == 2), 5.0 * (n >= 2));
    held += line;
  }
  const std::string deck = write("held.k", held + "*ELEMENT_SHELL\n" + shell_card(1, 1, 1, 2, 3, 4) + "*END\n");
  const Outcome none_moves = prismesh({"bench", deck});
  ASSERT_EQ(none_moves.status, kDone) << none_moves.err;
  EXPECT_THAT(none_moves.out, ::testing::ContainsRegex("\nlift +not measured: .*held.k:[0-9]+: .*parameter"));
  EXPECT_THAT(none_moves.out, ::testing::ContainsRegex("\nselect_region +[0-9]+\\.[0-9]+ "));
}

TEST_F(BenchCommand, stops_when_the_user_asks) {
  const std::string deck = write("plate.k", plate_text());
  for (const auto& args : {std::vector<std::string>{"bench", deck}, std::vector<std::string>{"bench", "--elements", "2000"}}) {
    std::ostringstream out, err;
    std::atomic<bool> interrupted{true};
    EXPECT_EQ(run(args, {out, err, false, &interrupted}), kFailed);
    EXPECT_THAT(err.str(), HasSubstr("cancelled"));
    EXPECT_EQ(out.str(), "");
  }
}

TEST_F(BenchCommand, a_folder_for_temporary_files_that_is_missing_is_named) {
  const std::string deck = write("plate.k", plate_text());
  ::setenv("TMPDIR", path("absent").c_str(), 1);
  const Outcome outcome = prismesh({"bench", deck});
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_THAT(outcome.err, StartsWith(path("absent") + ": "));
  EXPECT_THAT(outcome.err, HasSubstr("TMPDIR"));
}

}  // namespace
}  // namespace prismesh::cli
