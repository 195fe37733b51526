// Checks of welds: each finding on a deck made for it, and none on a good one.
#include "mesh/document/weld_checks.h"

#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>

#include "mesh/document/journal.h"
#include "tests/mesh/document/weld_deck.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class WeldChecking : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("prismesh-weld-checks-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  WeldChecks checked(const std::string& welds, connections::WeldCheckOptions options = {}, int sheets = 2) {
    return check_welds(open_deck(folder_ / "welds.k", flange_deck(sheets, welds)), options);
  }
  /// kOneWeld with its nodes elsewhere.
  static std::string weld_at(double x, double y, double low, double high, int id = 90001) {
    char text[256];
    std::snprintf(text, sizeof text,
                  "*NODE\n%8d%16.6f%16.6f%16.6f\n%8d%16.6f%16.6f%16.6f\n*ELEMENT_BEAM\n%8d      90%8d%8d       0       0       0       0   "
                  "    0       2\n",
                  id * 2, x, y, low, id * 2 + 1, x, y, high, id, id * 2, id * 2 + 1);
    return text;
  }
  std::filesystem::path folder_;
  static std::string kinds(const WeldChecks& checks) {
    std::string all;
    for (const WeldFinding& finding : checks.findings) all += finding.kind + " ";
    return all;
  }
};

TEST_F(WeldChecking, a_good_weld_has_no_finding) {
  const WeldChecks checks = checked(kOneWeld);
  EXPECT_EQ(checks.welds, 1U);
  EXPECT_THAT(checks.findings, IsEmpty());
}

TEST_F(WeldChecking, an_end_off_its_sheet_is_told_with_its_distance) {
  const WeldChecks checks = checked(weld_at(50, 10, 0, 9.5));
  ASSERT_EQ(kinds(checks), "loose-end ");
  EXPECT_THAT(checks.findings[0].words, HasSubstr("beam:90001: node:180003 lies 8 from the nearest sheet"));
  EXPECT_NEAR(checks.findings[0].at.z(), 4.75, 1e-9);
}

TEST_F(WeldChecking, a_weld_within_a_sheet_joins_nothing) {
  // Both ends are on the lower sheet.
  char text[256];
  std::snprintf(text, sizeof text,
                "*NODE\n%8d%16.6f%16.6f%16.6f\n%8d%16.6f%16.6f%16.6f\n*ELEMENT_BEAM\n%8d      90%8d%8d       0       0       0       0     "
                "  0       2\n",
                70001, 40.0, 10.0, 0.0, 70002, 44.0, 10.0, 0.0, 90001, 70001, 70002);
  const WeldChecks checks = checked(text);
  EXPECT_EQ(kinds(checks), "joins-nothing ");
}

TEST_F(WeldChecking, free_edges_and_neighbours_are_told_where_asked) {
  const std::string three = weld_at(50, 10, 0, 1.5, 90001) + weld_at(56, 10, 0, 1.5, 90002) + weld_at(90, 2, 0, 1.5, 90003);
  EXPECT_THAT(checked(three).findings, IsEmpty());
  const WeldChecks near_edge = checked(three, {5, 0});
  ASSERT_EQ(kinds(near_edge), "near-edge ");
  EXPECT_THAT(near_edge.findings[0].words, HasSubstr("beam:90003 is "));
  EXPECT_NEAR(std::stod(near_edge.findings[0].words.substr(std::string("beam:90003 is ").size())), std::hypot(2, 0.75), 1e-3);
  const WeldChecks near_weld = checked(three, {0, 8});
  ASSERT_EQ(kinds(near_weld), "near-weld near-weld ");
  EXPECT_EQ(near_weld.findings[0].words, "beam:90001 is 6 from beam:90002");
  EXPECT_THAT(checked(three, {0, 6}).findings, IsEmpty()) << "as far as asked";
}

