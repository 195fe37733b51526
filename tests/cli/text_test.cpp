// Plain-text output: each figure, and the messages for invalid journals and decks.
#include "cli/report_text.h"
#include "mesh/document/edit_json.h"
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

constexpr const char* kRaiseCorner = R"({"edit": "translate", "by": [0, 0, 3], "on": "101", "falloff": {"profile": "constant"}})";

/// The plate with cards before *END.
std::string plate_with(std::string text, const std::string& cards) { return text.insert(text.find("*END"), cards); }

TEST_F(Cli, diff_counts_elements_of_a_kind_that_only_one_deck_has) {
  const std::string plain = write("plain.k", plate_text());
  const std::string beams =
      write("beams.k", plate_with(plate_text(), "*ELEMENT_BEAM\n       1       7     101     135\n       2       7     102     134\n"));
  const Outcome more = prismesh({"diff", plain, beams, "--json"}), fewer = prismesh({"diff", beams, plain, "--json"});
  EXPECT_EQ(more.json()["elements_added"], 2);
  EXPECT_EQ(more.json()["elements_removed"], 0);
  EXPECT_EQ(fewer.json()["elements_added"], 0);
  EXPECT_EQ(fewer.json()["elements_removed"], 2);
}

TEST_F(Cli, diff_says_its_figures_in_words) {
  const std::string a = write("a.k", plate_text());
  std::string text = plate_text();
  text.replace(text.find(node_card(101, 0, 0, 0)), 57, node_card(101, 0, 0, 3));
  text.erase(text.find(shell_card(1024, 7, 127, 128, 135, 134)), 49);
  text.insert(text.find("*ELEMENT_SHELL"), node_card(999, 50, 50, 50));
  const Outcome outcome = prismesh({"diff", a, write("b.k", text)});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("nodes: 1 moved (max 3), 1 added, 0 removed\n"));
  EXPECT_THAT(outcome.out, HasSubstr("elements: 0 added, 1 removed, 0 changed\n"));
  EXPECT_THAT(outcome.out, HasSubstr("lines: 3 changed\n"));
  EXPECT_THAT(outcome.out, HasSubstr("displacement: max 3 (node:101), mean 0.0857143 over 35 nodes\n"));
  EXPECT_THAT(outcome.out, HasSubstr("distance of the second deck's shells from the first's: max 3 (node:101)"));
  const Outcome same = prismesh({"diff", a, a});
  EXPECT_EQ(same.out, "nodes: 0 moved (max 0), 0 added, 0 removed\nelements: 0 added, 0 removed, 0 changed\nlines: 0 changed\n");
}

TEST_F(Cli, diff_counts_the_lines_of_files_that_only_one_deck_has) {
  const std::string main = "*KEYWORD\n*INCLUDE\nrest.k\n*END\n";
  write("a/rest.k", plate_text());
  const std::string a = write("a/main.k", main);
  write("b/rest.k", plate_text());
  write("b/more.k", "*PART\nmore\n         8         3         2\n");
  const std::string b = write("b/main.k", "*KEYWORD\n*INCLUDE\nrest.k\n*INCLUDE\nmore.k\n*END\n");
  EXPECT_EQ(prismesh({"diff", a, b, "--json"}).json()["lines_changed"], 2 + 3);
  EXPECT_EQ(prismesh({"diff", b, a, "--json"}).json()["lines_changed"], 2 + 3);
}

TEST(ChangeWords, say_what_was_made_instead_of_no_nodes_that_moved) {
  mesh::document::EditReport report;
  EXPECT_EQ(change_words(report), "0 nodes moved");
  report.elements_added = 2, report.elements_removed = 1;
  EXPECT_EQ(change_words(report), "2 elements added, 1 element removed");
  report.nodes_moved = 3;
  EXPECT_EQ(change_words(report), "3 nodes moved, 2 elements added, 1 element removed");
  report.welds_mended.emplace().mended = 1;
  EXPECT_EQ(change_words(report), "1 weld mended, 3 nodes moved, 2 elements added, 1 element removed");
  report.welded.emplace().welds_added = 6;
  EXPECT_EQ(change_words(report), "6 welds added");
}

