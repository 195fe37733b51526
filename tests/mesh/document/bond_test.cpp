// Bonds that an edit makes: where their hexahedra are, what they are like, what is refused.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/connections/bond_strip.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/journal.h"
#include "tests/mesh/document/abaqus_flange.h"
#include "tests/mesh/document/weld_deck.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;

constexpr const char* kAdhesive = R"("density": 1.2e-9, "youngs_modulus": 2000, "poissons_ratio": 0.4)";

/// The edit's JSON on the flange between parts 1 and 2.
std::string bond_json(const std::string& shape, const std::string& like = kAdhesive) {
  return R"({"edit": "bond", "flange": {"between": "1,2"}, )" + shape + ", " + like + "}";
}

/// Sheets of 1.5 as parts 1 and on, at this distance: the gap is 1.5 less.
std::string gapped_deck(double distance, int sheets = 2, const std::string& more = "") {
  std::string nodes, shells;
  for (int sheet = 0; sheet < sheets; ++sheet) add_sheet(1 + sheet, distance * sheet, nodes, shells);
  return "*KEYWORD\n*NODE\n" + nodes + "*ELEMENT_SHELL\n" + shells + kPartsOfSheets + more + "*END\n";
}

/// A hexahedron of part 90 at the flange's corner, tied by a contact; its nodes stand on a line of their own.
const std::string kOneBond =
    "*NODE\n   80001             1.0             6.0            0.75\n   80002             3.0             6.0            0.75\n"
    "   80003             3.0             7.0            0.75\n   80004             1.0             7.0            0.75\n"
    "   80005             1.0             6.0            1.05\n   80006             3.0             6.0            1.05\n"
    "   80007             3.0             7.0            1.05\n   80008             1.0             7.0            1.05\n"
    "*ELEMENT_SOLID\n   90001      90\n   80001   80002   80003   80004   80005   80006   80007   80008\n"
    "*PART\nadhesive\n        90        90        90\n*SECTION_SOLID\n        90         1\n"
    "*MAT_ELASTIC\n        90   1.2E-09    2000.0       0.4\n*SET_PART_LIST\n        91\n         1         2\n"
    "*SET_NODE_LIST\n        92\n     80001     80002     80003     80004     80005     80006     80007     80008\n"
    "*CONTACT_TIED_NODES_TO_SURFACE_OFFSET\n        92        91         4         2\n\n\n";

class BondEdit : public ::testing::Test {
 protected:
  BondEdit() { std::filesystem::create_directories(folder); }
  ~BondEdit() override { std::filesystem::remove_all(folder); }

  Document deck(double distance = 1.8, int sheets = 2, const std::string& more = "") const {
    return open_deck(folder / "flange.k", gapped_deck(distance, sheets, more));
  }
  std::string saved(const Document& document) const {
    const auto report = save(document, folder / "saved.k");
    EXPECT_TRUE(report) << report.error().text();
    return content_of(folder / "saved.k");
  }
  static EditReport bond(Document& document, const std::string& json) {
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
  static const ElementBlock& solids(const Document& document) {
    static const ElementBlock none;
    const auto& block = document.current().model.elements[static_cast<std::size_t>(ElementClass::solid)];
    return block ? *block : none;
  }
  static std::array<Vec3, 8> corners(const Document& document, std::size_t solid) {
    std::array<Vec3, 8> at;
    for (std::size_t c = 0; c < 8; ++c) at[c] = document.current().model.position(solids(document).nodes[8 * solid + c]);
    return at;
  }

  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("prismesh-bond-" + std::to_string(::getpid()));
};

TEST_F(BondEdit, fills_the_gap_between_the_sheets_faces_along_the_middle_of_the_flange) {
  Document document = deck();
  const EditReport report = bond(document, bond_json(R"("width": 10, "length": 8)"));
  ASSERT_TRUE(report.bonded);
  EXPECT_EQ(report.bonded->solids_added, 15u);
  EXPECT_EQ(report.bonded->solids_left, 0u);
  EXPECT_NEAR(report.bonded->thinnest, 0.3, 1e-9);
  ASSERT_EQ(solids(document).size(), 15u);
  double volume = 0;
  std::set<NodeIndex> nodes(solids(document).nodes.begin(), solids(document).nodes.end());
  EXPECT_EQ(nodes.size(), 64u) << "neighbours share their nodes";
  for (std::size_t e = 0; e < 15; ++e) {
    const std::array<Vec3, 8> at = corners(document, e);
    EXPECT_GT(connections::least_corner_volume(at), 0);
    volume += (at[1] - at[0]).cross(at[3] - at[0]).dot(at[4] - at[0]);  // they are boxes here
    const double low = at[0].z(), high = at[4].z();
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_NEAR(at[c].z(), low, 1e-9);
      EXPECT_NEAR(at[c + 4].z(), high, 1e-9);
      EXPECT_NEAR(std::abs(at[c].y() - 10), 5, 1e-9);
    }
    EXPECT_NEAR(std::min(low, high), 0.75, 1e-9);
    EXPECT_NEAR(std::max(low, high), 1.05, 1e-9);
  }
  EXPECT_NEAR(volume, 120 * 10 * 0.3, 1e-6);
}

