// Files that cards name besides includes: they go along when a deck is saved into another folder, and are warned of where they are missing.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

struct CompanionCase {
  const char* name;
  const char* deck;
  std::string text;
  std::vector<std::string> files;  ///< that the text names
};

const char* const kRadiossHead =
    "#RADIOSS STARTER\n/BEGIN\nx\n      2022         0\n                  Mg                  mm                   s\n"
    "                  Mg                  mm                   s\n/NODE\n         1                 0.0                 0.0               "
    "  0.0\n";
const char* const kAbaqusHead = "*NODE\n1, 0., 0., 0.\n";
const char* const kNastranBulk = "CEND\nBEGIN BULK\nGRID,1\nENDDATA\n";
const char* const kDynaNode = "*KEYWORD\n*NODE\n       1             0.0             0.0             0.0\n";

std::vector<CompanionCase> companion_cases() {
  const std::string dyna = kDynaNode, radioss = kRadiossHead, abaqus = kAbaqusHead;
  return {
      {"LS-DYNA, from column 11 on", "a.k", dyna + "*DEFINE_TABLE_MATRIX\n         7tables/m.csv\n*END\n", {"tables/m.csv"}},
      {"LS-DYNA, over two lines", "a.k", dyna + "*INTERFACE_LINKING_FILE\ntables/ +\nlink.bin\n*END\n", {"tables/link.bin"}},
      {"LS-DYNA, on the second card", "a.k", dyna + "*LOAD_THERMAL_BINOUT\n         1\nheat.binout\n*END\n", {"heat.binout"}},
      {"LS-DYNA, behind an id", "a.k", dyna + "*LOAD_SEISMIC_SSI_AUX_ID\n         4motion\nmotion.bin\n*END\n", {"motion.bin"}},
      {"LS-DYNA, an include that isn't read", "a.k", dyna + "*INCLUDE_STAMPED_PART\nblank.dynain\n         1\n*END\n", {"blank.dynain"}},
      {"LS-DYNA, an include with a number first", "a.k", dyna + "*INCLUDE_MULTISCALE\n         1\nlocal.k\n*END\n", {"local.k"}},
      {"Radioss", "a_0000.rad", radioss + "/INISTA\nrun_0003.sty\n         1         0         3\n/END\n", {"run_0003.sty"}},
      {"Radioss, a flexible body", "a_0000.rad", radioss + "/FXBODY/1\nbody\n         1         0\nbody.pch\n/END\n", {"body.pch"}},
      {"Radioss, a map", "a_0000.rad", radioss + "/EIG/1\nmodes\n         1\nmodes.dat\n/END\n", {"modes.dat"}},
      {"Nastran", "a.bdf", std::string("ASSIGN INPUTT2='se/x.op2' UNIT=31\nSOL 101\n") + kNastranBulk, {"se/x.op2"}},
      {"Nastran, over two lines",
       "a.bdf",
       std::string("ASSIGN INPUTT4='se/\n   y.op4',\n UNIT=32\nSOL 101\n") + kNastranBulk,
       {"se/y.op4"}},
      {"OptiStruct", "a.fem", std::string("ASSIGN, H3DDMIG, AX, sub.h3d\nSOL 101\n") + kNastranBulk, {"sub.h3d"}},
      {"Abaqus, results with an ending that is left out", "a.inp", abaqus + "*IMPERFECTION, FILE=buckle, STEP=1\n1, 0.1\n", {"buckle.fil"}},
      {"Abaqus, results", "a.inp", abaqus + "*STEP\n*STATIC\n*TEMPERATURE, FILE=heat.odb, BSTEP=1\n*END STEP\n", {"heat.odb"}},
      {"Abaqus, a table", "a.inp", abaqus + "*AMPLITUDE, NAME=A, INPUT=amp.dat\n", {"amp.dat"}},
      {"Abaqus, a keyword that isn't known", "a.inp", abaqus + "*SOMETHING NEW, INPUT=\"two words.dat\"\n", {"two words.dat"}},
      {"CalculiX", "a.inp", abaqus + "*SUBMODEL, TYPE=NODE, INPUT=global.frd\n1\n", {"global.frd"}},
  };
}

