// Welds in Abaqus and Nastran decks: what is written, like what, and what is refused.
#include <cstdio>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/document/abaqus_flange.h"
#include "tests/mesh/document/weld_deck.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;

/// Two sheets of 24 x 4 quads of 5, 1.5 thick, their middles 1.8 apart, of the properties 10 and `upper`; `more`: bulk data behind them.
std::string nastran_flange(const std::string& more = "", int upper = 20) {
  std::string nodes, shells;
  char line[128];
  for (int sheet = 1; sheet <= 2; ++sheet) {
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 24; ++i) {
        std::snprintf(line, sizeof line, "GRID,%d,,%.1f,%.1f,%.1f\n", 1000 * sheet + 1 + i + 25 * j, 5.0 * i, 5.0 * j, 1.8 * (sheet - 1));
        nodes += line;
      }
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 24; ++i) {
        const int corner = 1000 * sheet + 1 + i + 25 * j;
        std::snprintf(line, sizeof line, "CQUAD4,%d,%d,%d,%d,%d,%d\n", 1000 * sheet + 1 + i + 24 * j, sheet == 1 ? 10 : upper, corner,
                      corner + 1, corner + 26, corner + 25);
        shells += line;
      }
  }
  return "SOL 101\nCEND\nBEGIN BULK\n" + nodes + shells + "PSHELL,10,1,1.5,1,,1\nPSHELL,20,1,1.5,1,,1\nMAT1,1,210000.,,0.3,7.85-9\n" +
         more + "ENDDATA\n";
}

class WeldFormats : public ::testing::Test {
 protected:
  WeldFormats() { std::filesystem::create_directories(folder); }
  ~WeldFormats() override { std::filesystem::remove_all(folder); }

  Document deck(const std::string& name, const std::string& text) const { return open_deck(folder / name, text); }
  std::string saved(const Document& document) const {
    const auto report = save(document, folder / "saved.deck");
    EXPECT_TRUE(report) << report.error().text();
    return content_of(folder / "saved.deck");
  }
  static EditReport weld(Document& document, const std::string& json) {
    const Result<EditReport> report = try_apply(document, edit_of(json));
    EXPECT_TRUE(report) << report.error().text();
    return report.value_or(EditReport{});
  }
  static std::string refusal(Document& document, const std::string& json) {
    const std::size_t before = document.generations.size();
    const Result<EditReport> report = try_apply(document, edit_of(json));
    EXPECT_EQ(document.generations.size(), before);
    return report ? "it was applied" : report.error().text();
  }
  /// As read again: welds, each with its ends on both sheets.
  void expect_sound(std::size_t welds) const {
    const Document again = open(folder / "saved.deck", {}).value();
    const auto& block = again.current().model.elements[static_cast<std::size_t>(ElementClass::discrete)];
    ASSERT_TRUE(block);
    ASSERT_EQ(block->size(), welds);
    for (std::size_t e = 0; e < welds; ++e) {
      ASSERT_EQ(block->first_node[e + 1] - block->first_node[e], 2u);
      const Vec3 a = again.current().model.position(block->nodes[block->first_node[e]]);
      const Vec3 b = again.current().model.position(block->nodes[block->first_node[e] + 1]);
      EXPECT_NEAR(std::abs(a.z() - b.z()), 1.8, 1e-9);
      EXPECT_EQ(block->part[e], block->part[0]);
    }
  }

  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("prismesh-weld-formats-" + std::to_string(::getpid()));
};

constexpr const char* kPoints = R"("points": [[20, 10, 0], [60, 10, 0]], )";

std::string weld_at_points(const std::string& more) { return R"({"edit": "weld", )" + std::string(kPoints) + more + "}"; }

TEST_F(WeldFormats, abaqus_decks_get_connectors_that_a_fastener_attaches) {
  Document document = deck("flange.inp", abaqus_flange());
  EXPECT_EQ(weld(document, weld_at_points(R"("diameter": 6)")).welded->welds_added, 2u);
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("*ELEMENT, TYPE=CONN3D2, ELSET=SPOT-WELDS-3\n"));
  EXPECT_THAT(after, HasSubstr("*FASTENER PROPERTY, NAME=SPOT-WELDS-3\n3.\n*CONNECTOR SECTION, ELSET=SPOT-WELDS-3\nBEAM\n"
                               "*SURFACE, NAME=SPOT-WELDS-3-SHEETS, TYPE=ELEMENT\nlower, SPOS\nupper, SPOS\n"
                               "*FASTENER, INTERACTION NAME=SPOT-WELDS-3, PROPERTY=SPOT-WELDS-3, ELSET=SPOT-WELDS-3\n,\n"
                               "SPOT-WELDS-3-SHEETS\n*STEP\n"));
  expect_sound(2);
  weld(document, R"({"edit": "undo"})");
  EXPECT_EQ(saved(document), content_of(folder / "flange.inp"));
}