TEST_F(BondEdit, goes_from_middle_surface_to_middle_surface_where_it_is_told_to) {
  Document document = deck(1.5);
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)")), HasSubstr("there is no room between the sheets' faces"));
  const EditReport report = bond(document, bond_json(R"("width": 10, "length": 8, "from": "middles", "end_distance": 20)"));
  EXPECT_EQ(report.bonded->solids_added, 10u);
  EXPECT_NEAR(report.bonded->thinnest, 1.5, 1e-9);
  for (std::size_t e = 0; e < 10; ++e)
    for (const Vec3& at : corners(document, e)) {
      EXPECT_TRUE(std::abs(at.z()) < 1e-9 || std::abs(at.z() - 1.5) < 1e-9) << at.z();
      EXPECT_GE(at.x(), 20 - 1e-9);
      EXPECT_LE(at.x(), 100 + 1e-9);
    }
}

TEST_F(BondEdit, makes_part_section_material_set_and_contact) {
  Document document = deck();
  const std::string before = content_of(folder / "flange.k");
  bond(document, bond_json(R"("width": 10, "length": 8)"));
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("*PART\nadhesive\n         4         4         4\n"));
  EXPECT_THAT(after, HasSubstr("*SECTION_SOLID\n         4        -1\n"));
  EXPECT_THAT(after, HasSubstr("*MAT_ELASTIC\n         4    1.2E-9    2000.0       0.4\n"));
  EXPECT_THAT(after, HasSubstr("*SET_PART_LIST\n         4\n         1         2\n"));
  EXPECT_THAT(after, HasSubstr("*CONTACT_TIED_NODES_TO_SURFACE_OFFSET\n         4         4         3         2\n\n\n"));
  const Document again = open(folder / "saved.k", {}).value();
  EXPECT_EQ(solids(again).size(), 15u);
  for (std::size_t e = 0; e < 15; ++e) EXPECT_GT(connections::least_corner_volume(corners(again, e)), 0);
  bond(document, R"({"edit": "undo"})");
  EXPECT_EQ(saved(document), before);
}

TEST_F(BondEdit, is_written_like_an_existing_solid_whose_sets_its_nodes_join) {
  Document document = deck(1.8, 2, kOneBond);
  const EditReport report = bond(document, bond_json(R"("width": 10, "length": 30)", R"("like": "solid:90001")"));
  EXPECT_EQ(report.bonded->solids_added, 4u);
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("   80001   80002   80003   80004   80005   80006   80007   80008\n   90002      90\n   8"));
  EXPECT_EQ(after.find("*MAT_ELASTIC", after.find("*MAT_ELASTIC\n        90") + 1), std::string::npos) << "no material is added";
  const Document again = open(folder / "saved.k", {}).value();
  ASSERT_EQ(solids(again).size(), 5u);
  for (std::size_t e = 0; e < 5; ++e) EXPECT_EQ(solids(again).part[e], solids(again).part[0]);
  // the new nodes are in the set that ties the existing one's
  std::istringstream rest(after.substr(after.find("*SET_NODE_LIST\n        92\n")));
  std::string line;
  std::getline(rest, line), std::getline(rest, line);
  std::set<std::int64_t> in_set;
  while (std::getline(rest, line) && line[0] != '*') {
    std::istringstream fields(line);
    for (std::int64_t id = 0; fields >> id;) in_set.insert(id);
  }
  for (const NodeIndex node : solids(again).nodes) EXPECT_EQ(in_set.count(again.current().model.node_ids[node.value]), 1u);
}

