// How what is odd about a deck is put together: which lines of which file are named.
#include "mesh/deck/assembly/warnings.h"

#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

TEST(WarningPlaces, are_lines_of_their_own_file) {
  const DeckFolder folder;
  folder.write("rest.k", "$ rest 1\n*NODE\n$ rest 3\n2,1.,0.,0.\n$ rest 5\n");
  const auto opened = folder.open("*KEYWORD\n$ deck 2\n*NODE\n1,0.,0.,0.\n$ deck 5\n*INCLUDE\nrest.k\n*END\n");
  ASSERT_OPENED(opened);
  const std::vector<SourceFile>& files = opened->deck->files;
  ASSERT_EQ(files.size(), 2u);
  const auto offset = [&](std::size_t file, std::string_view comment) { return files[file].bytes.text().find(comment); };
  Warnings warnings;
  warnings.note("over both", 1, offset(1, "$ rest 3"), "odd");
  warnings.note("over both", 0, offset(0, "$ deck 5"), "unsaid");
  warnings.note("over both", 1, offset(1, "$ rest 5"), "unsaid");
  warnings.note("over both", 0, offset(0, "$ deck 2"), "unsaid");
  warnings.note_each("each", 0, offset(0, "$ deck 5"), "first");
  warnings.note_each("each", 1, offset(1, "$ rest 1"), "second");
  warnings.note_each("each", 1, files[1].bytes.text().size(), "at the end");
  const std::vector<Warning> told = warnings.finish(files);
  struct Told {
    const char* file;
    long line;
    const char* message;
  };
  const Told wanted[] = {{"rest.k", 3, "odd; also at deck.k:5, line 5 and 1 more"},
                         {"deck.k", 5, "first"},
                         {"rest.k", 1, "second"},
                         {"rest.k", 6, "at the end"}};
  ASSERT_EQ(told.size(), std::size(wanted));
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].file, (folder / wanted[i].file).string());
    EXPECT_EQ(told[i].line, wanted[i].line) << told[i].message;
    EXPECT_EQ(told[i].message, wanted[i].message);
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
