// Saving into fields too narrow for what was meant: the note says how the shells are judged when the deck is read again.
#include <array>
#include <cstdio>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/deck/save.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

constexpr int kFarColumns = 4, kFarRows = 3;

/// Quads of 5 mm a kilometre from the origin, where eight columns hold hundredths of a millimetre.
std::string far_sheet() {
  std::string nodes, shells;
  std::array<char, 96> line{};
  const auto id = [](int i, int j) { return 1 + i + j * (kFarColumns + 1); };
  for (int j = 0; j <= kFarRows; ++j)
    for (int i = 0; i <= kFarColumns; ++i) {
      std::snprintf(line.data(), line.size(), "GRID    %8d        %8.2f%8.2f     0.0\n", id(i, j), -1050.0 + 5 * i, -1050.0 + 5 * j);
      nodes += line.data();
    }
  for (int j = 0; j < kFarRows; ++j)
    for (int i = 0; i < kFarColumns; ++i) {
      std::snprintf(line.data(), line.size(), "CQUAD4  %8d       7%8d%8d%8d%8d\n", 1 + i + j * kFarColumns, id(i, j), id(i + 1, j),
                    id(i + 1, j + 1), id(i, j + 1));
      shells += line.data();
    }
  return "SOL 101\nCEND\nBEGIN BULK\n" + nodes + shells +
         "PSHELL         7       1     1.5\nMAT1           1  2.1+5             0.3 7.85-9\nENDDATA\n";
}

Document open_far(const std::filesystem::path& path) {
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 5.0;
  return open(path, options).value();
}

std::string shift(double by) { return R"({"edit":"translate","on":"7","by":[)" + std::to_string(by) + ",0,0]}"; }

/// How far node 7 may go along its row before the first shell warns.
double first_warning(const Document& document) {
  double fine = 0, warns = 4;
  for (int step = 0; step < 20; ++step) {
    Document tried = document;
    must_apply(tried, shift(0.5 * (fine + warns)));
    (tried.current().counts.warn == 0 ? fine : warns) = 0.5 * (fine + warns);
  }
  return warns;
}

TEST(Rounding, says_how_the_shells_are_judged_when_the_deck_is_read_again) {
  const Folder folder;
  put_content(folder / "far.nas", far_sheet());
  const Document opened = open_far(folder / "far.nas");
  ASSERT_EQ(opened.current().counts.warn, 0u);
  const double limit = first_warning(opened);
  int differed = 0, agreed = 0;
  for (int i = -12; i <= 12; ++i) {
    Document document = opened;
    must_apply(document, shift(limit + 0.001 * i));
    const Result<deck::SaveReport> saved = save(document, folder / "out.nas");
    ASSERT_TRUE(saved) << saved.error().text();
    const quality::Counts meant = document.current().counts, read = open_far(folder / "out.nas").current().counts;
    const std::string said =
        std::to_string(read.warn) + (read.warn == 1 ? " element" : " elements") + " warn and " + std::to_string(read.fail) + " fail";
    if (read == meant) {
      ++agreed;
      EXPECT_THAT(saved->notes, Each(Not(HasSubstr("as the deck is read again"))));
    } else {
      ++differed;
      EXPECT_THAT(saved->notes, Contains(HasSubstr("as the deck is read again, " + said)));
    }
  }
  EXPECT_GT(differed, 0);
  EXPECT_GT(agreed, 0);
}

}  // namespace
}  // namespace prismesh::mesh::document