TEST_F(BondEdit, leaves_out_hexahedra_where_solids_are_already) {
  Document document = deck();
  bond(document, bond_json(R"("width": 10, "length": 8)"));
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)")),
              HasSubstr("none of 15 solids can be made: a solid is there already"));
}

TEST_F(BondEdit, is_brought_back_undone_and_redone) {
  Document document = deck(1.8, 2, kOneBond);
  const std::string before = content_of(folder / "flange.k");
  const std::filesystem::path path = folder / "session.journal";
  {
    Result<Journal> journal = Journal::create(path, document);
    ASSERT_TRUE(journal);
    for (const std::string& json : {bond_json(R"("width": 4, "length": 8, "end_distance": 40)"),
                                    bond_json(R"("width": 14, "length": 30)", R"("like": "solid:90001")")}) {
      Result<Prepared> prepared = prepare(document, edit_of(json));
      ASSERT_TRUE(prepared) << json << prepared.error().text();
      ASSERT_TRUE(journal->append(document, edit_of(json), *prepared));
      commit(document, std::move(*prepared));
    }
  }
  Document again = open(folder / "flange.k", {}).value();
  ASSERT_TRUE(Journal::recover(path, again));
  const std::string wanted = saved(document);
  EXPECT_NE(wanted, before);
  EXPECT_EQ(saved(again), wanted);
  for (int step = 0; step < 2; ++step) bond(again, R"({"edit": "undo"})");
  EXPECT_EQ(saved(again), before);
  for (int step = 0; step < 2; ++step) bond(again, R"({"edit": "redo"})");
  EXPECT_EQ(saved(again), wanted);
}

TEST_F(BondEdit, refuses_what_does_not_fit_the_flange) {
  Document document = deck();
  EXPECT_THAT(refusal(document, bond_json(R"("width": 25, "length": 8)")), HasSubstr("the width, 25, is larger than the flange's, 20"));
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 130)")),
              HasSubstr("the length, 130, is larger than the flange's, 120"));
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8, "end_distance": 60)")), HasSubstr("the end distance, 60"));
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 1e-5)")), HasSubstr("over a million"));
  Document apart = deck(30);
  EXPECT_THAT(refusal(apart, bond_json(R"("width": 10, "length": 8)")), HasSubstr("bond: "));
  for (const char* wrong : {R"("width": 10, "length": 0)", R"("width": 0, "length": 8)", R"("width": 10)"})
    EXPECT_FALSE(parse_edit(bond_json(wrong))) << wrong;
}

TEST_F(BondEdit, refuses_three_sheets_locked_parts_and_missing_values) {
  Document three = deck(1.8, 3);
  EXPECT_THAT(refusal(three, bond_json(R"("width": 10, "length": 8)")), HasSubstr("the flange has 3 sheets"));
  Document document = deck(1.8, 2, kOneBond);
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)", R"("density": 1e-9, "youngs_modulus": 2000)")),
              HasSubstr("\"poissons_ratio\" is missing"));
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)", R"("like": "solid:90001", "density": 1)")),
              HasSubstr("\"like\" takes the material"));
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)", R"("like": "solid:4")")), HasSubstr("there is no solid 4"));
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)", R"("like": "beam:4")")), HasSubstr("it is no solid"));
  bond(document, R"({"edit": "lock", "on": "2"})");
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)")), HasSubstr("part:2 is locked"));
  bond(document, R"({"edit": "unlock", "on": "2"})");
  bond(document, R"({"edit": "lock", "on": "90"})");
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)", R"("like": "solid:90001")")), HasSubstr("part:90 is locked"));
}

TEST_F(BondEdit, refuses_when_no_number_is_left) {
  Document document = deck(1.8, 2, "*SET_PART_LIST\n  99999999\n         1\n");
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)")), HasSubstr("no number is left for a new part"));
}

