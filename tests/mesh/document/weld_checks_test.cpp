// Checks of welds: each finding on a deck made for it, and none on a good one.
#include "mesh/document/weld_checks.h"

#include <cmath>

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace prismesh::mesh::document
