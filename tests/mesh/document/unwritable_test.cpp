// Repairs where the deck can't hold some of what would help: that is left as it is and named, the rest is repaired all the same.
#include <algorithm>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/model/growth.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int kColumns = 14, kRows = 8, kOddColumns = 7;

int node_at(int i, int j) { return 1 + i + j * (kColumns + 1); }

/// A sheet of quads of 5 mm. Those of the left half have thicknesses at some corners only, so what they are divided into can't be written.
std::string half_odd_sheet() {
  std::string nodes, odd, plain;
  char line[128];
  for (int j = 0; j <= kRows; ++j)
    for (int i = 0; i <= kColumns; ++i) {
      std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", node_at(i, j), 5.0 * i, 5.0 * j, 0.0);
      nodes += line;
    }
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i) {
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1 + i + j * kColumns, 1, node_at(i, j), node_at(i + 1, j),
                    node_at(i + 1, j + 1), node_at(i, j + 1));
      (i < kOddColumns ? odd : plain) += line;
      if (i < kOddColumns) odd += "             1.5             0.0             0.0             1.2\n";
    }
  return "*KEYWORD\n*NODE\n" + nodes + "*ELEMENT_SHELL_THICKNESS\n" + odd + "*ELEMENT_SHELL\n" + plain +
         "*PART\npanel\n         1         1         1\n*SECTION_SHELL\n         1         2\n       1.5       1.5       1.5       1.5\n"
         "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n*END\n";
}

Document open_half_odd(const std::filesystem::path& path) {
  put_content(path, half_odd_sheet());
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 5.0;
  return open(path, options).value();
}

/// A node pulled out of the sheet: the quads about it are warped, which dividing them cures.
std::string dent(int node) { return R"({"edit":"translate","by":[1,1,4],"on":")" + std::to_string(node) + R"("})"; }

TEST(Unwritable, RepairsElsewhereAndNamesWhatItLeft) {
  const Folder folder;
  Document document = open_half_odd(folder / "a.k");
  must_apply(document, dent(node_at(3, 4)));
  must_apply(document, dent(node_at(11, 4)));
  const Model before = document.current().model;
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  EXPECT_LT(report.after.fail, report.before.fail);
  EXPECT_GT(report.after.fail, 0u) << "the left dent stays";
  EXPECT_GT(report.elements_added, 0u);
  EXPECT_THAT(report.notes, Contains(HasSubstr("left as they are, since the deck can't be written otherwise")));
  const Model& model = document.current().model;
  for (std::size_t s = 0; s < before.shell_count(); ++s) {
    if (static_cast<int>(s) % kColumns >= kOddColumns) continue;
    EXPECT_FALSE(model.is_removed(ShellIndex(s)));
  }
  ASSERT_TRUE(model.growth);
  for (std::size_t s = model.growth->deck_shells; s < model.shell_count(); ++s) {
    const ShellIndex parent = model.growth->shell_parents[s - model.growth->deck_shells];
    EXPECT_GE((model.shell_ids[parent.value] - 1) % kColumns, kOddColumns) << "a piece of what can't be divided";
  }
  const Result<deck::SaveReport> saved = save(document, folder / "b.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->shells_added, report.elements_added);
}

TEST(Unwritable, WhatCannotBeWrittenAnywhereIsLeftAndNothingIsDone) {
  const Folder folder;
  Document document = open_half_odd(folder / "a.k");
  must_apply(document, dent(node_at(3, 4)));
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  EXPECT_EQ(report.elements_added, 0u);
  EXPECT_EQ(report.elements_removed, 0u);
  EXPECT_LE(report.after.fail, report.before.fail);
  EXPECT_THAT(report.notes, Contains(HasSubstr("can't be changed: ")));
  const Result<deck::SaveReport> saved = save(document, folder / "b.k");
  EXPECT_TRUE(saved) << saved.error().text();
}

}  // namespace
}  // namespace prismesh::mesh::document
