// What is told about a deck as a whole: each kind once, with its first places and how many more.
#include "mesh/deck/findings.h"

#include "mesh/deck/editing/unread_numbers.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

constexpr const char* kMesh =
    "*KEYWORD\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n"
    "*PART\nsheet\n1,1,1\n*ELEMENT_SHELL\n1,1,1,2,3,4\n";

Warning found(const std::string& cards, std::string_view kind) {
  const DeckFolder folder;
  const auto opened = folder.open(kMesh + cards + "*END\n");
  EXPECT_TRUE(opened);
  return opened ? warning(*opened->deck, kind) : Warning{};
}

TEST(Findings, say_nothing_of_a_whole_deck) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string(kMesh) + "*SET_NODE_LIST\n1\n1,2,3\n*BOUNDARY_SPC_SET\n1\n*END\n");
  ASSERT_OPENED(opened);
  for (const Warning& w : opened->deck->warnings) ADD_FAILURE() << w.kind << ": " << w.message;
}

TEST(Findings, count_what_cards_name_though_nobody_defines_it) {
  const Warning nodes = found("*SET_NODE_LIST\n5\n1,2,3,4,5,6\n77\n78\n80\n90\n", "names-undefined-node");
  EXPECT_EQ(nodes.count, 6u);
  EXPECT_EQ(nodes.line, 14);
  EXPECT_NE(nodes.message.find("*SET_NODE_LIST 5 names node 5, which isn't defined; also at line 15, line 17"), std::string::npos)
      << nodes.message;
  EXPECT_NE(nodes.message.find("more"), std::string::npos) << nodes.message;
  EXPECT_EQ(found("*SET_SHELL\n5\n1,2\n", "names-undefined-shell").count, 1u);
  EXPECT_EQ(found("*SET_SOLID\n5\n1\n", "names-undefined-solid").count, 1u);
  EXPECT_EQ(found("*CONSTRAINED_RIGID_BODIES\n1,9\n", "names-undefined-part").count, 1u);
  EXPECT_EQ(found("*CONSTRAINED_NODAL_RIGID_BODY\n9,0,1\n*SET_NODE\n1\n1\n*CONSTRAINED_RIGID_BODIES\n1,9\n", "names-undefined-part").count,
            0u);
  const Warning set = found("*BOUNDARY_SPC_SET\n9\n*SET_SHELL\n9\n1\n", "names-undefined-set");
  EXPECT_EQ(set.count, 1u);
  EXPECT_NE(set.message.find("*BOUNDARY_SPC_SET names node set 9, which isn't defined"), std::string::npos) << set.message;
}

TEST(Findings, tell_ranges_with_nothing_in_them) {
  EXPECT_EQ(found("*SET_NODE_LIST_GENERATE\n5\n3,100,200,999999999999999999\n", "empty-range").count, 1u);
  EXPECT_EQ(found("*SET_NODE_LIST_GENERATE\n5\n3,999999999999999999\n", "empty-range").count, 0u);
}

TEST(Findings, tell_parts_and_nodes_that_nothing_uses) {
  const Warning part = found("*PART\nlone\n7,1,1\n", "unused-part");
  EXPECT_EQ(part.count, 1u);
  EXPECT_EQ(part.line, 13);
  EXPECT_NE(part.message.find("part 7"), std::string::npos);
  EXPECT_EQ(found("*PART\nlone\n7,1,1\n*SET_PART_LIST\n1\n7\n", "unused-part").count, 0u);
  const Warning node = found("*NODE\n8,0,0,0\n9,0,0,0\n10,0,0,0\n11,0,0,0\n12,0,0,0\n*SET_NODE_LIST_GENERATE\n1\n9,10\n", "unused-node");
  EXPECT_EQ(node.count, 3u);
  EXPECT_EQ(node.line, 13);
  EXPECT_NE(node.message.find("node 8"), std::string::npos);
  EXPECT_NE(node.message.find("also at line 16, line 17"), std::string::npos) << node.message;
}

TEST(Findings, tell_parts_of_elements_that_nobody_defines) {
  const Warning part = found("*ELEMENT_SHELL\n2,5,1,2,3,4\n", "undefined-part");
  EXPECT_EQ(part.count, 1u);
  EXPECT_EQ(part.line, 13);
}

TEST(Findings, list_the_keywords_that_are_not_understood) {
  const Warning unread = found("*FOO\n1\n*BAR\n1\n*FOO\n2\n", "unread-card");
  EXPECT_EQ(unread.count, 3u);
  EXPECT_EQ(unread.line, 12);
  EXPECT_NE(unread.message.find("*BAR, *FOO:"), std::string::npos) << unread.message;
}

TEST(Findings, say_where_doubles_are) {
  const Warning nodes = found("*NODE\n1,5,5,5\n2,5,5,5\n3,5,5,5\n4,5,5,5\n", "duplicate-node");
  EXPECT_EQ(nodes.count, 4u);
  EXPECT_EQ(nodes.line, 13);
  EXPECT_NE(nodes.message.find("; also at line 14, line 15 and 1 more"), std::string::npos) << nodes.message;
}

TEST(WholeNumbers, are_found_however_columns_are_cut) {
  std::vector<std::int64_t> numbers;
  gather_whole_numbers("DX(12,3)+&a\n1234567800000009  -5 7. 0.5\n", numbers);
  for (const std::int64_t wanted : {12, 3, 12345678, 9, 5, 7})
    EXPECT_NE(std::find(numbers.begin(), numbers.end(), wanted), numbers.end()) << wanted;
}

}  // namespace
}  // namespace prismesh::mesh::deck