TEST(Companions, are_copied_into_another_folder) {
  for (const CompanionCase& c : companion_cases()) {
    SCOPED_TRACE(c.name);
    const DeckFolder folder;
    for (const std::string& file : c.files) folder.write("from/" + file, "bytes\r\nof " + file);
    const auto opened = deck::open(folder.write(std::string("from/") + c.deck, c.text));
    ASSERT_OPENED(opened);
    EXPECT_EQ(warning(*opened->deck, "missing-file").count, 0u) << warning(*opened->deck, "missing-file").message;
    EXPECT_EQ(warning(*opened->deck, "missing-include").count, 0u) << warning(*opened->deck, "missing-include").message;
    const auto saved = save(*opened->deck, opened->model, opened->model, folder / (std::string("to/") + c.deck));
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(content(folder / (std::string("to/") + c.deck)), c.text);
    for (const std::string& file : c.files) EXPECT_EQ(content(folder / ("to/" + file)), "bytes\r\nof " + file);
    EXPECT_EQ(saved->files_written.size(), 1 + c.files.size());
    EXPECT_EQ(saved->files_written.back(), folder / (std::string("to/") + c.deck)) << "the main file last";
  }
}

TEST(Companions, that_are_missing_are_warned_of_by_name_and_line) {
  for (const CompanionCase& c : companion_cases()) {
    if (std::string(c.name) == "Radioss, a map") continue;  // the block has such a line in one of its forms only
    SCOPED_TRACE(c.name);
    const DeckFolder folder;
    const auto opened = deck::open(folder.write(c.deck, c.text));
    ASSERT_OPENED(opened);
    Warning missing = warning(*opened->deck, "missing-file");
    if (missing.count == 0) missing = warning(*opened->deck, "missing-include");
    EXPECT_EQ(missing.count, 1u);
    EXPECT_THAT(missing.message, HasSubstr(c.files.front().substr(0, c.files.front().find_last_of('.'))));
    EXPECT_THAT(missing.message, HasSubstr("isn't there"));
    EXPECT_GT(missing.line, 0);
  }
}

TEST(Companions, beside_the_deck_stay_where_they_are) {
  const DeckFolder folder;
  folder.write("m.csv", "1,2");
  const auto opened = deck::open(folder.write("a.k", std::string(kDynaNode) + "*DEFINE_TABLE_MATRIX\n         7m.csv\n*END\n"));
  ASSERT_OPENED(opened);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "b.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->files_written.size(), 1u);
}

TEST(Companions, outside_the_main_files_folder_are_refused_by_name) {
  const DeckFolder folder;
  folder.write("m.csv", "1,2");
  const auto opened = deck::open(folder.write("from/a.k", std::string(kDynaNode) + "*DEFINE_TABLE_MATRIX\n         7../m.csv\n*END\n"));
  ASSERT_OPENED(opened);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "to/a.k");
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().text(), HasSubstr("m.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "to/a.k"));
}

TEST(Companions, the_engine_input_goes_with_the_starters) {
  const DeckFolder folder;
  folder.write("from/a_0001.rad", "/RUN/a/1\n 1.0\n");
  folder.write("from/a_0002.rad", "/RUN/a/2\n 2.0\n");
  const auto opened = deck::open(folder.write("from/a_0000.rad", std::string(kRadiossHead) + "/END\n"));
  ASSERT_OPENED(opened);
  ASSERT_TRUE(save(*opened->deck, opened->model, opened->model, folder / "to/a_0000.rad"));
  EXPECT_EQ(content(folder / "to/a_0001.rad"), "/RUN/a/1\n 1.0\n");
  EXPECT_EQ(content(folder / "to/a_0002.rad"), "/RUN/a/2\n 2.0\n");
}

TEST(Companions, the_main_file_cant_take_the_name_of_one) {
  const DeckFolder folder;
  folder.write("from/a_0001.rad", "/RUN/a/1\n 1.0\n");
  const auto opened = deck::open(folder.write("from/a_0000.rad", std::string(kRadiossHead) + "/END\n"));
  ASSERT_OPENED(opened);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "to/a_0001.rad");
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().text(), HasSubstr("is the name of a file that the deck names itself (a_0001.rad)"));
}