TEST_F(WeldFormats, abaqus_welds_are_like_a_connector_of_a_fastener_and_of_no_other) {
  const std::string connectors =
      "*NODE\n80001, 5., 10., 0.\n80002, 5., 10., 1.8\n*ELEMENT, TYPE=CONN3D2, ELSET=spots\n  9001,  80001,  80002\n"
      "*CONNECTOR SECTION, ELSET=spots\nBEAM\n";
  const std::string json = weld_at_points(R"("like": "spring:9001")");
  Document loose = deck("loose.inp", abaqus_flange(connectors));
  EXPECT_THAT(refusal(loose, json), HasSubstr("no *FASTENER names its element set"));
  Document document = deck("flange.inp", abaqus_flange(connectors + "*FASTENER PROPERTY, NAME=p\n3.\n"
                                                                    "*FASTENER, INTERACTION NAME=f, PROPERTY=p, ELSET=spots\n,\n"));
  EXPECT_EQ(weld(document, json).welded->welds_added, 2u);
  EXPECT_THAT(saved(document), HasSubstr("  9001,  80001,  80002\n  9002,  80003,  80004\n  9003,  80005,  80006\n"));
  expect_sound(3);
  EXPECT_THAT(refusal(document, weld_at_points(R"("like": "spring:9001", "as": "cweld")")),
              HasSubstr("no welds as \"cweld\" in abaqus decks"));
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[90, 10, 0]], "diameter": 6, "yield_stress": 300})"),
              HasSubstr("\"yield_stress\" has no place"));
}

TEST_F(WeldFormats, nastran_decks_get_welds_that_name_the_properties_of_the_sheets) {
  Document document = deck("flange.bdf", nastran_flange());
  EXPECT_EQ(weld(document, weld_at_points(R"("diameter": 6)")).welded->welds_added, 2u);
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("CWELD          1      21         PARTPAT    2126    2127\n+             10      20\n"
                               "CWELD          2      21         PARTPAT    2128    2129\n+             10      20\n"
                               "MAT1          21210000.0             0.3  7.85-9\nPWELD         21      21     6.0\nENDDATA\n"))
      << after.substr(after.find("CWELD"));
  expect_sound(2);
  weld(document, R"({"edit": "undo"})");
  EXPECT_EQ(saved(document), content_of(folder / "flange.bdf"));
}

TEST_F(WeldFormats, nastran_welds_are_like_an_existing_one_whatever_its_form) {
  // One by elements, in large fields; one at a grid point alone; a fastener.
  const std::string more =
      "GRID,80001,,5.,10.,0.\nGRID,80002,,5.,10.,1.8\nPWELD,31,1,5.\nPFAST,32,5.,,,1.+6,1.+6,1.+6\n"
      "CWELD*              9001              31                          ELEMID*\n*                  80001           80002\n"
      "*                   1026            2026\n*\nCWELD,9002,31,80001,GRIDID,,,QQ\n,1001,1002,1027,1026\n,2001,2002,2027,2026\n"
      "CFAST,9003,32,ELEM,1050,2050,,80001,80002\n";
  Document document = deck("flange.bdf", nastran_flange(more));
  EXPECT_EQ(weld(document, R"({"edit": "weld", "points": [[30, 10, 0]], "like": "spring:9001"})").welded->welds_added, 1u);
  EXPECT_EQ(weld(document, R"({"edit": "weld", "points": [[50, 10, 0]], "like": "spring:9002"})").welded->welds_added, 1u);
  EXPECT_EQ(weld(document, R"({"edit": "weld", "points": [[70, 10, 0]], "like": "spring:9003"})").welded->welds_added, 1u);
  EXPECT_EQ(weld(document, R"({"edit": "weld", "points": [[90, 10, 0]], "like": "spring:9004"})").welded->welds_added, 1u);
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("9004              31                         PARTPAT")) << after.substr(after.find("CWELD"), 600);
  EXPECT_THAT(after, HasSubstr("CWELD,9005,31,,PARTPAT,"));
  EXPECT_THAT(after, HasSubstr(",10,20\n"));
  EXPECT_THAT(after, HasSubstr("CFAST,9006,32,PROP,10,20,,"));
  const Document again = open(folder / "saved.deck", {}).value();
  EXPECT_EQ(again.current().model.elements[static_cast<std::size_t>(ElementClass::discrete)]->size(), 7u);
  EXPECT_THAT(refusal(document, weld_at_points(R"("diameter": 6, "as": "cfast")")), HasSubstr("no welds as \"cfast\" in nastran decks"));
}