TEST_F(Cli, replay_says_each_edit_and_how_many_were_done) {
  const std::string deck = write("plate.k", plate_text());
  const std::string script =
      write("s.jsonl", std::string(kRaiseCorner) + "\n\n" + R"({"edit": "translate", "by": [0, 0, 1], "on": "9"})" + "\n");
  const Outcome outcome = prismesh({"replay", script, deck, "-o", path("out.k")});
  EXPECT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("line 1: translate: 1 node moved\n"));
  EXPECT_THAT(outcome.out, HasSubstr("line 3: translate not applied: "));
  EXPECT_THAT(outcome.out, HasSubstr("1 of 2 edits applied\n"));
  EXPECT_THAT(outcome.err, HasSubstr(script + ":3: warning: this translate was not applied: "));
  EXPECT_EQ(prismesh({"diff", deck, path("out.k"), "--json"}).json()["nodes_moved"], 1);
  const std::string useless = write("u.jsonl", R"({"edit": "translate", "by": [0, 0, 1], "on": "9"})"
                                               "\n");
  const Outcome none = prismesh({"replay", useless, deck, "-o", path("none.k")});
  EXPECT_EQ(none.status, kFailed);
  EXPECT_THAT(none.out, HasSubstr("0 of 1 edits applied\n"));
  EXPECT_THAT(none.err, HasSubstr(useless + ": no edit could be applied; nothing is written\n"));
  EXPECT_FALSE(exists("none.k"));
}

TEST_F(Cli, replay_says_what_is_wrong_with_a_journal_and_does_the_rest) {
  const std::string deck = write("plate.k", plate_text()), journal = path("j.jsonl");
  const std::string lower = R"({"edit": "translate", "by": [0, 0, -1], "on": "102", "falloff": {"profile": "constant"}})";
  ASSERT_EQ(prismesh({"edit", deck, "--edit", kRaiseCorner, "--edit", lower, "-o", path("out.k"), "--journal", journal}).status, kDone);
  const std::string whole = read(journal);
  const auto replayed = [&](const std::string& text, const std::string& on) {
    write("j.jsonl", text);
    Outcome outcome = prismesh({"replay", journal, on, "-o", path("again.k")});
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    return outcome;
  };
  EXPECT_EQ(replayed(whole, deck).err.find("journal"), std::string::npos);
  const Outcome torn = replayed(whole.substr(0, whole.size() - 1), deck);
  EXPECT_THAT(torn.err, HasSubstr(journal + ": warning: the last record is incomplete and left out\n"));
  EXPECT_THAT(torn.out, HasSubstr("1 of 1 edits applied\n"));
  std::string damaged = whole;
  damaged[damaged.rfind("translate")] = 'T';
  const Outcome rest = replayed(damaged, deck);
  EXPECT_THAT(rest.err, HasSubstr(journal + ":4: warning: the journal is damaged here"));
  EXPECT_THAT(rest.err, HasSubstr("; only the edits before it are replayed\n"));
  EXPECT_THAT(rest.out, HasSubstr("1 of 1 edits applied\n"));
  const Outcome other = replayed(whole, write("other.k", plate_with(plate_text(), "$ another\n")));
  EXPECT_THAT(other.err, HasSubstr(journal + ": note: made on another deck, " + deck + "\n"));
  EXPECT_THAT(other.out, HasSubstr("2 of 2 edits applied\n"));
}

TEST_F(Cli, a_journal_that_is_there_is_not_written_over) {
  const std::string deck = write("plate.k", plate_text()), journal = write("j.jsonl", "mine\n");
  const Outcome outcome = prismesh({"edit", deck, "--edit", kRaiseCorner, "-o", path("out.k"), "--journal", journal});
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_THAT(outcome.err, HasSubstr("there is a journal (or another file) already"));
  EXPECT_EQ(read(journal), "mine\n");
  EXPECT_FALSE(exists("out.k"));
}