TEST_F(WeldChecking, a_contact_that_leaves_a_sheet_out_is_told) {
  // It ties part 90 to part 1 only.
  const std::string tie =
      "*PART\nspot welds\n        90        90        90\n*SECTION_BEAM\n        90         9\n       6.0       6.0\n"
      "*SET_PART_LIST\n        91\n         1\n*SET_PART_LIST\n        92\n        90\n"
      "*CONTACT_SPOTWELD\n        92        91         2         2\n\n\n\n";
  const WeldChecks checks = checked(weld_at(50, 10, 0, 1.5) + tie);
  ASSERT_EQ(kinds(checks), "not-tied ");
  EXPECT_EQ(checks.findings[0].words, "beam:90001: no contact ties it to part:2");
}

TEST_F(WeldChecking, welds_of_the_edit_are_good) {
  Document document = open_deck(folder_ / "welds.k", flange_deck(3, kOneWeld));
  must_apply(document, R"({"edit": "weld", "flange": {"at": 1010}, "pitch": 20, "like": "beam:90001"})");
  const WeldChecks checks = check_welds(document, {0, 10});
  EXPECT_GT(checks.welds, 5U);
  for (const WeldFinding& finding : checks.findings) ADD_FAILURE() << finding.words;
}

TEST_F(WeldChecking, of_real_decks) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  // A script that reads the text alone finds 78 springs between flanges of the bumper beam, none loose.
  const Result<Document> document = open(*decks / "bumper_beam_rad" / "Bumper_Beam_AP_meshed_0000.rad", {});
  ASSERT_TRUE(document) << document.error().text();
  const WeldChecks checks = check_welds(*document, {});
  EXPECT_GE(checks.welds, 78U);
  for (const WeldFinding& finding : checks.findings) EXPECT_NE(finding.kind, "loose-end") << finding.words;
}

// --- repairing them ---

class WeldMending : public WeldChecking {
 protected:
  Document document(const std::string& welds, int sheets = 2) { return open_deck(folder_ / "welds.k", flange_deck(sheets, welds)); }
  static std::vector<double> heights(const Document& document) {
    const Model& model = document.current().model;
    const ElementBlock& beams = *model.elements[static_cast<std::size_t>(ElementClass::beam)];
    std::vector<double> all;
    for (const NodeIndex node : beams.nodes) all.push_back(model.position(node).z());
    return all;
  }
};

const std::string kMend = R"({"edit": "repair_welds"})";

TEST_F(WeldMending, puts_a_loose_end_back_onto_the_next_sheet) {
  Document deck = document(weld_at(50, 10, 0, 9.5) + weld_at(70, 10, 0, 1.5, 90002));
  const EditReport report = must_apply(deck, kMend);
  EXPECT_THAT(check_welds(deck, {}).findings, IsEmpty());
  EXPECT_THAT(heights(deck), testing::ElementsAre(0, testing::DoubleNear(1.5, 1e-12), 0, 1.5));
  EXPECT_EQ(report.nodes_moved, 1U) << "a good weld stays";
  ASSERT_TRUE(report.welds_mended);
  EXPECT_EQ(report.welds_mended->broken, 1U);
  EXPECT_EQ(report.welds_mended->mended, 1U);
  EXPECT_THAT(report.notes, testing::Contains("mended 1 of 1 weld that had a loose end or joined nothing"));
  must_apply(deck, R"({"edit": "undo"})");
  EXPECT_THAT(heights(deck), testing::ElementsAre(0, 9.5, 0, 1.5));
  EXPECT_THAT(must_apply(deck, R"({"edit": "repair_welds", "at": ["beam:90002"]})").notes,
              testing::Contains("no weld has a loose end or joins nothing"));
}

TEST_F(WeldMending, seats_a_weld_that_hangs_above_both_sheets) {
  Document deck = document(weld_at(50, 10, 4, 6));
  must_apply(deck, kMend);
  EXPECT_THAT(heights(deck), testing::ElementsAre(testing::DoubleNear(0, 1e-12), testing::DoubleNear(1.5, 1e-12)));
}

