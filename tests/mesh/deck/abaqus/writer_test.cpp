// How Abaqus lines are written.
#include "mesh/deck/abaqus/mesh_cards.h"
#include "mesh/deck/abaqus/references.h"
#include "mesh/deck/formats/formats.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

const std::unique_ptr<const CardWriter> kWriter = card_writer(Format::abaqus);

TEST(AbaqusWriter, moves_nodes_in_the_lines_own_style) {
  const auto moved = [](const char* line, const Vec3& from, const Vec3& to) { return kWriter->move_node({line, 0, 0}, from, to).text; };
  EXPECT_EQ(moved("1,2.,3.,4.\n5,", {2, 3, 4}, {2, 3.5, 4}), "1,2.,3.5,4.");
  EXPECT_EQ(moved("1, 2., 3., 4.\r\n", {2, 3, 4}, {2, 3, -4}), "1, 2., 3., -4.0");
  EXPECT_EQ(moved("       1, -7.45058e-09,  1.00000e+00,  0.00000e+00 ", {-7.45058e-09, 1, 0}, {0, 1, 0.25}),
            "       1,          0.0,  1.00000e+00,         0.25 ");
  EXPECT_EQ(moved("1", {0, 0, 0}, {0, 0, 7}), "1,,,7.0");
  EXPECT_EQ(moved("1, 5.,", {5, 0, 0}, {5, 1, 0}), "1, 5.,1.0");
  EXPECT_EQ(moved("21,  7.5e-01,  1.0e+00,  ,0.0e+00", {0.75, 1, 0}, {0.75, 1, 3}), "21,  7.5e-01,  1.0e+00, 3.0,0.0e+00");
  EXPECT_TRUE(kWriter->move_node({"1,<a>,0,0", 0, 0}, {1, 0, 0}, {2, 0, 0}).by_parameter);
  const WrittenCard long_number = kWriter->move_node({"1,0,0,0", 0, 0}, {0, 0, 0}, {-1.2345678901234567e-30, 0, 0});
  EXPECT_EQ(long_number.rounded, 1);
  EXPECT_LE(long_number.text.size(), std::string("1,,0,0").size() + 20);
}

TEST(AbaqusWriter, makes_nodes_after_an_example) {
  EXPECT_EQ(kWriter->new_node({"      12,  1.50000e+00,  0.0, 2., 0., 0., 1.\n", 0, 0}, 1234, {1, 2, 3}).text,
            "    1234,          1.0,  2.0, 3.0");
  EXPECT_EQ(kWriter->new_node({"7,1.,2.", 0, 0}, 8, {1, 2, 3}).text, "8,1.0,2.0,3.0");
}

TEST(AbaqusWriter, writes_shells_across_lines) {
  ShellCard card;
  card.id = 100;
  card.nodes = {1, 2, 30, 4};
  const char text[] = "  10,   1,   2,\r\n** here\r\n   3,   4\r\n11,";
  EXPECT_EQ(kWriter->shell({text, 0, 4}, card)->text, " 100,   1,   2,\r\n** here\r\n  30,   4");
  EXPECT_EQ(kWriter->shell_end({text, 0, 4}), std::string(text).find("\r\n11"));
  card.nodes = {1, 2, 3, 3};
  EXPECT_FALSE(kWriter->shell({text, 0, 4}, card));
  EXPECT_EQ(kWriter->shell({"5,1,2,4", 0, 3}, card)->text, "100,1,2,3");
  card.nodes = {1, 2, 3, 4};
  EXPECT_FALSE(kWriter->shell({"5,1,2,4", 0, 3}, card));
  EXPECT_FALSE(kWriter->shell({"5,1,2,3,4,5,6,7,8", 0, 4 | abaqus::kStyleMidside}, card));
  EXPECT_FALSE(kWriter->shell({text, 0, 4 | abaqus::kStyleShifted}, card));
}

std::string joined(const std::string& text, std::uint16_t style, std::vector<std::int64_t> ids) {
  Referrer set;
  set.offset = 0;
  set.end = std::min(text.find("*STEP"), text.size());
  set.style = style;
  const auto replaced = kWriter->join(text, set, ids);
  if (!replaced) return replaced.error().message;
  std::string out = text;
  for (const Replacement& r : *replaced) out.replace(r.offset, r.length, r.text);
  return out;
}