TEST_F(BondEdit, follows_a_curved_flange) {
  // The sheets bent about an axis along y: cylinders of radius 100 and 101.8.
  std::string text = gapped_deck(1.8), bent;
  std::istringstream lines(text);
  bool in_nodes = false;
  for (std::string line; std::getline(lines, line); bent += line + "\n") {
    if (line[0] == '*') {
      in_nodes = line == "*NODE";
      continue;
    }
    if (!in_nodes) continue;
    const double x = std::stod(line.substr(8, 16)), y = std::stod(line.substr(24, 16)), z = std::stod(line.substr(40, 16));
    char card[96];
    std::snprintf(card, sizeof card, "%s%16.8f%16.8f%16.8f", line.substr(0, 8).c_str(), (100 + z) * std::sin(x / 100), y,
                  (100 + z) * std::cos(x / 100));
    line = card;
  }
  Document document = open_deck(folder / "flange.k", bent);
  const EditReport report = bond(document, bond_json(R"("width": 10, "length": 8)"));
  EXPECT_GE(report.bonded->solids_added, 13u);
  EXPECT_NEAR(report.bonded->thinnest, 0.3, 0.06);
  for (std::size_t e = 0; e < solids(document).size(); ++e) {
    const std::array<Vec3, 8> at = corners(document, e);
    EXPECT_GT(connections::least_corner_volume(at), 0);
    for (const Vec3& corner : at) {
      const double radius = std::hypot(corner.x(), corner.z());
      EXPECT_GT(radius, 100.75 - 0.05);
      EXPECT_LT(radius, 101.05 + 0.05);
    }
  }
}

TEST(BondSolid, has_no_positive_volume_when_folded_or_turned_over) {
  std::array<Vec3, 8> at{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(0, 1, 0),
                         Vec3(0, 0, 3), Vec3(2, 0, 3), Vec3(2, 1, 3), Vec3(0, 1, 3)};
  EXPECT_DOUBLE_EQ(connections::least_corner_volume(at), 6);
  std::swap(at[1], at[3]), std::swap(at[5], at[7]);
  EXPECT_LT(connections::least_corner_volume(at), 0);
  std::swap(at[1], at[3]), std::swap(at[5], at[7]);
  at[6].z() = -1;
  EXPECT_LT(connections::least_corner_volume(at), 0);
}

// --- Abaqus ---

TEST_F(BondEdit, is_tied_in_abaqus_decks_by_a_surface_for_each_sheet) {
  Document document = open_deck(folder / "flange.inp", abaqus_flange());
  const EditReport report = bond(document, bond_json(R"("width": 10, "length": 8)"));
  EXPECT_EQ(report.bonded->solids_added, 15u);
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("*ELEMENT, TYPE=C3D8, ELSET=ADHESIVE-3\n"));
  EXPECT_THAT(after, HasSubstr("*MATERIAL, NAME=ADHESIVE-3\n*DENSITY\n1.2e-09\n*ELASTIC\n2000., 0.4\n"
                               "*SOLID SECTION, ELSET=ADHESIVE-3, MATERIAL=ADHESIVE-3\n"
                               "*SURFACE, NAME=ADHESIVE-3-A, TYPE=ELEMENT\nADHESIVE-3, S1\n"
                               "*SURFACE, NAME=ADHESIVE-3-SHEETS-A, TYPE=ELEMENT\nlower, SPOS\n"
                               "*TIE, NAME=ADHESIVE-3-A, ADJUST=NO, POSITION TOLERANCE=0.9\nADHESIVE-3-A, ADHESIVE-3-SHEETS-A\n"
                               "*SURFACE, NAME=ADHESIVE-3-B, TYPE=ELEMENT\nADHESIVE-3, S2\n"
                               "*SURFACE, NAME=ADHESIVE-3-SHEETS-B, TYPE=ELEMENT\nupper, SNEG\n"
                               "*TIE, NAME=ADHESIVE-3-B, ADJUST=NO, POSITION TOLERANCE=0.9\nADHESIVE-3-B, ADHESIVE-3-SHEETS-B\n"
                               "*STEP\n"));
  const Document again = open(folder / "saved.k", {}).value();
  ASSERT_EQ(solids(again).size(), 15u);
  for (std::size_t e = 0; e < 15; ++e) {
    const std::array<Vec3, 8> at = corners(again, e);
    EXPECT_GT(connections::least_corner_volume(at), 0);
    for (std::size_t c = 0; c < 8; ++c) EXPECT_NEAR(at[c].z(), c < 4 ? 0.75 : 1.05, 1e-9) << "S1 lies on the lower part";
  }
  const Part& part = again.current().model.parts->at(solids(again).part[0].value);
  EXPECT_EQ(part.name, "ADHESIVE-3");
  EXPECT_EQ(part.id, 3);
  EXPECT_EQ(part.density, 1.2e-9);
  bond(document, R"({"edit": "undo"})");
  EXPECT_EQ(saved(document), content_of(folder / "flange.inp"));
}