TEST_F(WeldMending, gives_a_weld_within_a_sheet_its_second_one) {
  char text[256];
  std::snprintf(text, sizeof text,
                "*NODE\n%8d%16.6f%16.6f%16.6f\n%8d%16.6f%16.6f%16.6f\n*ELEMENT_BEAM\n%8d      90%8d%8d       0       0       0       0     "
                "  0       2\n",
                70001, 40.0, 10.0, 0.0, 70002, 44.0, 10.0, 0.0, 90001, 70001, 70002);
  Document deck = document(text);
  must_apply(deck, kMend);
  EXPECT_THAT(check_welds(deck, {}).findings, IsEmpty());
}

TEST_F(WeldMending, of_a_chain_through_three_sheets_moves_the_loose_end_alone) {
  const std::string chain =
      "*NODE\n   70001            50.0            10.0             0.0\n   70002            50.0            10.0             1.5\n"
      "   70003            50.0            10.0             9.0\n*ELEMENT_BEAM\n   90001      90   70001   70002       0       0       0"
      "       0       0       2\n   90002      90   70002   70003       0       0       0       0       0       2\n";
  Document deck = document(chain, 3);
  EXPECT_EQ(must_apply(deck, kMend).nodes_moved, 1U);
  EXPECT_THAT(heights(deck), testing::ElementsAre(0, 1.5, 1.5, testing::DoubleNear(3, 1e-12)));
}

TEST_F(WeldMending, of_a_chain_that_hangs_above_three_sheets_joins_all_of_them) {
  const std::string chain =
      "*NODE\n   70001            50.0            10.0             9.0\n   70002            50.0            10.0            10.0\n"
      "   70003            50.0            10.0            11.0\n*ELEMENT_BEAM\n   90001      90   70001   70002       0       0       0"
      "       0       0       2\n   90002      90   70002   70003       0       0       0       0       0       2\n";
  Document deck = document(chain, 3);
  EXPECT_EQ(must_apply(deck, kMend).welds_mended->mended, 2U);
  EXPECT_THAT(heights(deck), testing::ElementsAre(0, 1.5, 1.5, 3));
}

TEST_F(WeldMending, turns_no_weld_over) {
  Document down = document(weld_at(50, 10, 7.5, 6));
  must_apply(down, kMend);
  EXPECT_THAT(heights(down), testing::ElementsAre(1.5, 0));
  Document up = document(weld_at(50, 10, 6, 7.5));
  must_apply(up, kMend);
  EXPECT_THAT(heights(up), testing::ElementsAre(0, 1.5));
}

TEST_F(WeldMending, mends_none_whose_ends_lie_far_apart_on_their_sheets) {
  char text[256];
  std::snprintf(text, sizeof text,
                "*NODE\n%8d%16.6f%16.6f%16.6f\n%8d%16.6f%16.6f%16.6f\n*ELEMENT_BEAM\n%8d      90%8d%8d       0       0       0       0     "
                "  0       2\n",
                70001, 15.0, 10.0, 0.0, 70002, 95.0, 10.0, 1.5, 90001, 70001, 70002);
  Document deck = document(text);
  const EditReport report = must_apply(deck, kMend);
  EXPECT_EQ(report.nodes_moved, 0U);
  ASSERT_EQ(report.welds_mended->left.size(), 1U);
  EXPECT_THAT(report.welds_mended->left[0].why, HasSubstr("an end would have to move by 80, farther than "));
}

TEST_F(WeldMending, joins_only_sheets_that_a_contact_ties_it_to) {
  // It ties part 90 to parts 2 and 3; part 1 lies below them.
  const std::string tie =
      "*PART\nspot welds\n        90        90        90\n*SECTION_BEAM\n        90         9\n       6.0       6.0\n"
      "*SET_PART_LIST\n        91\n         2         3\n*SET_PART_LIST\n        92\n        90\n"
      "*CONTACT_SPOTWELD\n        92        91         2         2\n\n\n\n";
  Document deck = document(weld_at(50, 10, -7, -5) + tie, 3);
  must_apply(deck, kMend);
  EXPECT_THAT(heights(deck), testing::ElementsAre(1.5, 3)) << "not on part 1, which is nearest";
}

