// The writer of keyword decks by itself: text in, text out, in each layout of columns. What it writes is written down here.
#include "mesh/deck/lsdyna/writer.h"
#include "mesh/deck/open.h"

#include "mesh/deck/formats/formats.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

using lsdyna::Columns;
using Numbers = std::vector<std::int64_t>;

const auto kKeywordWriter = lsdyna::card_writer();
constexpr std::array<std::array<double, 4>, 4> kSameCorners{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

std::uint16_t style_of(Columns columns) { return static_cast<std::uint16_t>(columns); }

/// Fields that lean right, `width` columns each.
std::string fields(std::size_t width, std::initializer_list<std::string> texts) {
  std::string line;
  for (const std::string& text : texts) line += std::string(width - text.size(), ' ') + text;
  return line;
}

// --- nodes ----------------------------------------------------------------------------------------------------------

struct NewNodeCase {
  const char* what;
  Columns columns;
  std::string example;
  std::int64_t id;
  std::string free, constrained;  ///< the new node's card at (0.5, -1, 0.25)
  std::string constraints;
};

TEST(KeywordWriter, writes_new_nodes_in_the_manner_of_their_neighbour) {
  const NewNodeCase cases[] = {
      {"standard", Columns::standard, "       1             4.0             5.0             6.0       7       3", 12345678,
       "12345678             0.5            -1.0            0.25       0       0",
       "12345678             0.5            -1.0            0.25       7       3", "7,3"},
      {"i10", Columns::i10, "         1             4.0             5.0             6.0         7         3", 1234567890,
       "1234567890             0.5            -1.0            0.25         0         0",
       "1234567890             0.5            -1.0            0.25         7         3", "7,3"},
      {"wide", Columns::wide, fields(20, {"1", "4.0", "5.0", "6.0", "7", "3"}), 123456789012345678,
       fields(20, {"123456789012345678", "0.5", "-1.0", "0.25", "0", "0"}),
       fields(20, {"123456789012345678", "0.5", "-1.0", "0.25", "7", "3"}), "7,3"},
      {"commas", Columns::standard, "1, 4.,5. ,6.,7,3", 9, "9, 0.5,-1.0 ,0.25,0,0", "9, 0.5,-1.0 ,0.25,7,3", "7,3"},
      {"one of the two", Columns::standard, "       1             4.0             5.0             6.0       0       7", 2,
       "       2             0.5            -1.0            0.25       0       0",
       "       2             0.5            -1.0            0.25       0       7", "0,7"},
      {"neither", Columns::standard, "       1             4.0             5.0             6.0       0       0", 2,
       "       2             0.5            -1.0            0.25       0       0",
       "       2             0.5            -1.0            0.25       0       0", ""},
      {"none at all", Columns::standard, "       1             4.0", 2, "       2             0.5            -1.0            0.25",
       "       2             0.5            -1.0            0.25", ""},
      {"by a parameter", Columns::standard, "1,4.,5.,6.,&tc", 2, "2,0.5,-1.0,0.25,0", "2,0.5,-1.0,0.25,&tc", "&tc,"},
      {"words behind", Columns::standard, "       1             4.0             5.0             6.0       7       3 left", 2,
       "       2             0.5            -1.0            0.25       0       0 left",
       "       2             0.5            -1.0            0.25       7       3 left", "7,3"},
  };
  for (const NewNodeCase& c : cases) {
    SCOPED_TRACE(c.what);
    const std::string text = "*NODE\n" + c.example + "\r\n*END\n";
    const std::uint16_t style = style_of(c.columns);
    const Vec3 at(0.5, -1, 0.25);
    EXPECT_EQ(kKeywordWriter->node_end({text, 6, style}), 6 + c.example.size());
    EXPECT_EQ(kKeywordWriter->new_node({text, 6, style}, c.id, at).text, c.free);
    const Result<WrittenCard> constrained = kKeywordWriter->new_constrained_node({text, 6, style}, c.id, at);
    ASSERT_TRUE(constrained);
    EXPECT_EQ(constrained->text, c.constrained);
    EXPECT_EQ(kKeywordWriter->node_constraints({text, 6, style}), c.constraints);
  }
}

TEST(KeywordWriter, reads_coordinates_in_each_layout_and_none_that_a_parameter_gives) {
  const auto at = [](const std::string& card, Columns columns) { return kKeywordWriter->node_coordinates({card, 0, style_of(columns)}); };
  EXPECT_EQ(at("       1             1.0             2.0             3.0       7", Columns::standard), Vec3(1, 2, 3));
  EXPECT_EQ(at("         1             1.0             2.0             3.0", Columns::i10), Vec3(1, 2, 3));
  EXPECT_EQ(at(fields(20, {"1", "1.0", "2.0", "3.0"}), Columns::wide), Vec3(1, 2, 3));
  EXPECT_EQ(at("1,1.,,3.", Columns::wide), Vec3(1, 0, 3));
  EXPECT_EQ(at("1,1.,&y,3.", Columns::standard), std::nullopt);
}

TEST(KeywordWriter, moves_nodes_between_commas_by_as_many_digits_as_were_there) {
  const std::string card = "1,0.1234567890123456789,2.,&z";
  const WrittenCard moved = kKeywordWriter->move_node({card, 0, 0}, {0.1234567890123456789, 2, 3}, {1.0 / 3, 2, 3});
  EXPECT_EQ(moved.text, "1,0.3333333333333333,2.,&z");
  EXPECT_EQ(moved.rounded, 0);
  EXPECT_FALSE(moved.by_parameter);
  EXPECT_TRUE(kKeywordWriter->move_node({card, 0, 0}, {0, 2, 3}, {0, 2, 4}).by_parameter);
}

TEST(KeywordWriter, tells_the_largest_id_of_each_layout) {
  for (const auto& [columns, largest] :
       {std::pair(Columns::standard, std::int64_t{99'999'999}), std::pair(Columns::i10, std::int64_t{9'999'999'999}),
        std::pair(Columns::wide, std::int64_t{999'999'999'999'999'999})}) {
    EXPECT_EQ(kKeywordWriter->largest_node_id(style_of(columns)), largest);
    EXPECT_EQ(kKeywordWriter->largest_shell_id(style_of(columns)), largest);
  }
}

TEST(KeywordWriter, says_of_a_new_node_what_it_rounds) {
  const WrittenCard card = kKeywordWriter->new_node({"1,0.,0.,0.", 0, 0}, 2, Vec3(100.0 / 3, 1e-300 / 3, -2.5));
  EXPECT_EQ(card.text, "2,33.3333333333333,3.333333333E-301,-2.5");
  EXPECT_EQ(card.rounded, 2);
  EXPECT_LT(card.largest_error, 1e-12);
  EXPECT_GT(card.largest_error, 1e-15);
}

// --- shells ---------------------------------------------------------------------------------------------------------

struct ShellCase {
  const char* what;
  lsdyna::CardForm form;
  Columns columns;
  std::string before;
  ShellCard shell;
  std::string after;
};

TEST(KeywordWriter, writes_shells_in_their_layout) {
  const lsdyna::CardForm plain{.kind = lsdyna::CardKind::shell};
  const lsdyna::CardForm thick{.kind = lsdyna::CardKind::shell, .thickness = true};
  const lsdyna::CardForm layered{.kind = lsdyna::CardKind::shell, .composite = true};
  const lsdyna::CardForm layered_long{.kind = lsdyna::CardKind::shell, .composite = true, .composite_long = true};
  const ShellCard quad{21, {31, 32, 33, 34}, kSameCorners, 0};
  const ShellCard triangle{21, {31, 32, 33, 33}, kSameCorners, 0};
  const ShellCase cases[] = {
      {"standard", plain, Columns::standard, "      11       7       1       2       5       4", quad,
       "      21       7      31      32      33      34"},
      {"i10", plain, Columns::i10, fields(10, {"11", "7", "1", "2", "5", "4"}), quad, fields(10, {"21", "7", "31", "32", "33", "34"})},
      {"i10, ten digits",
       plain,
       Columns::i10,
       fields(10, {"11", "7", "1", "2", "5", "4"}),
       {9876543210, {1234567890, 1234567891, 1234567892, 1234567893}, kSameCorners, 0},
       "9876543210         71234567890123456789112345678921234567893"},
      {"wide", plain, Columns::wide, fields(20, {"11", "7", "1", "2", "5", "4"}), quad, fields(20, {"21", "7", "31", "32", "33", "34"})},
      {"commas", plain, Columns::wide, "11, 7 , 1,2,5,4", quad, "21, 7 , 31,32,33,34"},
      {"a parameter for the part", plain, Columns::standard, "      11     &p0       1       2       5       4", quad,
       "      21     &p0      31      32      33      34"},
      {"a triangle that was a quad", plain, Columns::standard, "      11       7       1       2       5       4", triangle,
       "      21       7      31      32      33      33"},
      {"a triangle that was short", plain, Columns::standard, "      11       7       1       2       5", triangle,
       "      21       7      31      32      33"},
      {"a quad that was short", plain, Columns::standard, "      11       7       1       2       5", quad,
       "      21       7      31      32      33      34"},
      {"fields behind", plain, Columns::standard, "      11       7       1       2       5       4       0       0", quad,
       "      21       7      31      32      33      34       0       0"},
      {"wide thicknesses",
       thick,
       Columns::wide,
       fields(20, {"11", "7", "1", "2", "5", "4"}) + "\n" + fields(20, {"1.0", "2.0", "3.0", "4.0"}),
       {21, {31, 32, 33, 34}, {{{0.5, 0.5, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0.5, 0, 0, 0.5}}}, 0},
       fields(20, {"21", "7", "31", "32", "33", "34"}) + "\n" + fields(20, {"1.5", "2.0", "3.0", "2.5"})},
      {"thicknesses between commas",
       thick,
       Columns::standard,
       "11,7,1,2,5,4\n1.,2.,3.,4.,45.",
       {21, {31, 32, 33, 34}, {{{0.5, 0.5, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0.5, 0, 0, 0.5}}}, 30},
       "21,7,31,32,33,34\n1.5,2.,3.,2.5,15.0"},
      {"a quad that was a triangle of one thickness", thick, Columns::standard, "11,7,1,2,5\n&t,&t,&t", quad,
       "21,7,31,32,33,34\n&t,&t,&t,&t"},
      {"ids that stay keep their digits",
       plain,
       Columns::standard,
       "0011,7,01,2,5,4",
       {11, {1, 32, 5, 4}, kSameCorners, 0},
       "0011,7,01,32,5,4"},
      {"a triangle of three thicknesses",
       thick,
       Columns::standard,
       "11,7,1,2,5,5\n1.,2.,3.",
       {21, {31, 32, 33, 33}, {{{0.5, 0.5, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 1, 0}}}, 0},
       "21,7,31,32,33,33\n1.5,2.,3."},
      {"layers that don't turn", layered, Columns::standard, "11,7,1,2,5,4\n         1\t 0.5", quad, "21,7,31,32,33,34\n         1\t 0.5"},
      {"layers that turn",
       layered,
       Columns::standard,
       "11,7,1,2,5,4\n1,0.5,10.,,1,0.5,20.",
       {21, {31, 32, 33, 34}, kSameCorners, 30},
       "21,7,31,32,33,34\n1,0.5,-20.0,,1,0.5,-10.0"},
      {"long layers that turn",
       layered_long,
       Columns::standard,
       "11,7,1,2,5,4\n1,0.5,10.,,,,20.",
       {21, {31, 32, 33, 34}, kSameCorners, 30},
       "21,7,31,32,33,34\n1,0.5,-20.0,,,,20."},
      {"an angle that is blank",
       thick,
       Columns::standard,
       "11,7,1,2,5,4\n1.,1.,1.,1.,",
       {21, {31, 32, 33, 34}, kSameCorners, 30},
       "21,7,31,32,33,34\n1.,1.,1.,1.,"},
      {"a comment between the cards goes", thick, Columns::standard, "11,7,1,2,5,4\r\n$ why\r\n1.,1.,1.,1.", quad,
       "21,7,31,32,33,34\r\n1.,1.,1.,1."},
  };
  for (const ShellCase& c : cases) {
    SCOPED_TRACE(c.what);
    const std::string text = "*ELEMENT_SHELL\n" + c.before + "\n*END\n";
    const std::uint16_t style = lsdyna::shell_style(c.form, c.columns);
    EXPECT_EQ(kKeywordWriter->shell_end({text, 15, style}), 15 + c.before.size());
    const Result<WrittenCard> card = kKeywordWriter->shell({text, 15, style}, c.shell);
    ASSERT_TRUE(card) << card.error().text();
    EXPECT_EQ(card->text, c.after);
    EXPECT_FALSE(card->by_parameter);
    EXPECT_EQ(card->rounded, 0);
  }
}

// --- sets -----------------------------------------------------------------------------------------------------------

/// A deck of one set, behind four nodes.
class KeywordSets : public ::testing::Test {
 protected:
  void open(const std::string& cards) {
    auto opened = folder_.open("*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n5,1.,1.,0.\n4,0.,1.,0.\n" + cards);
    if (!opened) throw std::runtime_error(opened.error().text());
    deck_ = opened->deck;
  }
  std::string_view text() const { return deck_->files[0].bytes.text(); }
  const Referrer& first() const { return deck_->references->referrers().front(); }
  Result<std::vector<Replacement>> change(const Numbers& joining, const Numbers& leaving) const {
    return kKeywordWriter->change_list(text(), first(), joining, leaving);
  }
  /// What stands behind the nodes then.
  std::string after(const Result<std::vector<Replacement>>& replacements) const {
    EXPECT_TRUE(replacements) << replacements.error().text();
    std::string out(text());
    if (replacements)
      for (auto r = replacements->rbegin(); r != replacements->rend(); ++r) out.replace(r->offset, r->length, r->text);
    return out.substr(out.find('*', 1));
  }

  DeckFolder folder_;
  std::shared_ptr<const Deck> deck_;
};

struct ListCase {
  const char* what;
  std::string before;
  Numbers joining, leaving;
  std::string after;
};

TEST_F(KeywordSets, change_in_the_manner_of_their_lines) {
  const std::string wide_set = "*SET_NODE_LIST +\n" + fields(20, {"1"}) + "\n";
  const ListCase cases[] = {
      {"columns stay ten with I10",
       "*SET_NODE_LIST %\n         1\n         1         2\n",
       {7},
       {},
       "*SET_NODE_LIST %\n         1\n         1         2         7\n"},
      {"twenty columns",
       wide_set + fields(20, {"1", "2"}) + "\n",
       {12345678901},
       {},
       wide_set + fields(20, {"1", "2", "12345678901"}) + "\n"},
      {"twenty columns, a full line",
       wide_set + fields(20, {"1", "2", "3", "4", "5", "6", "7", "8"}) + "\n",
       {9},
       {},
       wide_set + fields(20, {"1", "2", "3", "4", "5", "6", "7", "8"}) + "\n" + fields(20, {"9"}) + "\n"},
      {"twenty columns, one leaves", wide_set + fields(20, {"1", "2", "3"}) + "\n", {}, {2}, wide_set + fields(20, {"1", "3"}) + "\n"},
      {"many",
       "*SET_NODE_LIST\n1\n1,2,3,4,5,6,7\n",
       {11, 12, 13, 14, 15, 16, 17, 18, 19, 20},
       {},
       "*SET_NODE_LIST\n1\n1,2,3,4,5,6,7,11\n12,13,14,15,16,17,18,19\n20,\n"},
      {"many in columns with zeros",
       "*SET_NODE_LIST\n         1\n         1         2         3         4         5         6         0         0\n",
       {11, 12, 13},
       {},
       "*SET_NODE_LIST\n         1\n         1         2         3         4         5         6        11        12\n"
       "        13         0         0         0         0         0         0         0\n"},
      {"comments and blank lines stay",
       "*SET_NODE_LIST_TITLE\n$ title\nall\n$ header\n1\n$ list\n\n1,2,3,4,5,6,7,8\n$ behind\n\n",
       {9},
       {},
       "*SET_NODE_LIST_TITLE\n$ title\nall\n$ header\n1\n$ list\n\n1,2,3,4,5,6,7,8\n9,\n$ behind\n\n"},
      {"parameters stay", "*SET_NODE_LIST\n1\n1,&n,2\n", {7}, {1}, "*SET_NODE_LIST\n1\n&n,2,7\n"},
      {"tabs", "*SET_NODE_LIST\n1\n         1\t2\n", {7}, {}, "*SET_NODE_LIST\n1\n         1      2            7\n"},
      {"blanks behind stay",
       "*SET_NODE_LIST\n1\n         1         3         6         2          \n",
       {},
       {3, 6},
       "*SET_NODE_LIST\n1\n         1         2                              \n"},
      {"zeros stay",
       "*SET_NODE_LIST\n1\n         1         3         6         2         0         0         0         0\n",
       {},
       {3, 6},
       "*SET_NODE_LIST\n1\n         1         2         0         0         0         0         0         0\n"},
      {"zeros between commas stay", "*SET_NODE_LIST\n1\n1,3,2,0,0\n", {}, {3}, "*SET_NODE_LIST\n1\n1,2,0,0,0\n"},
      {"one leaves and another joins", "*SET_NODE_LIST\n1\n1,2,3\n", {7}, {2}, "*SET_NODE_LIST\n1\n1,3,7\n"},
      {"the last line goes and another comes", "*SET_NODE_LIST\n1\n1,2\n3,4\n", {7, 8}, {3, 4}, "*SET_NODE_LIST\n1\n1,2\n7,8\n"},
      {"all go and others come", "*SET_NODE_LIST\n1\n3,4\n", {7}, {3, 4}, "*SET_NODE_LIST\n1\n7,\n"},
      {"lines end as they did", "*SET_NODE_LIST\r\n1\r\n1,2,3,4,5,6,7,8\r\n", {9}, {4}, "*SET_NODE_LIST\r\n1\r\n1,2,3,5,6,7,8,9\r\n"},
      {"a new line ends as they did",
       "*SET_NODE_LIST\r\n1\r\n1,2,3,4,5,6,7,8\r\n",
       {9},
       {},
       "*SET_NODE_LIST\r\n1\r\n1,2,3,4,5,6,7,8\r\n9,\r\n"},
      {"a last line without an end", "*SET_NODE_LIST\n1\n1,2,3,4,5,6,7,8", {9}, {}, "*SET_NODE_LIST\n1\n1,2,3,4,5,6,7,8\n9,"},
      {"a last line without an end goes", "*SET_NODE_LIST\n1\n1,2\n3", {}, {3}, "*SET_NODE_LIST\n1\n1,2\n"},
      {"an id that is named twice", "*SET_NODE_LIST\n1\n1,3,2,3\n", {}, {3}, "*SET_NODE_LIST\n1\n1,2\n"},
      {"ranges",
       "*SET_SHELL_LIST_GENERATE\n         1\n        11        12\n",
       {13, 14, 15, 20},
       {},
       "*SET_SHELL_LIST_GENERATE\n         1\n        11        12        13        15        20        20\n"},
      {"a range of one", "*SET_SHELL_LIST_GENERATE\n1\n11,12,20\n", {13}, {}, "*SET_SHELL_LIST_GENERATE\n1\n11,12,20,,13,13\n"},
      {"a line with room for one range",
       "*SET_NODE_LIST_GENERATE\n1\n1,2,4,5,7,8\n",
       {20, 21, 30},
       {},
       "*SET_NODE_LIST_GENERATE\n1\n1,2,4,5,7,8,20,21\n30,30\n"},
      {"a full line of ranges",
       "*SET_NODE_LIST_GENERATE\n1\n1,2,4,5,7,8,10,11\n",
       {20, 21},
       {},
       "*SET_NODE_LIST_GENERATE\n1\n1,2,4,5,7,8,10,11\n20,21\n"},
      {"ranges with steps",
       "*SET_NODE_LIST_GENERATE_INCREMENT\n         1\n         1         5         2\n",
       {7, 9, 10},
       {},
       "*SET_NODE_LIST_GENERATE_INCREMENT\n         1\n         1         5         2\n         7         7         1\n"
       "         9        10         1\n"},
      {"a column in columns",
       "*SET_NODE_COLUMN\n         1\n         1       0.5\n         2       0.5\n",
       {7, 8},
       {},
       "*SET_NODE_COLUMN\n         1\n         1       0.5\n         2       0.5\n         7       0.5\n         8       0.5\n"},
      {"general in columns",
       "*SET_NODE_GENERAL\n         1\nNODE               1         2\n",
       {7},
       {},
       "*SET_NODE_GENERAL\n         1\nNODE               1         2\n      NODE         7\n"},
      {"general in twenty columns",
       "*SET_SHELL_GENERAL +\n" + fields(20, {"1"}) + "\n" + fields(20, {"ELEM", "11", "12"}) + "\n",
       {13},
       {},
       "*SET_SHELL_GENERAL +\n" + fields(20, {"1"}) + "\n" + fields(20, {"ELEM", "11", "12"}) + "\n" + fields(20, {"ELEM", "13"}) + "\n"},
      {"seven a line in general",
       "*SET_NODE_GENERAL\n1\nNODE,1\n",
       {11, 12, 13, 14, 15, 16, 17, 18},
       {},
       "*SET_NODE_GENERAL\n1\nNODE,1\nNODE,11,12,13,14,15,16,17\nNODE,18\n"},
      {"a part of general", "*SET_PART_LIST_GENERAL\n1\nPART,1\n", {8}, {}, "*SET_PART_LIST_GENERAL\n1\nPART,1\nPART,8\n"},
      {"a line of general goes", "*SET_NODE_GENERAL\n1\nNODE,3\nNODE,1,2\n", {}, {3}, "*SET_NODE_GENERAL\n1\nNODE,1,2\n"},
      {"words in small letters", "*set_node_general\n1\nnode,3,1\n", {}, {3}, "*set_node_general\n1\nnode,1\n"},
  };
  for (const ListCase& c : cases) {
    SCOPED_TRACE(c.what);
    open("*PARAMETER\nIn,99\n" + c.before);
    EXPECT_EQ(after(change(c.joining, c.leaving)), "*PARAMETER\nIn,99\n" + c.after);
  }
}

/// In a general set a line's word says what its numbers are.
TEST_F(KeywordSets, keep_what_has_the_same_number_as_one_that_goes) {
  const ListCase cases[] = {
      {"a part", "*SET_NODE_GENERAL\n1\nNODE,3,1\nPART,3\n", {}, {3}, "*SET_NODE_GENERAL\n1\nNODE,1\nPART,3\n"},
      {"a part beside others", "*SET_SHELL_GENERAL\n1\nPART,3,4\nELEM,3,1\n", {}, {3}, "*SET_SHELL_GENERAL\n1\nPART,3,4\nELEM,1\n"},
      {"a set", "*SET_SHELL_GENERAL\n1\nelement,3,1\nSET,3\n", {}, {3}, "*SET_SHELL_GENERAL\n1\nelement,1\nSET,3\n"},
      {"a box",
       "*SET_NODE_GENERAL\n1\n      NODE         3         1\n       BOX         3\n",
       {},
       {3},
       "*SET_NODE_GENERAL\n1\n      NODE         1\n       BOX         3\n"},
  };
  for (const ListCase& c : cases) {
    SCOPED_TRACE(c.what);
    open(c.before);
    EXPECT_EQ(after(change(c.joining, c.leaving)), c.after);
  }
}

struct RefusedList {
  const char* what;
  std::string set;
  Numbers joining, leaving;
  const char* why;
};

TEST_F(KeywordSets, refuse_what_they_cant_write) {
  const char* const narrow = "has fields too narrow for the new ids";
  const char* const otherwise = "names what would go by a parameter, or otherwise than as a plain number";
  const RefusedList cases[] = {
      {"eleven digits", "*SET_NODE_LIST\n1\n1\n", {12345678901}, {}, narrow},
      {"eleven digits with I10", "*SET_NODE_LIST %\n1\n1\n", {2, 12345678901}, {}, narrow},
      {"a parameter", "*PARAMETER\nIn,3\n*SET_NODE_LIST\n1\n1,&n\n", {}, {3}, otherwise},
      {"a parameter beside a number", "*PARAMETER\nIn,3\n*SET_NODE_LIST\n1\n1,&n,6,6\n", {}, {3, 6}, otherwise},
      {"the last one", "*SET_NODE_LIST\n1\n3\n6\n", {}, {3, 6}, "would be left empty"},
      {"the last one of general", "*SET_NODE_GENERAL\n1\nNODE,3,6\n", {}, {3, 6}, "would be left empty"},
      {"all but what takes away", "*SET_NODE_GENERAL\n1\nNODE,3\nDNODE,5\n", {}, {3}, "would be left empty"},
      {"entries with attributes",
       "*SET_NODE_COLUMN\n1\n1,0.5\n3,0.5\n",
       {},
       {3},
       "lists its entries with attributes, from which none can be taken out"},
      {"different attributes",
       "*SET_NODE_COLUMN\n1\n1,0.5,1.,1.,1.\n3,0.5,1.,1.,2.\n",
       {7},
       {},
       "gives its entries different attributes, and it can't be told which a new one has"},
      {"sets of sets", "*SET_NODE_ADD\n1\n2,3\n", {7}, {}, "is made of other sets"},
      {"what sets have in common", "*SET_NODE_INTERSECT\n1\n2,3\n", {7}, {}, "is made of other sets"},
      {"encrypted text",
       "*SET_NODE_LIST\n1\n1,2\n-----BEGIN PGP MESSAGE-----\nab\n-----END PGP MESSAGE-----\n",
       {7},
       {},
       "is encrypted in part"},
      {"no line of ids", "*SET_NODE_LIST_TITLE\nnone\n1\n\n", {7}, {}, "has no line after which another could go"},
      {"no set", "*DATABASE_HISTORY_NODE\n1,2\n", {7}, {}, "lists what it is about in a way that this version can't change"},
  };
  for (const RefusedList& c : cases) {
    SCOPED_TRACE(c.what);
    open(c.set);
    const auto changed = change(c.joining, c.leaving);
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.error().message, c.why);
  }
}

// --- segments and single ones ---------------------------------------------------------------------------------------

struct SegmentCase {
  const char* what;
  std::string set, line;  ///< the line is the set's last
  std::optional<std::array<std::int64_t, 4>> corners;
  std::vector<std::array<std::int64_t, 4>> with;
  std::string after;
};

TEST_F(KeywordSets, replace_segments_in_the_manner_of_their_line) {
  const SegmentCase cases[] = {
      {"columns",
       "*SET_SEGMENT\n         1\n",
       "         1         2         5         4       0.5",
       {{1, 2, 5, 4}},
       {{1, 7, 9, 8}, {7, 2, 5, 9}},
       "         1         7         9         8       0.5\n         7         2         5         9       0.5"},
      {"twenty columns",
       "*SET_SEGMENT +\n" + fields(20, {"1"}) + "\n",
       fields(20, {"1", "2", "5", "4", "0.5"}),
       {{1, 2, 5, 4}},
       {{12345678901, 2, 5, 5}},
       fields(20, {"12345678901", "2", "5", "5", "0.5"})},
      {"commas", "*SET_SEGMENT_TITLE\ntop\n1\n", "1, 2 ,5,4,0.5", {{1, 2, 5, 4}}, {{7, 2, 5, 4}}, "7, 2 ,5,4,0.5"},
      {"a triangle written short",
       "*SET_SEGMENT\n1\n",
       "         1         2         5",
       {{1, 2, 5, 5}},
       {{1, 2, 7, 7}},
       "         1         2         7         7"},
      {"general",
       "*SET_SEGMENT_GENERAL\n1\n",
       "seg,1,2,5,4,0.5",
       {{1, 2, 5, 4}},
       {{1, 2, 7, 7}, {7, 5, 4, 1}},
       "seg,1,2,7,7,0.5\nseg,7,5,4,1,0.5"},
      {"none", "*SET_SEGMENT\n1\n1,2,5,4\n", "2,5,4,4", {{2, 5, 4, 4}}, {}, ""},
      {"a parameter", "*PARAMETER\nIn,2\n*SET_SEGMENT\n1\n", "1,&n,5,4", std::nullopt, {{1, 7, 5, 4}}, "1,7,5,4"},
  };
  for (const SegmentCase& c : cases)
    for (const std::string eol : {"\n", "\r\n", ""}) {
      SCOPED_TRACE(std::string(c.what) + " " + std::to_string(eol.size()));
      std::string set = c.set, wanted = c.after;
      if (eol.size() == 2)
        for (std::string* each : {&set, &wanted})
          for (std::size_t at = 0; (at = each->find('\n', at)) != std::string::npos; at += 2) each->replace(at, 1, eol);
      open(set + c.line + eol);
      const std::size_t card = text().size() - c.line.size() - eol.size();
      EXPECT_EQ(kKeywordWriter->segment(text(), first(), card), c.corners);
      EXPECT_EQ(after(kKeywordWriter->replace_segment(text(), first(), card, c.with)), set + wanted + (c.with.empty() ? "" : eol));
    }
}

TEST_F(KeywordSets, refuse_segments_that_dont_fit_or_arent_any) {
  const std::vector<std::array<std::int64_t, 4>> large = {{1, 2, 5, 12345678901}}, small = {{1, 2, 5, 7}};
  const auto refused = [&](const std::string& cards, const auto& with) {
    open(cards);
    const std::size_t line = text().rfind('\n', text().size() - 2) + 1;
    const auto changed = kKeywordWriter->replace_segment(text(), first(), line, with);
    return changed ? "" : changed.error().message;
  };
  const std::string narrow = "has fields too narrow for the new ids", none = "can't be replaced";
  EXPECT_EQ(refused("*SET_SEGMENT\n1\n         1         2         5         4\n", large), narrow);
  EXPECT_EQ(refused("*SET_SEGMENT %\n1\n         1         2         5         4\n", large), narrow);
  EXPECT_EQ(refused("*SET_SEGMENT\n1\n         1         2         5         4\n", small), "");
  EXPECT_EQ(refused("*SET_SEGMENT\n1\n1,2,5,4\n", large), "");
  EXPECT_EQ(refused("*SET_SEGMENT_GENERAL\n1\nPART,1,2,5,4\n", small), none);
  EXPECT_EQ(refused("*LOAD_SEGMENT\n1,1.,0.,1,2,5,4\n", small), none);
  open("*SET_SEGMENT_GENERAL\n1\nDSEG,1,2,5,4\n");
  EXPECT_EQ(kKeywordWriter->segment(text(), first(), text().find("DSEG")), std::nullopt);
}

struct CopyCase {
  const char* what;
  Referred referred;
  std::string before, card, after;  ///< `card` names 1 and is repeated for 7 and 8
};

TEST_F(KeywordSets, cards_of_single_ones_are_repeated_behind_them) {
  const CopyCase cases[] = {
      {"columns", Referred::node, "*BOUNDARY_SPC_NODE\n", "         1         0         1",
       "         1         0         1\n         7         0         1\n         8         0         1\n"},
      {"twenty columns", Referred::node, "*BOUNDARY_SPC_NODE +\n", fields(20, {"1", "0", "1"}),
       fields(20, {"1", "0", "1"}) + "\n" + fields(20, {"7", "0", "1"}) + "\n" + fields(20, {"8", "0", "1"}) + "\n"},
      {"the second field", Referred::node, "*CONSTRAINED_EXTRA_NODES_NODE\n", "         9         1",
       "         9         1\n         9         7\n         9         8\n"},
      {"temperatures", Referred::node, "*BOUNDARY_TEMPERATURE_NODE\n", "1,0,20.", "1,0,20.\n7,0,20.\n8,0,20.\n"},
      {"initial temperatures", Referred::node, "*INITIAL_TEMPERATURE_NODE\n", "1,20.", "1,20.\n7,20.\n8,20.\n"},
      {"velocities", Referred::node, "*INITIAL_VELOCITY_NODE\n", "1,0.,0.,9.", "1,0.,0.,9.\n7,0.,0.,9.\n8,0.,0.,9.\n"},
      {"pressures", Referred::shell, "*LOAD_SHELL_ELEMENT\n", "1,3,2.5", "1,3,2.5\n7,3,2.5\n8,3,2.5\n"},
      {"strains of two layers", Referred::shell, "*INITIAL_STRAIN_SHELL\n", "1,1,2\n0.,0.,0.\n$ upper\n1.,0.,0.",
       "1,1,2\n0.,0.,0.\n$ upper\n1.,0.,0.\n7,1,2\n0.,0.,0.\n$ upper\n1.,0.,0.\n8,1,2\n0.,0.,0.\n$ upper\n1.,0.,0.\n"},
  };
  for (const CopyCase& c : cases) {
    SCOPED_TRACE(c.what);
    for (const bool last : {false, true}) {
      open(c.before + c.card + (last ? "" : "\n"));
      const std::vector<Reference> naming = deck_->references->naming(c.referred, 1);
      ASSERT_EQ(naming.size(), 1u);
      EXPECT_EQ(kKeywordWriter->inheritance(first(), c.referred), Inheritance::follows);
      const auto copied = kKeywordWriter->copy_single(text(), first(), naming[0], Numbers{7, 8});
      EXPECT_EQ(after(copied), c.before + (last ? c.after.substr(0, c.after.size() - 1) : c.after));
    }
  }
}

TEST_F(KeywordSets, cards_of_single_ones_that_cant_be_repeated_say_why) {
  const auto refused = [&](const std::string& cards, Referred referred, std::int64_t id) {
    open(cards);
    const std::vector<Reference> naming = deck_->references->naming(referred, 1);
    if (naming.size() != 1) return std::string("no such card");
    const auto copied = kKeywordWriter->copy_single(text(), first(), naming[0], Numbers{id});
    return copied ? "" : copied.error().message;
  };
  EXPECT_EQ(refused("*BOUNDARY_SPC_NODE\n         1         0         1\n", Referred::node, 12345678901),
            "has fields too narrow for the new ids");
  EXPECT_EQ(refused("*BOUNDARY_SPC_NODE\n1,0,1\n", Referred::node, 12345678901), "");
  EXPECT_EQ(refused("*PARAMETER\nIn,1\n*BOUNDARY_SPC_NODE\n&n,0,1\n", Referred::node, 7), "names it by the parameter &n");
  EXPECT_EQ(refused("*DATABASE_HISTORY_NODE\n1\n", Referred::node, 7), "can't be written again for another");
  EXPECT_EQ(refused("*INITIAL_STRESS_SHELL\n1,1,2\n0.,0.,0.\n", Referred::shell, 7),
            "has values without a point, which can't be told from the next shell's line");
  EXPECT_EQ(refused("*INITIAL_STRESS_SHELL\n1,4,1\n0.,0.,0.\n", Referred::shell, 7),
            "has values without a point, which can't be told from the next shell's line");
}

TEST_F(KeywordSets, cards_of_single_ones_stay_follow_or_forbid) {
  const auto meaning = [](const char* keyword, Referred referred) {
    Referrer card;
    card.keyword = keyword;
    return kKeywordWriter->inheritance(card, referred);
  };
  for (const char* stays :
       {"DATABASE_HISTORY_NODE", "SENSOR_DEFINE_NODE", "CONSTRAINED_SPOTWELD", "LOAD_NODE_POINT", "DEFINE_COORDINATE_NODES"})
    EXPECT_EQ(meaning(stays, Referred::node), Inheritance::stays) << stays;
  for (const char* forbids : {"BOUNDARY_SPC_NODE_ID", "BOUNDARY_PRESCRIBED_MOTION_NODE", "INITIAL_FOAM_REFERENCE_GEOMETRY",
                              "LOAD_THERMAL_VARIABLE_NODE", "AIRBAG_REFERENCE_GEOMETRY", "SET_NODE_GENERAL"})
    EXPECT_EQ(meaning(forbids, Referred::node), Inheritance::forbids) << forbids;
  EXPECT_EQ(meaning("DATABASE_HISTORY_SHELL", Referred::shell), Inheritance::stays);
  EXPECT_EQ(meaning("DEFINE_ELEMENT_DEATH_SHELL", Referred::shell), Inheritance::forbids);
  EXPECT_EQ(meaning("BOUNDARY_SPC_NODE", Referred::shell), Inheritance::forbids);
  EXPECT_EQ(meaning("LOAD_SHELL_ELEMENT", Referred::node), Inheritance::stays);
}

}  // namespace
}  // namespace prismesh::mesh::deck