TEST(Companions, that_are_includes_as_well_are_copied_once) {
  const DeckFolder folder;
  folder.write("from/more.inp", "*NODE\n2, 1., 0., 0.\n");
  const auto opened =
      deck::open(folder.write("from/a.inp", std::string(kAbaqusHead) + "*IMPERFECTION, FILE=more.inp\n*INCLUDE, INPUT=more.inp\n"));
  ASSERT_OPENED(opened);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "to/a.inp");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->files_written.size(), 2u);
}

TEST(Companions, that_went_after_the_deck_was_opened_are_named_and_nothing_is_written) {
  const DeckFolder folder;
  folder.write("from/m.csv", "1,2");
  const auto opened = deck::open(folder.write("from/a.k", std::string(kDynaNode) + "*DEFINE_TABLE_MATRIX\n         7m.csv\n*END\n"));
  ASSERT_OPENED(opened);
  std::filesystem::remove(folder / "from/m.csv");
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "to/a.k");
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().text(), HasSubstr("m.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "to"));
}

TEST(Companions, a_line_that_may_be_a_name_is_one_only_if_the_file_is_there) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string(kDynaNode) + "*DEFINE_CURVE_TRIM\n         1         1\n       1.0       2.0\n*END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "missing-file").count, 0u);
  EXPECT_TRUE(opened->deck->companions.empty());
}

TEST(Companions, a_deck_whose_mesh_stands_in_files_that_arent_read_says_so) {
  const DeckFolder folder;
  folder.write("mesh.k", kDynaNode);
  folder.write("mesh.bdf", "GRID,1\n");
  const auto radioss =
      deck::open(folder.write("a_0000.rad", "#RADIOSS STARTER\n/BEGIN\nx\n      2022         0\n/INCLUDE_LS-DYNA\nmesh.k\n/END\n"));
  ASSERT_OPENED(radioss);
  EXPECT_THAT(warning(*radioss->deck, "mesh-elsewhere").message, HasSubstr("(mesh.k)"));
  const auto dyna = folder.open("*KEYWORD\n*INCLUDE_NASTRAN\nmesh.bdf\n*END\n");
  ASSERT_OPENED(dyna);
  EXPECT_THAT(warning(*dyna->deck, "mesh-elsewhere").message, HasSubstr("(mesh.bdf)"));
}

// --- data lines in files of their own ---

const char* const kPlate =
    "*NODE\n1, 0., 0., 0.\n2, 10., 0., 0.\n3, 10., 10., 0.\n4, 0., 10., 0.\n*ELEMENT, TYPE=S4, ELSET=P\n1, 1, 2, 3, 4\n";

TEST(DataFiles, name_nodes_and_elements_like_lines_in_the_deck) {
  const DeckFolder folder;
  folder.write("ties.dat", "BEAM, 3, 1\n");
  folder.write("equations.dat", "** terms\n2\n2, 1, 1., 4, 1, -1.\n");
  const auto opened = deck::open(folder.write(
      "a.inp", std::string(kPlate) + "*MPC, INPUT=ties.dat\n*EQUATION, INPUT=equations.dat\n*AMPLITUDE, NAME=A, INPUT=none.dat\n"));
  ASSERT_OPENED(opened);
  const References& references = *opened->deck->references;
  for (const std::int64_t node : {1, 2, 3, 4}) {
    const std::vector<Reference> naming = references.naming(Referred::node, node);
    ASSERT_EQ(naming.size(), 1u) << node;
    EXPECT_EQ(naming[0].role, ReferenceRole::single);
    const Referrer& card = references.referrers()[naming[0].referrer];
    EXPECT_EQ(opened->deck->files[card.file].relative, node == 2 || node == 4 ? "equations.dat" : "ties.dat");
    EXPECT_GE(naming[0].card, card.offset) << "a place in that file";
    EXPECT_LT(naming[0].card, card.end);
  }
  EXPECT_THAT(warning(*opened->deck, "missing-include").message, HasSubstr("none.dat, which *AMPLITUDE takes its data from, isn't there"));
}

TEST(DataFiles, of_keywords_that_arent_known_may_name_anything) {
  const DeckFolder folder;
  folder.write("x.dat", "3, 1\n");
  const auto opened = deck::open(folder.write("a.inp", std::string(kPlate) + "*SOMETHING NEW, INPUT=x.dat\n"));
  ASSERT_OPENED(opened);
  const auto unread = opened->deck->references->unread();
  ASSERT_EQ(unread.size(), 1u);
  EXPECT_EQ(opened->deck->files[unread[0].file].relative, "x.dat");
}

