// edit, replay, sample: the commands that write.
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using nlohmann::json;

constexpr const char* kSelect = R"({"edit": "select", "expr": "101-135"})";
constexpr const char* kLift = R"({"edit": "lift", "distance": 2, "on": "109-111,116-118,123-125", "grab": 117})";

std::vector<json> lines(const std::string& text) {
  std::vector<json> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) all.push_back(json::parse(line));
  return all;
}

TEST_F(Cli, a_save_that_fails_leaves_no_folders) {
  const std::string deck = write("plate.k", plate_text());
  std::filesystem::create_symlink("gone/deep/out.k", folder / "link.k");
  const std::vector<std::string> before = names();
  for (const std::string& out : {path("plate.k/sub/out.k"), path("new/deep/"), path("link.k")}) {
    const Outcome outcome = prismesh({"edit", deck, "-o", out});
    EXPECT_EQ(outcome.status, kFailed) << out;
    EXPECT_EQ(names(), before) << out;
  }
  EXPECT_THAT(prismesh({"edit", deck, "-o", path("link.k")}).err, HasSubstr("whose folder isn't there"));
  EXPECT_THAT(prismesh({"edit", deck, "-o", path("new/")}).err, HasSubstr("names a folder; give a file's name"));
}

TEST_F(Cli, no_edits_write_the_same_bytes) {
  std::string text = plate_text();
  text.insert(text.find("*PART"), "*MAT_UNKNOWN_STRANGE\r\n\tanything \xff at all\n*INCLUDE\nsub/more.k\n");
  write("in/sub/more.k", "*SET_NODE_LIST\r\n         1\r\n       101       102\r\n");
  const std::string deck = write("in/plate.k", text);
  const Outcome outcome = prismesh({"edit", deck, "-o", path("out/copy.k"), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(read(path("out/copy.k")), text);
  EXPECT_EQ(read(path("out/sub/more.k")), read(path("in/sub/more.k")));
}

TEST_F(Cli, an_edit_is_a_line_of_json_and_moves_only_its_nodes) {
  const std::string deck = write("plate.k", plate_text());
  const Outcome outcome = prismesh({"edit", deck, "--edit", kSelect, "--edit", kLift, "-o", path("out.k"), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const std::vector<json> reports = lines(outcome.out);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0]["edit"], "select");
  const json& lift = reports[1];
  for (const char* field : {"edit", "ok", "nodes_moved", "elements_added", "elements_removed", "before", "after", "notes", "ms"})
    EXPECT_TRUE(lift.contains(field)) << field;
  EXPECT_EQ(lift["ok"], true);
  ASSERT_TRUE(lift["cog_before"].is_array() && lift["cog_after"].is_array());
  EXPECT_NEAR(lift["cog_before"][2].get<double>(), 0, 1e-12);
  EXPECT_GT(lift["cog_after"][2].get<double>(), 0.05) << "nine nodes of the plate went up";
  EXPECT_NEAR(lift["mass_before"].get<double>(), prismesh({"check", deck, "--json"}).json()["mass"].get<double>(), 1e-15);
  EXPECT_EQ(lift["before"], (json{{"warn", 0}, {"fail", 0}}));
  EXPECT_GT(lift["after"]["fail"].get<int>() + lift["after"]["warn"].get<int>(), 0);
  const json difference = prismesh({"diff", deck, path("out.k"), "--json"}).json();
  EXPECT_EQ(difference["nodes_moved"], lift["nodes_moved"]);
  EXPECT_EQ(difference["lines_changed"], lift["nodes_moved"]);
  EXPECT_DOUBLE_EQ(difference["max_displacement"].get<double>(), 2.0);
  EXPECT_EQ(read(deck), plate_text());
}

TEST_F(Cli, edits_come_before_the_script_and_in_place_works) {
  const std::string deck = write("plate.k", plate_text());
  const std::string script =
      write("moves.jsonl", R"({"edit": "translate", "by": [0, 0, 1], "grab": 101})"
                           "\n"
                           R"({"edit": "undo"})"
                           "\n"
                           R"({"edit": "translate", "by": [0, 0, 3], "falloff": {"profile": "constant"}, "grab": 101})");
  const Outcome outcome = prismesh({"edit", deck, "--script", script, "--edit", kSelect, "-o", deck, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(lines(outcome.out).size(), 4u);
  EXPECT_NE(read(deck), plate_text());
  const std::string original = write("original.k", plate_text());
  EXPECT_DOUBLE_EQ(prismesh({"diff", original, deck, "--json"}).json()["max_displacement"].get<double>(), 3.0);
}

TEST_F(Cli, a_failing_edit_writes_nothing_at_all) {
  const std::string deck = write("plate.k", plate_text());
  const auto before = names();
  const Outcome outcome = prismesh({"edit", deck, "--edit", kLift, "--edit", R"({"edit": "select", "expr": "101,part:99"})", "-o",
                                    path("new/out.k"), "--journal", path("journal.jsonl"), "--json"});
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_THAT(outcome.err, HasSubstr("expression:5: "));
  EXPECT_THAT(outcome.err, HasSubstr("--edit:2: this select was not done, and nothing is written"));
  const std::vector<json> reports = lines(outcome.out);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0]["ok"], true);
  EXPECT_EQ(reports[1]["ok"], false);
  EXPECT_EQ(names(), before);
  // a target that can't be written leaves nothing either
  const Outcome unwritable = prismesh({"edit", deck, "--edit", kLift, "-o", deck + "/out.k", "--journal", path("journal.jsonl")});
  EXPECT_EQ(unwritable.status, kFailed);
  EXPECT_THAT(unwritable.err, HasSubstr(deck));
  EXPECT_EQ(names(), before);
}

TEST_F(Cli, nothing_to_undo_names_the_edit) {
  const std::string deck = write("plate.k", plate_text());
  const std::string script = write("undo.jsonl", "{\"edit\": \"invert\"}\n{\"edit\": \"undo\"}\n{\"edit\": \"undo\"}\n");
  const Outcome outcome = prismesh({"edit", deck, "--script", script, "-o", path("out.k")});
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_THAT(outcome.err, HasSubstr(script + ":3: "));
  EXPECT_FALSE(exists("out.k"));
}

TEST_F(Cli, unparsable_json_is_wrong_usage_and_names_the_line) {
  const std::string deck = write("plate.k", plate_text());
  const auto refused = [&](const std::string& script_text) {
    return prismesh({"edit", deck, "--script", write("s.jsonl", script_text), "-o", path("out.k")});
  };
  const Outcome broken = refused(std::string(kSelect) + "\n{\"edit\": \n");
  EXPECT_EQ(broken.status, kWrongUsage);
  EXPECT_THAT(broken.err, StartsWith(path("s.jsonl") + ":2: "));
  const Outcome replayed = prismesh({"replay", path("s.jsonl"), deck, "-o", path("out.k")});
  EXPECT_EQ(replayed.status, kWrongUsage);
  EXPECT_EQ(replayed.err, broken.err);
  EXPECT_EQ(refused("# a comment\n").status, kWrongUsage);
  const Outcome inline_edit = prismesh({"edit", deck, "--edit", kSelect, "--edit", "select all", "-o", path("out.k")});
  EXPECT_EQ(inline_edit.status, kWrongUsage);
  EXPECT_THAT(inline_edit.err, StartsWith("--edit:2: "));
  // JSON that is no edit can't be done as asked
  const Outcome unknown = refused(R"({"edit": "transalte", "by": [0, 0, 1]})");
  EXPECT_EQ(unknown.status, kFailed);
  EXPECT_THAT(unknown.err, HasSubstr("translate"));
  EXPECT_EQ(prismesh({"edit", deck, "--script", path("absent.jsonl"), "-o", path("out.k")}).status, kFailed);
  EXPECT_FALSE(exists("out.k"));
}

TEST_F(Cli, empty_lines_of_a_script_count_as_lines_only) {
  const std::string deck = write("plate.k", plate_text());
  const std::string script = write("s.jsonl", std::string(kSelect) + "\r\n\r\n  \n" + kLift + "\n\n");
  const Outcome outcome = prismesh({"edit", deck, "--script", script, "-o", path("out.k"), "--json"});
  EXPECT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(lines(outcome.out).size(), 2u);
  EXPECT_EQ(prismesh({"replay", script, deck, "-o", path("again.k")}).status, kDone);
  EXPECT_EQ(read(path("again.k")), read(path("out.k")));
  const std::string broken = write("b.jsonl", std::string("\n\n") + "{\n");
  EXPECT_THAT(prismesh({"edit", deck, "--script", broken, "-o", path("no.k")}).err, StartsWith(broken + ":3: "));
}

TEST_F(Cli, a_journal_replays_to_the_same_bytes) {
  const std::string deck = write("plate.k", plate_text());
  const std::string journal = path("journal.jsonl");
  ASSERT_EQ(prismesh({"edit", deck, "--edit", kSelect, "--edit", kLift, "--edit", R"({"edit": "undo"})", "--edit", kLift, "-o",
                      path("out.k"), "--journal", journal})
                .status,
            kDone);
  const Outcome outcome = prismesh({"replay", journal, deck, "-o", path("again.k"), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(read(path("again.k")), read(path("out.k")));
  const json replay = outcome.json();
  EXPECT_EQ(replay["applied"], 4);
  EXPECT_EQ(replay["not_applied"], 0);
  EXPECT_EQ(replay["other_deck"], false);
  EXPECT_EQ(replay["steps"].size(), 4u);
  // a journal is never overwritten
  const std::string kept = read(journal);
  const Outcome again = prismesh({"edit", deck, "--edit", kLift, "-o", path("out2.k"), "--journal", journal});
  EXPECT_EQ(again.status, kFailed);
  EXPECT_THAT(again.err, HasSubstr(journal));
  EXPECT_EQ(read(journal), kept);
  EXPECT_FALSE(exists("out2.k"));
}

TEST_F(Cli, a_deck_does_not_take_its_journals_place) {
  const std::string deck = write("plate.k", plate_text());
  const Outcome outcome = prismesh({"edit", deck, "--edit", kSelect, "-o", path("out.k"), "--journal", path("sub/../out.k")});
  EXPECT_EQ(outcome.status, kWrongUsage);
  EXPECT_THAT(outcome.err, HasSubstr("both the journal and the deck"));
  EXPECT_FALSE(exists("out.k"));
}

TEST_F(Cli, replay_on_a_variant_says_what_did_not_apply) {
  const std::string script = write("s.jsonl", std::string(kLift) + "\n" + R"({"edit": "select", "expr": "part:99"})" + "\n");
  const std::string deck = write("plate.k", plate_text());
  const Outcome outcome = prismesh({"replay", script, deck, "-o", path("out.k"), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(outcome.json()["applied"], 1);
  EXPECT_EQ(outcome.json()["steps"][1]["ok"], false);
  EXPECT_THAT(outcome.err, HasSubstr(script + ":2: warning: this select was not applied"));
  EXPECT_TRUE(exists("out.k"));
  const std::string hopeless = write("h.jsonl", "{\"edit\": \"select\", \"expr\": \"part:99\"}\n");
  EXPECT_EQ(prismesh({"replay", hopeless, deck, "-o", path("none.k")}).status, kFailed);
  EXPECT_FALSE(exists("none.k"));
}

TEST_F(Cli, sample_is_the_same_bytes_and_opens) {
  ASSERT_EQ(prismesh({"sample", "--elements", "2000", "-o", path("a.k")}).status, kDone);
  ASSERT_EQ(prismesh({"sample", "--elements", "2000", "-o", path("b.k")}).status, kDone);
  EXPECT_EQ(read(path("a.k")), read(path("b.k")));
  const json info = prismesh({"info", path("a.k"), "--json"}).json();
  EXPECT_NEAR(info["elements"]["quad"].get<int>() + info["elements"]["tri"].get<int>(), 2000, 60);
  EXPECT_EQ(info["length_unit"], "mm");
  EXPECT_EQ(prismesh({"check", path("a.k"), "--json"}).status, kDone);
}

TEST_F(Cli, stopped_work_leaves_nothing) {
  const std::string deck = write("plate.k", plate_text());
  const auto before = names();
  const std::atomic<bool> interrupted{true};
  std::ostringstream out, err;
  const std::vector<std::string> args = {"edit", deck, "--edit", kLift, "-o", path("out.k"), "--journal", path("journal.jsonl")};
  EXPECT_EQ(run(args, {out, err, false, &interrupted}), kFailed);
  EXPECT_THAT(err.str(), StartsWith(deck + ": "));
  EXPECT_THAT(err.str(), HasSubstr("cancelled"));
  EXPECT_EQ(names(), before);
}

/// Goes on by 100 ms each time it is read; interrupts after `stop` readings.
class SteppingClock final : public Clock {
 public:
  explicit SteppingClock(std::int64_t stop = -1) : stop_(stop) {}
  std::int64_t now_ns() override {
    if (++readings_ == stop_) interrupted = true;
    return readings_ * 100'000'000;
  }
  std::atomic<bool> interrupted{false};

 private:
  std::int64_t readings_ = 0, stop_;
};

/// A sheet of 20 x 20 quads out of which every fifth node is pulled.
std::string rough_text() {
  constexpr int kSide = 21;
  std::string text = "*KEYWORD\n*NODE\n";
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const bool pulled = i % 5 == 2 && j % 5 == 2;
      text += node_card(1 + j * kSide + i, 5 * i + (pulled ? 2.5 : 0), 5 * j + (pulled ? 1.5 : 0), pulled ? 4 : 0);
    }
  text += "*ELEMENT_SHELL\n";
  for (int j = 0; j + 1 < kSide; ++j)
    for (int i = 0; i + 1 < kSide; ++i) {
      const int a = 1 + j * kSide + i;
      text += shell_card(1 + j * (kSide - 1) + i, 7, a, a + 1, a + kSide + 1, a + kSide);
    }
  return text + "*PART\nsheet\n         7         3         2\n*END\n";
}

constexpr auto kRepairAll = R"({"edit":"repair","scope":"all"})";

TEST_F(Cli, a_repair_says_in_a_pipe_how_far_it_is) {
  const std::string deck = write("rough.k", rough_text());
  SteppingClock clock(120);
  std::ostringstream out, err;
  const std::vector<std::string> args = {"edit", deck, "--edit", kRepairAll, "-o", path("out.k"), "--json", "--keep-on-cancel"};
  EXPECT_EQ(run(args, {out, err, false, &clock.interrupted, &clock}), kFailed);
  std::vector<std::string> lines;
  std::istringstream said(err.str());
  for (std::string line; std::getline(said, line);)
    if (line.starts_with("repair: ")) lines.push_back(line);
  ASSERT_GE(lines.size(), 2u) << err.str();
  EXPECT_THAT(lines[0], ::testing::MatchesRegex("repair: round [0-9]+, [0-9]+ of [0-9]+ bad elements left, 2 s"));
  EXPECT_THAT(lines[1], ::testing::MatchesRegex("repair: round [0-9]+, [0-9]+ of [0-9]+ bad elements left, [78] s"));
  EXPECT_EQ(nlohmann::json::parse(out.str())["ok"], true);
}

TEST_F(Cli, a_stopped_repair_that_cannot_be_written_is_not_said_to_be) {
  const std::string deck = write("rough.k", rough_text());
  write("file", "no folder");
  SteppingClock clock(60);
  std::ostringstream out, err;
  const std::vector<std::string> args = {"edit", deck, "--edit", kRepairAll, "-o", path("file/out.k"), "--keep-on-cancel"};
  EXPECT_EQ(run(args, {out, err, false, &clock.interrupted, &clock}), kFailed);
  EXPECT_THAT(out.str(), HasSubstr("stopped in round"));
  EXPECT_THAT(err.str(), HasSubstr("file"));
  EXPECT_THAT(err.str(), ::testing::Not(HasSubstr("what was reached is written")));
}

TEST_F(Cli, a_repair_that_is_stopped_is_written_where_that_is_asked_for) {
  const std::string deck = write("rough.k", rough_text());
  std::vector<std::vector<std::string>> ways = {{"--keep-on-cancel", "--edit", kRepairAll},
                                                {"--edit", R"({"edit":"repair","scope":"all","on_cancel":"keep"})"}};
  std::string kept;
  for (std::vector<std::string>& way : ways) {
    SteppingClock clock(200);  // by then some elements are better
    std::ostringstream out, err;
    std::vector<std::string> args = {"edit", deck, "-o", path("out.k"), "--journal", path("kept.journal"), "--json"};
    args.insert(args.end(), way.begin(), way.end());
    args.insert(args.end(), {"--edit", R"({"edit":"hide","on":"7"})"});
    EXPECT_EQ(run(args, {out, err, false, &clock.interrupted, &clock}), kFailed);
    EXPECT_THAT(err.str(),
                HasSubstr("--edit:1: stopped in the middle of this edit; what was reached is written, without the edit after it\n"));
    const auto report = nlohmann::json::parse(out.str());
    EXPECT_EQ(report["ok"], true);
    EXPECT_GE(report["stopped"]["round"], 1);
    EXPECT_EQ(report["stopped"]["max_rounds"], 20);
    EXPECT_GT(report["stopped"]["bad_left"], 0);
    EXPECT_GT(report["nodes_moved"], 0);
    EXPECT_EQ(prismesh({"replay", path("kept.journal"), deck, "-o", path("replayed.k")}).status, kDone);
    EXPECT_EQ(read(path("replayed.k")), read(path("out.k")));
    if (kept.empty()) kept = read(path("out.k"));
    EXPECT_EQ(read(path("out.k")), kept) << "the same both ways";
    EXPECT_NE(kept, read(deck));
    for (const char* each : {"out.k", "replayed.k", "kept.journal"}) std::filesystem::remove(path(each));
  }
}

TEST_F(Cli, a_repair_that_is_stopped_is_discarded_otherwise) {
  const std::string deck = write("rough.k", rough_text());
  const auto before = names();
  SteppingClock clock(60);
  std::ostringstream out, err;
  const std::vector<std::string> args = {"edit", deck, "--edit", kRepairAll, "-o", path("out.k"), "--journal", path("kept.journal")};
  EXPECT_EQ(run(args, {out, err, false, &clock.interrupted, &clock}), kFailed);
  EXPECT_THAT(err.str(), HasSubstr("--edit:1: cancelled\n"));
  EXPECT_EQ(names(), before);
}

TEST_F(Cli, a_stopped_sample_leaves_nothing) {
  const std::atomic<bool> interrupted{true};
  std::ostringstream out, err;
  const std::vector<std::string> args = {"sample", "-o", path("s.k")};
  EXPECT_EQ(run(args, {out, err, false, &interrupted}), kFailed);
  EXPECT_EQ(err.str(), path("s.k") + ": cancelled\n");
  EXPECT_EQ(names(), std::vector<std::string>{});
}

TEST_F(Cli, results_that_can_not_be_said_are_not_written) {
  const std::string deck = write("plate.k", plate_text());
  const auto before = names();
  std::ostringstream out, err;
  out.setstate(std::ios::badbit);  // a full disk or a reader that went away
  const std::vector<std::string> args = {"edit", deck, "--edit", kLift, "-o", path("out.k"), "--journal", path("journal.jsonl")};
  EXPECT_EQ(run(args, {out, err}), kFailed);
  EXPECT_THAT(err.str(), HasSubstr("standard output: can't be written"));
  EXPECT_EQ(names(), before);
  EXPECT_EQ(run(std::vector<std::string>{"info", deck}, {out, err}), kFailed);
}

TEST_F(Cli, guesses_are_said_and_can_be_set) {
  const std::string deck = write("plate.k", plate_text());
  const Outcome guessed = prismesh({"edit", deck, "--edit", kSelect, "-o", path("a.k")});
  EXPECT_THAT(guessed.err,
              HasSubstr("note: guessed length unit mm, target size 5 from the median edge; set with --length-unit and --target-size"));
  const Outcome set = prismesh({"edit", deck, "--edit", kSelect, "-o", path("b.k"), "--length-unit", "m", "--target-size", "4"});
  EXPECT_EQ(set.err, "");
}

}  // namespace
}  // namespace prismesh::cli