TEST_F(BondEdit, is_written_like_a_solid_of_an_abaqus_deck_with_its_faces_on_the_same_sheets) {
  // The existing solid stands on its head: its first face lies on the upper sheet.
  Document document = open_deck(folder / "flange.inp", abaqus_flange(kAbaqusBond));
  const EditReport report = bond(document, bond_json(R"("width": 10, "length": 30)", R"("like": "solid:90001")"));
  EXPECT_EQ(report.bonded->solids_added, 4u);
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("   90001,  80005,  80008,  80007,  80006,  80001,  80004,  80003,  80002\n   90002,  8"));
  EXPECT_THAT(after, HasSubstr("*ELSET, ELSET=glued\n90001\n90002, 90003, 90004, 90005\n"));
  const Document again = open(folder / "saved.k", {}).value();
  ASSERT_EQ(solids(again).size(), 5u);
  for (std::size_t e = 0; e < 5; ++e) {
    EXPECT_EQ(solids(again).part[e], solids(again).part[0]);
    EXPECT_GT(connections::least_corner_volume(corners(again, e)), 0);
    EXPECT_NEAR(corners(again, e)[0].z(), 1.05, 1e-9);
  }
  bond(document, R"({"edit": "undo"})");
  EXPECT_EQ(saved(document), content_of(folder / "flange.inp"));
}

TEST_F(BondEdit, refuses_abaqus_decks_where_no_surface_can_hold_it) {
  const std::string json = bond_json(R"("width": 10, "length": 8)");
  Document instances = open_deck(folder / "parts.inp", "*PART, NAME=p\n" + abaqus_flange("", false) +
                                                           "*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=p-1, PART=p\n*END INSTANCE\n"
                                                           "*END ASSEMBLY\n");
  EXPECT_THAT(refusal(instances, json), HasSubstr("the deck is made of parts and instances"));
  put_content(folder / "history.inp", "*STEP\n*STATIC\n*END STEP\n");
  Document history = open_deck(folder / "main.inp", abaqus_flange("", false) + "*INCLUDE, INPUT=history.inp\n");
  EXPECT_THAT(refusal(history, json), HasSubstr("a *STEP stands in an include"));
  // The first shell of the lower sheet has its nodes in the other order.
  std::string text = abaqus_flange();
  const std::string card = "1001, 1001, 1002, 1027, 1026\n";
  ASSERT_NE(text.find(card), std::string::npos);
  for (int shell = 1001; shell < 1001 + 96; ++shell) {
    const std::string start = "\n" + std::to_string(shell) + ", ";
    const std::size_t at = text.find(start, text.find("*ELEMENT"));
    const std::size_t end = text.find('\n', at + 1);
    std::istringstream fields(text.substr(at + 1, end - at - 1));
    std::array<std::string, 5> field;
    for (std::string& each : field) std::getline(fields, each, ',');
    if (shell % 24 < 12) text.replace(at + 1, end - at - 1, field[0] + "," + field[4] + "," + field[3] + "," + field[2] + "," + field[1]);
  }
  Document turned = open_deck(folder / "turned.inp", text);
  EXPECT_THAT(refusal(turned, json), HasSubstr("shells of part:1 face the adhesive with different sides"));
  Document named = open_deck(folder / "flange.inp", abaqus_flange(kAbaqusBond + "*SURFACE, NAME=by_number\n90001, S1\n"));
  EXPECT_THAT(refusal(named, bond_json(R"("width": 10, "length": 30)", R"("like": "solid:90001")")),
              HasSubstr("the surface by_number names it by its number"));
}

TEST_F(BondEdit, other_formats_are_refused_by_name) {
  Document document = open_deck(folder / "flange.bdf",
                                "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,5.,0.,0.\nGRID,3,,5.,5.,0.\nGRID,4,,0.,5.,0.\nCQUAD4,1,1,1,2,3,4\n"
                                "PSHELL,1,1,1.5\nENDDATA\n");
  EXPECT_THAT(refusal(document, bond_json(R"("width": 10, "length": 8)")), HasSubstr("this version makes no bonds in nastran decks"));
}

}  // namespace
}  // namespace prismesh::mesh::document
