// New nodes and elements never get a number that the deck uses in another way: scalar points, boxes, what cards generate, files that aren't
// read.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/format_decks.h"

namespace prismesh::mesh::document {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The numbers of the nodes and elements that an edit adds to a sheet of 6 x 3 quads (nodes 1-28, shells 1-18), whose right half is pulled
/// away so that a column of shells must be divided.
struct NewIds {
  std::vector<std::int64_t> nodes, shells;
  std::vector<std::string> notes;
};

struct NewIdsCase {
  const char* name;
  std::size_t format;                       ///< in kDeckNames
  std::string more;                         ///< cards
  std::vector<std::int64_t> nodes, shells;  ///< the first that are expected
};

NewIds new_ids(const Folder& folder, std::size_t format, const std::string& more) {
  const std::filesystem::path path = folder / kDeckNames[format];
  put_content(path, deck_text(format, written_sheet(6, 3), more));
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 10.0;  // of all parts
  Result<Document> document = open(path, options);
  if (!document) {
    ADD_FAILURE() << document.error().text();
    return {};
  }
  must_apply(*document, R"({"edit":"translate","by":[45,0,0],"on":"node:4-7,11-14,18-21,25-28","falloff":{"profile":"constant"}})");
  NewIds out{{}, {}, must_apply(*document, R"({"edit":"repair","scope":"all"})").notes};
  const Model& model = document->current().model;
  for (std::size_t n = document->opened->model.node_count(); n < model.node_count(); ++n)
    if (!model.is_removed(NodeIndex(n))) out.nodes.push_back(model.node_ids[n]);
  for (std::size_t s = document->opened->model.shell_count(); s < model.shell_count(); ++s)
    if (!model.is_removed(ShellIndex(s))) out.shells.push_back(model.shell_ids[s]);
  std::sort(out.nodes.begin(), out.nodes.end());
  std::sort(out.shells.begin(), out.shells.end());
  EXPECT_GE(out.nodes.size(), 4u);
  EXPECT_GE(out.shells.size(), 3u);
  return out;
}

constexpr std::size_t kDyna = 0, kNastran = 1, kRadioss = 2, kAbaqus = 3;
constexpr const char* kBeamNodes = "*NODE\n101, 0., 0., 50.\n102, 10., 0., 50.\n*ELEMENT, TYPE=B31, ELSET=B\n19, 101, 102\n";

std::vector<NewIdsCase> new_ids_cases() {
  return {
      {"nothing else", kNastran, "", {29}, {19}},
      // Nastran: points without coordinates
      {"SPOINT", kNastran, "SPOINT  29      30      31\n", {32}, {19}},
      {"SPOINT THRU", kNastran, "SPOINT  30      THRU    40\n", {29, 41}, {19}},
      {"SPOINT, several ranges as OptiStruct has them", kNastran, "SPOINT,29,THRU,33,35,36,THRU,40\n", {34, 41}, {19}},
      {"EPOINT", kNastran, "EPOINT  29      THRU    32\n", {33}, {19}},
      {"points that a CELAS4 makes", kNastran, "CELAS4  101     100.    29      30\n", {31}, {19}},
      {"points that a CMASS3 makes", kNastran, "CMASS3  101     9       29\n", {30}, {19}},
      // Nastran: boxes
      {"CAERO1", kNastran, "CAERO1  29      1       0       3       2                       1\n", {41}, {19}},
      {"CAERO1 by AEFACT",
       kNastran,
       "CAERO1  29      1       0                       7       8       1\nAEFACT  7       0.      .5      1.\nAEFACT  8       0.      "
       "1.\n",
       {41},
       {19}},
      {"CAERO2", kNastran, "CAERO2  29      1       0       4       2                       1\n", {44}, {19}},
      {"CAERO4", kNastran, "CAERO4  29      1       0       4\n", {39}, {19}},
      {"boxes take the elements' numbers", kNastran, "CAERO5  19      1       0       4\n", {29}, {29}},
      {"THRU in an entry that isn't known", kNastran, "MYCARD  29      THRU    33\n", {34}, {19}},
      {"a node that is named and not defined", kNastran, "CQUAD4  30      1       29      30      31      32\n", {33}, {19}},
      // Abaqus: generators
      {"NGEN", kAbaqus, "*NGEN, NSET=X\n28, 31, 1\n", {32}, {19}},
      {"NGEN backwards", kAbaqus, "*NGEN\n40, 30, -1\n", {29, 41}, {19}},
      {"NFILL", kAbaqus, "*NFILL\nA, B, 4, 5\n", {49}, {19}},
      {"NCOPY", kAbaqus, "*NCOPY, CHANGE NUMBER=20, OLD SET=N, SHIFT\n0., 0., 8.\n0., 0., 0., 0., 0., 1., 0.\n", {49}, {19}},
      {"NCOPY of what NGEN made", kAbaqus, "*NGEN\n22, 40, 1\n*NCOPY, CHANGE NUMBER=100, OLD SET=N, SHIFT\n0., 0., 8.\n", {41, 42}, {19}},
      {"ELGEN in a row", kAbaqus, std::string(kBeamNodes) + "*ELGEN, ELSET=B\n19, 5, 2, 1\n", {103}, {24}},
      {"ELGEN with defaults", kAbaqus, std::string(kBeamNodes) + "*ELGEN, ELSET=B\n19, 4\n", {103}, {23}},
      {"ELGEN in layers", kAbaqus, std::string(kBeamNodes) + "*ELGEN, ELSET=B\n19, 2, 2, 1, 2, 10, 4, 2, 100, 10\n", {103}, {35}},
      {"ELCOPY", kAbaqus, "*ELCOPY, ELEMENT SHIFT=10, OLD SET=P, SHIFT NODES=100\n", {29}, {29}},
      {"faces of cohesive elements", kAbaqus, "*ELEMENT, TYPE=COH3D8, OFFSET=8\n30, 1, 2, 9, 8\n", {45}, {19}},
      // LS-DYNA
      {"a structured mesh",
       kDyna,
       "*ALE_STRUCTURED_MESH\n         1         8        29        19\n        11        12        12\n"
       "*ALE_STRUCTURED_MESH_CONTROL_POINTS\n        11\n         1                 0.0\n         4                 8.0\n"
       "*ALE_STRUCTURED_MESH_CONTROL_POINTS\n        12\n         1                 0.0\n         2                 8.0\n",
       {45},
       {35}},
      {"a blank", kDyna, "*CONTROL_FORMING_BLANKMESH\n\n         3        29        19\n", {}, {}},
      {"a part's copy", kDyna, "*PART_DUPLICATE\nPART               1        10        20        30\n", {29, 59}, {19, 39}},
      // Radioss
      {"a reserve of particles", kRadioss, "/SPH/RESERVE/1\n       100\n", {29}, {19}},
  };
}

TEST(NewIdsOfEdits, are_not_those_of_what_the_model_doesnt_show) {
  const Folder folder;
  for (const NewIdsCase& c : new_ids_cases()) {
    if (c.nodes.empty()) continue;
    SCOPED_TRACE(c.name);
    const NewIds ids = new_ids(folder, c.format, c.more);
    for (std::size_t i = 0; i < c.nodes.size(); ++i) EXPECT_EQ(ids.nodes.at(i), c.nodes[i]);
    for (std::size_t i = 0; i < c.shells.size(); ++i) EXPECT_EQ(ids.shells.at(i), c.shells[i]);
    EXPECT_THAT(ids.notes, testing::Not(testing::Contains(HasSubstr("include file"))));
  }
}

TEST(NewIdsOfEdits, are_refused_where_what_is_generated_takes_all_that_are_left) {
  const Folder folder;
  const std::filesystem::path path = folder / kDeckNames[kDyna];
  put_content(path, deck_text(kDyna, written_sheet(6, 3), "*CONTROL_FORMING_BLANKMESH\n\n         3        29        19\n"));
  Document document = open(path, OpenOptions{}).value();
  EXPECT_THAT(refusal(document, R"({"edit":"split","at":["shell:9"]})"), HasSubstr("no id is left"));
}

TEST(NewIdsOfEdits, keep_off_the_numbers_of_files_that_arent_read) {
  const Folder folder;
  put_content(
      folder / "extra.k",
      "*KEYWORD\n*NODE\n      29             0.0             0.0             0.0\n"
      "      31             0.0             0.0             0.0\n*ELEMENT_SHELL\n      19       7      29      31      31      31\n*END\n");
  const NewIds radioss = new_ids(folder, kRadioss, "/INCLUDE_LS-DYNA\nextra.k\n");
  EXPECT_EQ(radioss.nodes.front(), 30);
  EXPECT_EQ(radioss.nodes.at(1), 32);
  EXPECT_EQ(radioss.shells.front(), 20);
  put_content(folder / "extra.bdf", "GRID,29\nGRID,30\nCQUAD4,19,1,29,30,30,30\n");
  const NewIds dyna = new_ids(folder, kDyna, "*INCLUDE_NASTRAN\nextra.bdf\n         1         1         1\n");
  EXPECT_EQ(dyna.nodes.front(), 31);
  EXPECT_EQ(dyna.shells.front(), 20);
}

TEST(NewIdsOfEdits, are_told_to_be_unsure_where_an_include_is_missing) {
  const Folder folder;
  EXPECT_THAT(
      new_ids(folder, kDyna, "*INCLUDE\nlost.k\n").notes,
      testing::Contains(HasSubstr("the include file lost.k isn't there; the new nodes and elements may have numbers that it uses")));
}

}  // namespace
}  // namespace prismesh::mesh::document