TEST(DataFiles, that_several_keywords_use_are_read_for_each) {
  const DeckFolder folder;
  folder.write("nodes.dat", "3, 1\n");
  const auto opened = deck::open(folder.write("a.inp", std::string(kPlate) + "*BOUNDARY, INPUT=nodes.dat\n*CLOAD, INPUT=nodes.dat\n"));
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->deck->references->naming(Referred::node, 3).size(), 2u);
  EXPECT_EQ(warning(*opened->deck, "repeated-include").count, 0u);
}

// --- properties of one number ---

TEST(PropertyFamilies, a_number_means_the_property_of_the_elements_type) {
  const DeckFolder folder;
  const std::string grids = "GRID,1\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nCQUAD4,1,1,1,2,3,4\n";
  for (const std::string other :
       {"PBAR,1,9,100.,833.,833.,1400.\nCBAR,101,1,1,2,0.,0.,1.\n", "PSOLID,1,9\n", "PBUSH,1,K,100.\nCBUSH,101,1,1,2\n", "PELAS,1,100.\n",
        "PROD,1,9,3.\n", "PBEAML,1,9,,ROD\n,3.\n", "PSHEAR,1,9,7.\n", "PWELD,1,9,5.\n", "PLSOLID,1,9\n", "PGAP,1\n"}) {
    SCOPED_TRACE(other);
    for (const bool first : {true, false}) {
      const std::string shell = "PSHELL,1,8,1.5\n";
      const auto opened = folder.open(grids + (first ? shell + other : other + shell) + "MAT1,8,210000.,,.3,7.85-9\nMAT1,9,1.,,.3,1.\n");
      ASSERT_OPENED(opened);
      ASSERT_EQ(opened->model.parts->size(), 1u);
      const Part& part = opened->model.parts->front();
      EXPECT_EQ(part.thickness, 1.5);
      EXPECT_EQ(part.density, 7.85e-9);
      EXPECT_EQ(warning(*opened->deck, "duplicate-property").count, 0u) << warning(*opened->deck, "duplicate-property").message;
    }
  }
  const auto twice = folder.open(grids + "PSHELL,1,8,1.5\nPCOMP,1\n,8,2.5,0.\nMAT1,8,210000.,,.3,7.85-9\n");
  ASSERT_OPENED(twice);
  EXPECT_EQ(warning(*twice->deck, "duplicate-property").count, 1u);
  EXPECT_EQ(twice->model.parts->front().thickness, 1.5);
}

TEST(PropertyFamilies, companion_cards_are_no_properties) {
  const DeckFolder folder;
  for (const std::string pair : {"PBUSH,5,K,100.\nPBUSHT,5,K,9\n", "PELAS,5,100.\nPELAST,5,9\n", "PDAMP,5,1.\nPDAMPT,5,9\n",
                                 "PSOLID,5,1\nPSLDN1,5,1\n", "PBAR,5,1,1.\nPBARN1,5,1\n"}) {
    const auto opened = folder.open("GRID,1\n" + pair);
    ASSERT_OPENED(opened);
    EXPECT_EQ(warning(*opened->deck, "duplicate-property").count, 0u) << pair;
    EXPECT_EQ(warning(*opened->deck, "unread-card").count, 0u) << pair;
    EXPECT_EQ(opened->model.parts->size(), 1u) << pair;
  }
}

TEST(LawsWithoutDensity, give_no_density_and_no_warning) {
  const DeckFolder folder;
  const auto radioss = deck::open(folder.write(
      "a_0000.rad", std::string(kRadiossHead) +
                        "/PART/1\np\n         1         3\n/MAT/LAW20/3\ntwo\n         1         2\n                 0.0\n/END\n"));
  ASSERT_OPENED(radioss);
  EXPECT_EQ(warning(*radioss->deck, "bad-card").count, 0u) << warning(*radioss->deck, "bad-card").message;
  EXPECT_FALSE(radioss->model.parts->front().density);
}

}  // namespace
}  // namespace prismesh::mesh::deck