TEST_F(WeldMending, looks_at_no_hidden_part) {
  Document deck = document(weld_at(50, 10, 7, 9), 2);
  must_apply(deck, R"({"edit": "hide", "on": "2"})");
  EXPECT_EQ(must_apply(deck, kMend).welds_mended->left[0].why, "beam:90001: only a sheet of part:1 is there");
}

TEST_F(WeldMending, says_what_it_leaves_and_why) {
  Document single = document(weld_at(50, 10, 0, 9.5), 1);
  const EditReport report = must_apply(single, kMend);
  ASSERT_EQ(report.welds_mended->left.size(), 1U);
  EXPECT_EQ(report.welds_mended->left[0].why, "beam:90001: only a sheet of part:1 is there");
  EXPECT_EQ(report.nodes_moved, 0U);
  Document far = document(weld_at(50, 10, 0, 9.5));
  EXPECT_EQ(must_apply(far, R"({"edit": "repair_welds", "max_move": 7})").welds_mended->left[0].why,
            "beam:90001: an end would have to move by 8, farther than 7");
  EXPECT_THAT(refusal(far, R"({"edit": "repair_welds", "at": ["beam:7"]})"), HasSubstr("there is no weld beam:7"));
  must_apply(far, R"({"edit": "lock", "on": "part:90"})");
  EXPECT_EQ(must_apply(far, kMend).welds_mended->left[0].why, "beam:90001: part:90 is locked");
}

TEST_F(WeldMending, lets_a_mended_end_follow_its_sheet_also_after_recovery) {
  const std::filesystem::path journal_path = folder_ / "journal";
  Document deck = document(weld_at(50, 10, 0, 9.5));
  const std::string lift = R"({"edit": "translate", "by": [0, 0, 2], "on": "part:2", "grab": 2060})";
  {
    Result<Journal> journal = Journal::create(journal_path, deck);
    ASSERT_TRUE(journal) << journal.error().text();
    Result<Prepared> prepared = prepare(deck, parse_edit(kMend).value());
    ASSERT_TRUE(prepared);
    ASSERT_TRUE(journal->append(deck, parse_edit(kMend).value(), *prepared));
    commit(deck, std::move(*prepared));
  }
  OpenOptions millimetres;
  millimetres.length_unit = LengthUnit::mm;
  Document again = open(folder_ / "welds.k", millimetres).value();
  ASSERT_TRUE(Journal::recover(journal_path, again));
  for (Document* each : {&deck, &again}) {
    must_apply(*each, lift);
    EXPECT_NEAR(heights(*each)[1], 3.5, 0.2) << "it goes along with the upper sheet";
  }
  EXPECT_EQ(heights(deck), heights(again));
}

TEST_F(WeldMending, mends_what_an_edit_tore_off_in_a_real_deck) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  Result<Document> opened = open(*decks / "bumper_beam_rad" / "Bumper_Beam_AP_meshed_0000.rad", {});
  ASSERT_TRUE(opened) << opened.error().text();
  Document deck = std::move(*opened);
  EXPECT_EQ(must_apply(deck, kMend).nodes_moved, 0U);
  const Model& model = deck.current().model;
  const ElementBlock& springs = *model.elements[static_cast<std::size_t>(ElementClass::discrete)];
  const NodeIndex torn = springs.nodes[0];
  const Vec3 was = model.position(torn), other = model.position(springs.nodes[1]);
  const Vec3 off = 8 * (was - other).normalized();
  char edit[256];
  std::snprintf(edit, sizeof edit, R"({"edit": "translate", "by": [%.6f, %.6f, %.6f], "on": "node:%lld"})", off.x(), off.y(), off.z(),
                static_cast<long long>(model.node_ids[torn.value]));
  must_apply(deck, edit);
  EXPECT_EQ(kinds(check_welds(deck, {})), "loose-end ");
  EXPECT_EQ(must_apply(deck, kMend).nodes_moved, 1U);
  EXPECT_THAT(check_welds(deck, {}).findings, IsEmpty());
  EXPECT_LT((deck.current().model.position(torn) - was).norm(), 1.0);
}

}  // namespace
}  // namespace prismesh::mesh::document
