// Cards of elements that the model leaves out are counted apart, in every format; ids that occur twice are warned of.
#include "mesh/deck/open.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

struct LeftOutCase {
  const char* name;
  std::string text;
  ElementCounts cards;     ///< all
  ElementCounts left_out;  ///< of these
  std::size_t undefined = 0;
  std::size_t incomplete = 0;
  std::size_t duplicate = 0;
  std::size_t duplicate_nodes = 0;
};

std::string fields(std::initializer_list<int> values, int width) {
  std::string line;
  for (const int value : values) {
    const std::string text = std::to_string(value);
    line += std::string(static_cast<std::size_t>(width) - text.size(), ' ') + text;
  }
  return line + "\n";
}

// Each: a quad and a triangle with all nodes; a quad, a triangle and a beam with an undefined node 9; a shell without enough nodes; a quad
// whose id is there already; node 4 twice.
std::vector<LeftOutCase> cases() {
  const auto k = [](std::initializer_list<int> v) { return fields(v, 8); };
  const auto r = [](std::initializer_list<int> v) { return fields(v, 10); };
  const auto node_k = [](int id, const char* x, const char* y) {
    return fields({id}, 8).substr(0, 8) + std::string(13, ' ') + x + std::string(13, ' ') + y + "             0.0\n";
  };
  const auto node_r = [](int id, const char* x, const char* y) {
    return fields({id}, 10).substr(0, 10) + std::string(17, ' ') + x + std::string(17, ' ') + y + "                 0.0\n";
  };
  const std::string lsdyna = "*NODE\n" + node_k(1, "0.0", "0.0") + node_k(2, "1.0", "0.0") + node_k(3, "1.0", "1.0") +
                             node_k(4, "0.0", "1.0") + node_k(4, "5.0", "5.0") + "*ELEMENT_SHELL\n" + k({1, 1, 1, 2, 3, 4}) +
                             k({2, 1, 1, 2, 3, 3}) + k({3, 1, 1, 2, 3, 9}) + k({4, 1, 1, 2, 9, 9}) + k({5, 1, 1, 2}) +
                             k({1, 1, 2, 3, 4, 1}) + "*ELEMENT_BEAM\n" + k({7, 2, 1, 9}) + k({8, 2, 1, 2}) + "*END\n";
  const std::string nastran =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,4,,5.,5.,0.\nCQUAD4,1,1,1,2,3,4\nCTRIA3,2,1,1,2,3\n"
      "CQUAD4,3,1,1,2,3,9\nCTRIA3,4,1,1,2,9\nCQUAD4,5,1,1,2\nCQUAD4,1,1,2,3,4,1\nCROD,7,2,1,9\nCROD,8,2,1,2\n";
  const std::string radioss =
      "#RADIOSS STARTER\n/BEGIN\nx\n      2022         0\n                  kg                  mm                  ms\n"
      "                  kg                  mm                  ms\n/NODE\n" +
      node_r(1, "0.0", "0.0") + node_r(2, "1.0", "0.0") + node_r(3, "1.0", "1.0") + node_r(4, "0.0", "1.0") + node_r(4, "5.0", "5.0") +
      "/SHELL/1\n" + r({1, 1, 2, 3, 4}) + r({3, 1, 2, 3, 9}) + r({5, 1, 2}) + r({1, 2, 3, 4, 1}) + "/SH3N/1\n" + r({2, 1, 2, 3}) +
      r({4, 1, 2, 9}) + "/TRUSS/2\n" + r({7, 1, 9}) + r({8, 1, 2}) + "/END\n";
  const std::string abaqus =
      "*HEADING\nx\n*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,1.,1.,0.\n4,0.,1.,0.\n4,5.,5.,0.\n*ELEMENT,TYPE=S4,ELSET=P\n1,1,2,3,4\n3,1,2,3,9\n5,1,"
      "2\n"
      "1,2,3,4,1\n*ELEMENT,TYPE=S3,ELSET=P\n2,1,2,3\n4,1,2,9\n*ELEMENT,TYPE=B31,ELSET=B\n7,1,9\n8,1,2\n";
  const ElementCounts cards{4, 2, 0, 0, 2, 0, 0, 0}, left_out{3, 1, 0, 0, 1, 0, 0, 0};
  return {{"a.k", lsdyna, cards, left_out, 3, 1, 1, 1},
          {"a.bdf", nastran, cards, left_out, 3, 1, 1, 1},
          {"a_0000.rad", radioss, cards, left_out, 3, 1, 1, 1},
          {"a.inp", abaqus, cards, left_out, 3, 1, 1, 1}};
}

auto counts_of(const ElementCounts& c) { return std::array{c.quad, c.tri, c.quad8, c.tri6, c.beam, c.solid, c.tshell, c.other}; }

TEST(LeftOut, elements_are_counted_apart_in_every_format) {
  const DeckFolder folder;
  for (const LeftOutCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto opened = deck::open(folder.write(c.name, c.text));
    ASSERT_OPENED(opened);
    const Deck& deck = *opened->deck;
    EXPECT_EQ(counts_of(deck.element_cards), counts_of(c.cards));
    EXPECT_EQ(counts_of(deck.left_out_cards), counts_of(c.left_out));
    EXPECT_EQ(deck.element_cards.without(deck.left_out_cards).shells(), opened->model.shell_count());
    EXPECT_EQ(warning(deck, "undefined-node").count, c.undefined);
    EXPECT_EQ(warning(deck, "incomplete-element").count, c.incomplete);
  }
}

TEST(LeftOut, what_is_defined_again_is_warned_of_once_by_kind) {
  const DeckFolder folder;
  for (const LeftOutCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto opened = deck::open(folder.write(c.name, c.text));
    ASSERT_OPENED(opened);
    const Warning elements = warning(*opened->deck, "duplicate-element"), nodes = warning(*opened->deck, "duplicate-node");
    EXPECT_EQ(elements.count, c.duplicate);
    EXPECT_EQ(nodes.count, c.duplicate_nodes);
    EXPECT_NE(elements.message.find(" 1 is defined again; its first definition counts"), std::string::npos) << elements.message;
    EXPECT_EQ(nodes.message, "node 4 is defined again; its first definition counts");
    EXPECT_GT(nodes.line, 0);
    EXPECT_EQ(position_of(opened->model, 4), Vec3(0, 1, 0));
    EXPECT_EQ(corners_of(opened->model, 1), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  }
}

TEST(LeftOut, counts_dont_go_below_zero) {
  const ElementCounts few{1, 0, 0, 0, 0, 2, 0, 0}, more{3, 1, 0, 0, 0, 1, 0, 0};
  EXPECT_EQ(counts_of(few.without(more)), (std::array<std::size_t, 8>{0, 0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(more.all(), 5u);
}

}  // namespace
}  // namespace prismesh::mesh::deck
