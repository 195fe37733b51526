#include "mesh/report/line_diff.h"

#include <string>

#include <gtest/gtest.h>

namespace prismesh::mesh::report {
namespace {

TEST(LineDiff, changed_added_and_removed_lines) {
  struct Case {
    const char *a, *b;
    std::size_t lines;
  };
  const Case cases[] = {
      {"", "", 0},
      {"a\nb\nc\n", "a\nb\nc\n", 0},
      {"a\nb\nc\n", "a\nX\nc\n", 1},
      {"a\nb\nc\n", "a\nc\n", 1},
      {"a\nc\n", "a\nb\nc\n", 1},
      {"a\nb\nc\nd\ne\n", "new\na\nX\nc\nd\ne\n", 2},
      {"x\nx\nx\ny\n", "x\nx\ny\n", 1},
      {"a\nb\n", "c\nd\ne\n", 3},
      {"a\nb", "a\nb\n", 1},
      {"a\r\n", "a\n", 1},
      {"", "a\nb\n", 2},
      {"1\n2\n3\n4\n5\n6\n", "4\n5\n6\n1\n2\n3\n", 6},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(lines_changed(one.a, one.b), one.lines) << one.a << "against\n" << one.b;
    EXPECT_EQ(lines_changed(one.b, one.a), one.lines);
  }
}

TEST(LineDiff, a_large_text_with_scattered_changes) {
  std::string a, b = "first\n";
  for (int i = 0; i < 200000; ++i) {
    a += std::to_string(i) + "\n";
    b += i % 1000 == 500 ? "changed\n" : std::to_string(i) + "\n";
  }
  EXPECT_EQ(lines_changed(a, b), 201u);
}

}  // namespace
}  // namespace prismesh::mesh::report