TEST_F(Cli, edit_says_what_it_did_and_what_it_noted) {
  const std::string deck = write("plate.k", plate_text());
  const Outcome outcome = prismesh({"edit", deck, "--edit", kRaiseCorner, "--edit", R"({"edit": "show"})", "-o", path("out.k")});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("translate: 1 node moved; warn 0 -> "));
  EXPECT_THAT(outcome.out, HasSubstr("show: 0 nodes moved; warn "));
  EXPECT_THAT(outcome.out, HasSubstr("\n  no part changed\n"));
  EXPECT_THAT(outcome.err, HasSubstr("note: guessed length unit mm, target size 5 from the median edge; set with --length-unit and "
                                     "--target-size\n"));
}

TEST_F(Cli, info_says_parts_files_and_warnings_in_words) {
  const std::string deck =
      write("plate.k", plate_with(plate_text(), "*ELEMENT_SHELL\n" + shell_card(1900, 7, 101, 102, 109, 109) + "*INCLUDE\ngone.k\n"));
  const Outcome outcome = prismesh({"info", deck});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1 file\n"));
  EXPECT_THAT(outcome.out, HasSubstr("length unit  mm (guessed)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("target size  5 mm (guessed)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("nodes        35\n"));
  EXPECT_THAT(outcome.out, HasSubstr("shells       24 quads, 1 triangles, 0 8-node quads, 0 6-node triangles\n"));
  EXPECT_THAT(outcome.out, HasSubstr("parts        1\n  part:7  plate  24 quads, 1 triangles, 1.2 mm thick, target size 5 mm (guessed)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("warnings     1\n"));
  EXPECT_THAT(outcome.out, HasSubstr("gone.k"));
  EXPECT_THAT(prismesh({"info", deck, "--target-size", "4", "--length-unit", "m"}).out, HasSubstr("length unit  m\ntarget size  4 m\n"));
}

TEST_F(Cli, check_says_defects_structure_and_parts_in_words) {
  std::string cards = "*ELEMENT_SHELL\n" + shell_card(1900, 7, 101, 102, 109, 108) + shell_card(1901, 7, 101, 101, 109, 108);
  for (int part = 100; part < 141; ++part)
    cards += "*ELEMENT_SHELL\n" + shell_card(2000 + part, part, 101, 102, 109, 108) + "*PART\npart " + std::to_string(part) + "\n" +
             "       " + std::to_string(part) + "         3         2\n";
  const Outcome outcome = prismesh({"check", write("plate.k", plate_with(plate_text(), cards))});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1 shell with corners at one place (fail)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("shells duplicate others\n"));
  EXPECT_THAT(outcome.out, HasSubstr("and 2 more parts; all are in the JSON\n"));
  EXPECT_THAT(outcome.out, HasSubstr("target size 5 mm (guessed), criteria default\n"));
  const Outcome plain = prismesh({"check", write("plain.k", plate_text()), "--target-size", "5", "--length-unit", "mm"});
  EXPECT_THAT(plain.out, StartsWith("24 shells: 24 ok, 0 warn, 0 fail\ntarget size 5 mm, criteria default\ntriangles 0 %\n"));
  EXPECT_THAT(plain.out, HasSubstr("centre of gravity 15 10 0"));
  EXPECT_EQ(plain.out.find("more parts"), std::string::npos);
  EXPECT_EQ(plain.out.find("(fail)"), std::string::npos);
}

TEST_F(Cli, distance_says_from_where_to_where) {
  const std::string deck = write("plate.k", plate_text());
  const Outcome outcome = prismesh({"distance", deck, "--from", "101,108", "--to", "107"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("30 mm from node:101 (0 0 0) to node:107 (30  0  0)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("2 nodes: 30 to 30.4138 (node:108), mean 30.2069\n"));
  for (const auto& [from, to] : {std::pair("9", "101"), std::pair("101", "9")}) {
    const Outcome refused = prismesh({"distance", deck, "--from", from, "--to", to});
    EXPECT_EQ(refused.status, kFailed);
    EXPECT_THAT(refused.err, HasSubstr("no node 9"));
    EXPECT_EQ(refused.out, "");
  }
}

}  // namespace
}  // namespace prismesh::cli
