// What a repair reports of the triangles that it had to make.
#include <cstdio>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A flat plate of 16 x 16 quads of 10 mm as an LS-DYNA deck; node (i, j) has id 1 + i + 17 j.
std::string plate_deck() {
  std::string text = "*KEYWORD\n*NODE\n";
  char line[128];
  for (int j = 0; j <= 16; ++j)
    for (int i = 0; i <= 16; ++i) {
      std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", 1 + i + 17 * j, 10.0 * i, 10.0 * j, 0.0);
      text += line;
    }
  text += "*ELEMENT_SHELL\n";
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) {
      const int corner = 1 + i + 17 * j;
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1 + i + 16 * j, 1, corner, corner + 1, corner + 18, corner + 17);
      text += line;
    }
  return text +
         "*PART\nplate\n         1         1         1\n*SECTION_SHELL\n         1         2\n       1.0       1.0       1.0       1.0\n"
         "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n*END\n";
}

Document open_plate(const std::filesystem::path& path) {
  put_content(path, plate_deck());
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 10.0;
  return open(path, options).value();
}

std::string lift_of(int node) {
  return R"({"edit":"translate","by":[0,0,6],"on":")" + std::to_string(node) + R"(","falloff":{"profile":"constant"}})";
}

TEST(RepairReport, counts_the_pairs_of_triangles_that_stay) {
  const Folder folder;
  Document document = open_plate(folder / "plate.k");
  must_apply(document, lift_of(1 + 8 + 17 * 8));
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  EXPECT_EQ(report.before.fail, 4u);
  EXPECT_EQ(report.after.fail, 0u);
  EXPECT_EQ(report.after.warn, 0u);
  EXPECT_EQ(report.elements_added, 4u);
  EXPECT_EQ(report.triangle_pairs, 4u);
  EXPECT_THAT(report.notes, Contains(HasSubstr("4 pairs of adjacent triangles stay")));
}

TEST(RepairReport, counts_fewer_at_a_free_edge) {
  const Folder folder;
  Document document = open_plate(folder / "plate.k");
  must_apply(document, lift_of(1 + 8));
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  EXPECT_EQ(report.before.fail, 2u);
  EXPECT_EQ(report.after.fail, 0u);
  EXPECT_GT(report.triangle_pairs, 0u);
  EXPECT_LE(report.triangle_pairs, 3u);
}

TEST(RepairReport, names_no_pairs_where_none_was_made) {
  const Folder folder;
  Document document = open_plate(folder / "plate.k");
  must_apply(document, R"({"edit":"translate","by":[4,4,0],"on":"145","falloff":{"profile":"constant"}})");
  const EditReport report = must_apply(document, R"({"edit":"repair","scope":"all"})");
  EXPECT_EQ(report.triangle_pairs, 0u);
  EXPECT_THAT(report.notes, Not(Contains(HasSubstr("adjacent triangles"))));
}

}  // namespace
}  // namespace prismesh::mesh::document