TEST(AbaqusWriter, adds_to_sets) {
  EXPECT_EQ(joined("*NSET,NSET=a\n  1, 2\n  3\n** end\n*STEP\n", 0, {7, 8}), "*NSET,NSET=a\n  1, 2\n  3\n  7, 8\n** end\n*STEP\n");
  EXPECT_EQ(joined("*NSET,NSET=a\r\n1,2\r\n*STEP\r\n", 0, {7, 8}), "*NSET,NSET=a\r\n1,2\r\n7,8\r\n*STEP\r\n");
  EXPECT_EQ(joined("*NSET,NSET=a\n1,2", 0, {7}), "*NSET,NSET=a\n1,2\n7");
  EXPECT_EQ(joined("*NSET,\nNSET=a\n*STEP", 0, {7}), "*NSET,\nNSET=a\n7\n*STEP");
  EXPECT_EQ(joined("*NSET,NSET=a,GENERATE\n1,9,1\n", abaqus::kStyleGenerate, {20, 22}), "*NSET,NSET=a,GENERATE\n1,9,1\n20,20,1\n22,22,1\n");
  const std::string many = joined("*NSET,NSET=a\n1,2\n", 0, std::vector<std::int64_t>(17, 5));
  EXPECT_EQ(std::count(many.begin(), many.end(), '\n'), 4);
  EXPECT_NE(joined("*NSET,NSET=a\n1\n", abaqus::kStyleOtherIds, {7}).find("numbers"), std::string::npos);
}

TEST(AbaqusWriter, refuses_what_a_card_or_its_keyword_cant_hold) {
  ShellCard card;
  card.id = 7;
  card.nodes = {1, 2, 3, 4};
  const std::string cut_off = "*ELEMENT, TYPE=S4\n5,1,2\n*NODE\n";
  EXPECT_EQ(kWriter->shell({cut_off, 18, 4}, card).error().message, "has a card that can't be read");
  EXPECT_EQ(kWriter->shell_in_block({cut_off, 18, 4}, card).error().message, "has a card that can't be read");
  EXPECT_EQ(kWriter->shell_in_block({"5,1,2,3,4,5,6,7,8", 0, 4 | abaqus::kStyleMidside}, card).error().message,
            "has mid-side nodes, which would be missing from a changed or new one");
  EXPECT_EQ(kWriter->shell_in_block({"5,1,2,3,4", 0, 4 | abaqus::kStyleShifted}, card).error().message,
            "belongs to an instance whose numbers are shown changed, or to a part with several");
  const auto block = [](const std::string& text, bool triangles) {
    const auto found = card_writer(Format::abaqus)->block_of_kind({text, text.find('\n') + 1, 4}, triangles);
    return found ? found->header : found.error().message;
  };
  EXPECT_EQ(block("\n1,1,2,3,4\n", true), "has no keyword above it in its file");
  EXPECT_EQ(block("*NODE\n1,1,2,3,4\n", true), "has no keyword above it in its file");
  EXPECT_EQ(block("*ELEMENT, TYPE=S4, INPUT=a.inp\n1,1,2,3,4\n", true), "has no keyword above it in its file");
  EXPECT_EQ(block("*ELEMENT, ELSET=E\n1,1,2,3,4\n", true), "has a keyword that names no type");
  EXPECT_EQ(block("*ELEMENT, ELSET=E, TYPE\n1,1,2,3,4\n", true), "has a keyword that names no type");
  EXPECT_EQ(block("*ELEMENT, TYPE=S4R5\n1,1,2,3,4\n", true), "is of a type that has no other with three corners");
  EXPECT_EQ(block("*ELEMENT, TYPE=S4R5\n1,1,2,3,4\n", false), "is of a type that has no other with four corners");
  const std::pair<const char*, const char*> pairs[] = {{"S4R", "S3R"},    {"S4", "S3"},     {"S4RS", "S3RS"},  {"M3D4R", "M3D3"},
                                                       {"M3D4", "M3D3"},  {"R3D4", "R3D3"}, {"CPS4R", "CPS3"}, {"CPS4", "CPS3"},
                                                       {"CPE4R", "CPE3"}, {"CPE4", "CPE3"}, {"DS4", "DS3"}};
  for (const auto& [quad, triangle] : pairs)
    EXPECT_EQ(block(std::string("*ELEMENT, TYPE=") + quad + ", ELSET=E\n1,1,2,3,4\n", true),
              std::string("*ELEMENT, TYPE=") + triangle + ", ELSET=E");
  EXPECT_EQ(block("*ELEMENT, TYPE=S3\n1,1,2,3\n", false), "*ELEMENT, TYPE=S4");
  EXPECT_EQ(joined("*BOUNDARY\n1,1\n", abaqus::kStyleNamesAndIds, {7}), "isn't a set that lists what it has");
}

TEST(AbaqusWriter, writes_shells_for_a_block_of_the_other_kind) {
  ShellCard card;
  card.id = 100;
  card.nodes = {1, 2, 30, 30};
  EXPECT_EQ(kWriter->shell_in_block({"  10,   1,   2,\n   3,   4\n", 0, 4}, card)->text, " 100,   1,   2,  30");
  card.nodes = {1, 2, 30, 4};
  EXPECT_EQ(kWriter->shell_in_block({"10,5,6,7", 0, 3}, card)->text, "100,1,2,30, 4");
}

}  // namespace
}  // namespace prismesh::mesh::deck