TEST_F(WeldFormats, the_nearest_that_can_be_the_example_is_taken) {
  // The bush is nearer to the spot than the weld.
  Document document = deck("flange.bdf", nastran_flange("GRID,80001,,82.,10.,0.\nGRID,80002,,82.,10.,1.8\nGRID,80003,,5.,10.,0.\n"
                                                        "GRID,80004,,5.,10.,1.8\nPBUSH,31,K,1.+6\nCBUSH,9001,31,80001,80002\n"
                                                        "PWELD,32,1,5.\nCWELD,9002,32,,PARTPAT,80003,80004\n,10,20\n"));
  const EditReport report = weld(document, R"({"edit": "weld", "points": [[70, 10, 0]], "like": "nearest"})");
  EXPECT_THAT(report.notes, testing::Contains("like discrete:9002, the nearest of a part that can be the example"));
  EXPECT_THAT(saved(document), HasSubstr("CWELD,9003,32,,PARTPAT,"));
  Document bush = deck("bush.bdf", nastran_flange("GRID,80001,,82.,10.,0.\nGRID,80002,,82.,10.,1.8\nPBUSH,31,K,1.+6\n"
                                                  "CBUSH,9001,31,80001,80002\n"));
  EXPECT_THAT(refusal(bush, R"({"edit": "weld", "points": [[70, 10, 0]], "like": "nearest"})"),
              HasSubstr("no weld of the deck can be the example; the nearest: "));
}

TEST_F(WeldFormats, nastran_welds_need_two_properties_and_known_materials) {
  Document one = deck("one.bdf", nastran_flange("", 10));
  EXPECT_THAT(refusal(one, weld_at_points(R"("diameter": 6)")), HasSubstr("both sheets are of part:10"));
  std::string text = nastran_flange();
  text.replace(text.find("MAT1,1,210000.,,0.3"), 19, "MAT1,1,,,0.3");
  Document unknown = deck("unknown.bdf", text);
  EXPECT_THAT(refusal(unknown, weld_at_points(R"("diameter": 6)")), HasSubstr("\"youngs_modulus\" must give it"));
  EXPECT_EQ(weld(unknown, weld_at_points(R"("diameter": 6, "youngs_modulus": 210000)")).welded->welds_added, 2u);
  Document bush = deck("bush.bdf", nastran_flange("PBUSH,31,K,1.+6\nCBUSH,9001,31,1001,2001\n"));
  EXPECT_THAT(refusal(bush, weld_at_points(R"("like": "spring:9001")")), HasSubstr("it is a CBUSH, no CWELD or CFAST"));
  Document full = deck("full.bdf", nastran_flange("MAT1,99999999,1.,,0.3\n"));
  EXPECT_THAT(refusal(full, weld_at_points(R"("diameter": 6)")), HasSubstr("no number is left for a new property"));
  weld(bush, R"({"edit": "lock", "on": "20"})");
  EXPECT_THAT(refusal(bush, weld_at_points(R"("diameter": 6)")), HasSubstr("part:20 is locked"));
}

TEST_F(WeldFormats, nastran_welds_need_no_repair) {
  Document document = deck("flange.bdf", nastran_flange());
  weld(document, weld_at_points(R"("diameter": 6)"));
  const std::string before = saved(document);
  weld(document, R"({"edit": "repair_welds"})");
  EXPECT_EQ(saved(document), before) << "there is nothing to mend";
}

}  // namespace
}  // namespace prismesh::mesh::document
