// What saving changes in Nastran bulk data: the fields that must, in the width and manner of their card.
#include <functional>

#include "mesh/deck/formats/formats.h"
#include "mesh/deck/nastran/writer.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

const auto kWriter = nastran::card_writer();
constexpr std::array<std::array<double, 4>, 4> kSame{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

struct Move {
  const char* what;
  std::string card;
  Vec3 from, to;
  std::string wanted;
};

TEST(NastranWriter, moves_within_the_card) {
  const Move moves[] = {
      {"small field",
       "GRID           1       0     1.0     2.0     3.0       4     123",
       {1, 2, 3},
       {1.5, 2, 3},
       "GRID           1       0     1.5     2.0     3.0       4     123"},
      {"the most digits of eight columns",
       "GRID           1             1.0     2.0     3.0",
       {1, 2, 3},
       {0.00123456789, -123456.789, 123456789.0},
       "GRID           1        .0012346-123457.1.2346+8"},
      {"small numbers",
       "GRID           1             1.0     2.0     3.0",
       {1, 2, 3},
       {1.23456e-7, -1.23456e-7, 3},
       "GRID           1        1.2346-7-1.235-7     3.0"},
      {"numbers that lean left",
       "GRID    1               1.0     2.0     3.0",
       {1, 2, 3},
       {1, 20.5, 3},
       "GRID    1               1.0     20.5    3.0"},
      {"missing fields", "GRID    1               1.", {1, 0, 0}, {1, 0, 2}, "GRID    1               1.              2.0"},
      {"large field",
       "GRID*                  1                             1.0             2.0*A\n*A                   3.0",
       {1, 2, 3},
       {1, 1.0 / 3, -1.0 / 3},
       "GRID*                  1                             1.0.333333333333333*A\n*A      -.33333333333333"},
      {"a large field card without its second line",
       "GRID*                  1                             1.0             2.0",
       {1, 2, 0},
       {1, 2, 5},
       "GRID*                  1                             1.0             2.0\n*                    5.0"},
      {"comments within",
       "GRID*   1                               1.0             2.0\r\n$ why\r\n*       3.0",
       {1, 2, 3},
       {1, 2, 4},
       "GRID*   1                               1.0             2.0\r\n$ why\r\n*       4.0"},
      {"free field", "GRID,1,, 1.0 ,2.,3.,,123 $ a, b", {1, 2, 3}, {-7, 2, 1.25}, "GRID,1,, -7.0 ,2.,1.25,,123 $ a, b"},
      {"few free fields", "GRID,1", {0, 0, 0}, {0, 2, 0}, "GRID,1,,,2.0"},
      {"long free fields keep their length",
       "GRID,1,,0.123456789012",
       {0.123456789012, 0, 0},
       {0.98765432101234, 0, 0},
       "GRID,1,,.9876543210123"},
      {"large free field", "GRID*,1,,1.,2.\n*,3.", {1, 2, 3}, {1, 2, 1.0 / 3}, "GRID*,1,,1.,2.\n*,.333333333333333"},
      {"tabs", "GRID\t1\t\t1.\t2.\t3.", {1, 2, 3}, {1, 2, 4}, "GRID    1               1.      2.      4.0"},
      {"a comment in columns",
       "GRID           1             1.0 $ one",
       {1, 0, 0},
       {1, 0, 2},
       "GRID           1             1.0             2.0 $ one"},
      {"a field before a comment",
       "GRID           1             1.0 $ one",
       {1, 0, 0},
       {5, 0, 0},
       "GRID           1             5.0 $ one"},
      {"an id that fills its field leans to neither side",
       "GRID    12345678        1.0     2.0",
       {1, 2, 0},
       {1, 2, 3.5},
       "GRID    12345678        1.0     2.0     3.5"},
      {"a full id before numbers that lean right",
       "GRID    12345678             1.0     2.0",
       {1, 2, 0},
       {1, 2, 3.5},
       "GRID    12345678             1.0     2.0     3.5"},
      {"a large field card whose next line holds later fields",
       "GRID*                  1                             1.0             2.0\n+              9",
       {1, 2, 0},
       {1, 2, 5},
       "GRID*                  1                             1.0             2.0\n*                    5.0\n+              9"},
      {"the name of a continuation stays",
       "GRID           1             1.0     2.0     3.0       4     123        +A1",
       {1, 2, 3},
       {1, 2, -3.25},
       "GRID           1             1.0     2.0   -3.25       4     123        +A1"},
      {"a full field between full fields",
       "GRID    12345678        1.2345671.2345671.234567",
       {1.234567, 1.234567, 1.234567},
       {1.234567, -0.7654321, 1.234567},
       "GRID    12345678        1.234567-.7654321.234567"},
      {"large field in columns that lean left, with an id of nine digits",
       "GRID*   123456789                       1.0             2.0             *G1\n*G1     3.0",
       {1, 2, 3},
       {1, 2.5, 3.125},
       "GRID*   123456789                       1.0             2.5             *G1\n*G1     3.125"},
      {"blanks between free fields", "GRID, 3 , , 10. 1.5-3 , -2.5", {10, 1.5e-3, -2.5}, {10, 2, -2.5}, "GRID, 3 , ,10.,2.0, -2.5"},
      {"a free field of nine digits before it", "GRID,123456789,,1.,2.,3.", {1, 2, 3}, {1, 2, 4}, "GRID,123456789,,1.,2.,4.0"},
  };
  for (const Move& move : moves) {
    const std::string text = move.card + "\nGRID,2";
    ASSERT_EQ(kWriter->node_end({text, 0, 0}), move.card.size()) << move.what;
    EXPECT_EQ(kWriter->move_node({text, 0, 0}, move.from, move.to).text, move.wanted) << move.what;
  }
}

TEST(NastranWriter, says_what_it_rounds) {
  const WrittenCard card = kWriter->move_node({"GRID           1             1.0     2.0     3.0", 0, 0}, {1, 2, 3}, {1.0 / 3, 2.5, 3});
  EXPECT_EQ(card.rounded, 1);
  EXPECT_NEAR(card.largest_error, 3.3e-8, 1e-9);
}

TEST(NastranWriter, new_nodes_in_the_manner_of_the_old) {
  EXPECT_EQ(kWriter->new_node({"GRID           1       7     1.0     2.0     3.0       4     123", 0, 0}, 22, {1, 2.5, 0}).text,
            "GRID          22       7     1.0     2.5     0.0");
  EXPECT_EQ(kWriter->new_node({"GRID,1,7,1.,2.,3.,4,123", 0, 0}, 22, {1, 2.5, 0}).text, "GRID,22,7,1.0,2.5,0.0");
  EXPECT_EQ(kWriter
                ->new_node({"GRID*                  1                             1.0             2.0\r\n*                    3.0", 0, 0},
                           22, {1, 2.5, 0})
                .text,
            "GRID*                 22                             1.0             2.5\r\n*                    0.0");
  EXPECT_EQ(kWriter->new_constrained_node({"GRID,1,7,1.,2.,3.,4,123", 0, 0}, 22, {1, 2.5, 0})->text, "GRID,22,7,1.0,2.5,0.0,4,123");
  EXPECT_EQ(kWriter->node_constraints({"GRID,1,7,1.,2.,3.", 0, 0}), "");
  EXPECT_NE(kWriter->node_constraints({"GRID,1,7,1.,2.,3.,,123", 0, 0}), "");
}

TEST(NastranWriter, shells_change_in_place) {
  const ShellCard wanted{10, {1, 2, 9, 4}, kSame, 0};
  EXPECT_EQ(
      kWriter
          ->shell(
              {"CQUAD4        10       7       1       2       3       4     45.      .5+A\n+A                     1.      1.      1.   "
               "   1.",
               0, 0},
              wanted)
          ->text,
      "CQUAD4        10       7       1       2       9       4     45.      .5+A\n+A                     1.      1.      1.      1.");
  EXPECT_EQ(kWriter->shell({"CQUAD4,10,7,1,2,3,4", 0, 0}, wanted)->text, "CQUAD4,10,7,1,2,9,4");
}

TEST(NastranWriter, new_shells_mix_thickness_and_turn_angles) {
  const std::array<std::array<double, 4>, 4> half{{{1, 0, 0, 0}, {.5, .5, 0, 0}, {0, 0, .5, .5}, {0, 0, 0, 1}}};
  EXPECT_EQ(kWriter->shell({"CQUAD4,10,7,1,2,3,4,45.,.5\n,,,1.,2.,3.,4.", 0, 0}, {22, {1, 5, 6, 4}, half, 30})->text,
            "CQUAD4,22,7,1,5,6,4,15.0,.5\n+,,,1.0,1.5,3.5,4.0");
  EXPECT_EQ(
      kWriter->shell({"CQUAD4        10       7       1       2       3       4       5      .5", 0, 0}, {22, {1, 2, 3, 3}, kSame, 30})
          ->text,
      "CTRIA3        22       7       1       2       3       5      .5");
  EXPECT_EQ(kWriter->shell({"CTRIAR,10,7,1,2,3,1.5", 0, 0}, {10, {1, 2, 3, 4}, kSame, 0})->text, "CQUADR,10,7,1,2,3,4,1.5");
  EXPECT_EQ(
      kWriter
          ->shell(
              {"CQUAD4*               10               7               1               2*\n*                      3               4", 0, 0},
              {22, {1, 2, 3, 4}, kSame, 0})
          ->text,
      "CQUAD4*               22               7               1               2\n*                      3               4");
}

TEST(NastranWriter, shells_that_cant_be_carried_over) {
  const ShellCard wanted{22, {1, 2, 3, 4}, kSame, 0};
  EXPECT_EQ(kWriter->shell({"CQUAD8,10,7,1,2,3,4,5,6", 0, 0}, wanted).error().message, "has mid-side nodes");
  EXPECT_EQ(kWriter->shell({"CQUAD4,10,7,1,2,3,4\n=,*(1),==", 0, 0}, wanted).error().message, "is made by replication or replicated");
  EXPECT_FALSE(kWriter->shell({"CQUAD4,10,7,1,2,3,4\n,,,1.", 0, 0}, {22, {1, 2, 3, 3}, kSame, 0}).has_value());
  const ShellCard triangle{22, {1, 2, 3, 3}, kSame, 0};
  EXPECT_EQ(kWriter->shell({"CQUADR        10       7       1       2       3       4              .5+A\n+B             1", 0, 0}, wanted)
                .error()
                .message,
            "has continuations that aren't in order");
  EXPECT_EQ(kWriter->shell({"CSHEAR,10,7,1,2,3,4", 0, 0}, triangle).error().message, "is a CSHEAR, which has another number of corners");
  EXPECT_EQ(kWriter->shell({"CTRIA6,10,7,1,2,3", 0, 0}, wanted).error().message, "is a CTRIA6, which has another number of corners");
  EXPECT_EQ(kWriter->shell({"CSHEAR,10,7,1,2,3,4", 0, 0}, wanted)->text, "CSHEAR,22,7,1,2,3,4");
  EXPECT_EQ(kWriter->shell({"CQUAD4,10,7,1,2,3,4,,,\n,,,1.,,1.,1.", 0, 0}, wanted).error().message,
            "has a thickness of its own at some of its corners only");
}

TEST(NastranWriter, new_cards_have_all_that_the_old_one_says) {
  EXPECT_EQ(kWriter->new_constrained_node({"GRID,1,7,1.,2.,3.,4,123,9", 0, 0}, 22, {1, 2.5, 0})->text, "GRID,22,7,1.0,2.5,0.0,4,123,9");
  EXPECT_NE(kWriter->node_constraints({"GRID,1,7,1.,2.,3.,,,9", 0, 0}), "") << "a superelement";
  EXPECT_NE(kWriter->node_constraints({"GRID,1,7,1.,2.,3.,4", 0, 0}), kWriter->node_constraints({"GRID,1,7,1.,2.,3.,,4", 0, 0}));
  const auto anew = [](const char* card, double turn) { return kWriter->shell({card, 0, 0}, {22, {1, 2, 3, 4}, kSame, turn})->text; };
  EXPECT_EQ(anew("CQUAD4,10,,1,2,3,4", 0), "CQUAD4,22,10,1,2,3,4") << "a blank property is the element's id";
  EXPECT_EQ(anew("CQUAD4,10,7,1,2,3,4\n,,1,.5,.5,.5,.5", 0), "CQUAD4,22,7,1,2,3,4,,\n+,,1,0.5,0.5,0.5,0.5") << "shares stay shares";
  EXPECT_EQ(anew("CQUAD4,10,7,1,2,3,4,170.", -30), "CQUAD4,22,7,1,2,3,4,-160.0");
  EXPECT_EQ(anew("CQUAD4,10,7,1,2,3,4,-170.", 30), "CQUAD4,22,7,1,2,3,4,160.0");
  EXPECT_EQ(anew("CQUAD4,10,7,1,2,3,4,-150.", 30), "CQUAD4,22,7,1,2,3,4,180.0");
  EXPECT_EQ(anew("CQUAD4,10,7,1,2,3,4", 30), "CQUAD4,22,7,1,2,3,4,-30.0") << "no angle is one of 0";
}

TEST(NastranWriter, writes_ids_of_eight_digits_in_eight_columns_and_longer_ones_in_sixteen_or_between_commas) {
  const ShellCard wanted{10, {1, 12345678, 3, 4}, kSame, 0};
  EXPECT_EQ(kWriter->shell({"CQUAD4        10       7       1       2       3       4", 0, 0}, wanted)->text,
            "CQUAD4        10       7       112345678       3       4");
  const ShellCard longer{123456789, {1, 987654321, 3, 4}, kSame, 0};
  EXPECT_EQ(
      kWriter
          ->shell(
              {"CQUAD4*               10               7               1               2*\n*                      3               4", 0, 0},
              longer)
          ->text,
      "CQUAD4*        123456789               7               1       987654321\n*                      3               4");
  EXPECT_EQ(kWriter->new_node({"GRID    1               1.0     2.0     3.0", 0, 0}, 12345678, {1, 2.5, 0}).text,
            "GRID    12345678        1.0     2.5     0.0");
}

std::string joined(const std::string& text, const char* keyword, std::vector<std::int64_t> ids) {
  Referrer set;
  set.keyword = keyword;
  set.end = text.size();
  const auto replacements = kWriter->join(text, set, ids);
  if (!replacements) return replacements.error().message;
  std::string out = text;
  for (const Replacement& r : *replacements) out.replace(r.offset, r.length, r.text);
  return out;
}

TEST(NastranWriter, ids_join_lists) {
  EXPECT_EQ(joined("SPC1           7     123       1    THRU       9", "SPC1", {20, 21}),
            "SPC1           7     123       1    THRU       9\nSPC1           7     123      20      21");
  EXPECT_EQ(joined("SET1,7,1,2,3,4,5,6,7", "SET1", {20, 21}), "SET1,7,1,2,3,4,5,6,7\n+,20,21");
  EXPECT_EQ(joined("SET1,7,1,2", "SET1", {20, 21}), "SET1,7,1,2,20,21");
  EXPECT_EQ(joined("SET 4 = 1, 2 THRU 9", "SET", {20, 21}), "SET 4 = 1, 2 THRU 9,\n  20,21");
  EXPECT_EQ(joined("PLOAD2,7,1.5,1,2,3,4,5,6", "PLOAD2", {1, 2, 3, 4, 5, 6, 7}),
            "PLOAD2,7,1.5,1,2,3,4,5,6\nPLOAD2,7,1.5,1,2,3,4,5,6\nPLOAD2,7,1.5,7");
}

TEST(NastranWriter, large_cards_have_their_lines_in_pairs) {
  const std::string card = "SPC1*                  7             123               1\n*";
  EXPECT_EQ(joined(card, "SPC1", {20}), card + "\nSPC1*                  7             123              20\n*");
  EXPECT_EQ(joined("SPC1*,7,123,1\n*,", "SPC1", {20}), "SPC1*,7,123,1\n*,\nSPC1*,7,123,20\n*,");
}

TEST(NastranWriter, a_pressure_on_a_range_gets_cards_of_its_own_for_more) {
  // In fields 7 and 8, a further line holds the direction: nothing may be written behind the range.
  EXPECT_EQ(joined("PLOAD4        10   10144     1.5                            THRU   10145", "PLOAD4", {22051, 22052}),
            "PLOAD4        10   10144     1.5                            THRU   10145\n"
            "PLOAD4        10   22051     1.5\n"
            "PLOAD4        10   22052     1.5");
  EXPECT_EQ(joined("PLOAD4,10,4,1.5,1.5,,,THRU,9\n+,3,0.,0.,1.", "PLOAD4", {20}),
            "PLOAD4,10,4,1.5,1.5,,,THRU,9\n+,3,0.,0.,1.\nPLOAD4,10,20,1.5,1.5,,,,\n+,3,0.,0.,1.");
  EXPECT_NE(joined("PLOAD4,10,4,1.5,2.,,,THRU,9\n+,3,0.,0.,1.", "PLOAD4", {20}).find("different pressures"), std::string::npos)
      << "each piece would have all of what goes from corner to corner";
}

TEST(NastranWriter, lists_grow_only_where_their_entry_has_room) {
  const std::pair<std::string, std::string> without_continuation[] = {
      {"SESET,7,1,2,3,4,5,6,7", "\nSESET,7,20,21,22,23,24,25,26\nSESET,7,27"},
      {"SEELT,7,1", "\nSEELT,7,20,21,22,23,24,25,26\nSEELT,7,27"},
      {"RELEASE,7,123,1", "\nRELEASE,7,123,20,21,22,23,24,25\nRELEASE,7,123,26,27"},
      {"BNDGRID,123,1", "\nBNDGRID,123,20,21,22,23,24,25,26\nBNDGRID,123,27"},
      {"QVOL,7,1.,9,1", "\nQVOL,7,1.,9,20,21,22,23,24\nQVOL,7,1.,9,25,26,27"},
  };
  for (const auto& [card, more] : without_continuation)
    EXPECT_EQ(joined(card, card.substr(0, card.find(',')).c_str(), {20, 21, 22, 23, 24, 25, 26, 27}), card + more);
  for (const char* name : {"SPC1", "ASET1", "USET1", "SEBSET1", "QBDY1"}) {
    const std::string card = std::string(name) + (name[0] == 'A' ? ",123,1" : ",7,123,1");
    EXPECT_EQ(joined(card, name, {20}), card + "\n" + card.substr(0, card.rfind(',')) + ",20");
  }
  EXPECT_EQ(joined("ACCEL1,7,,1.,0.,0.,1.\n+,1,THRU,9", "ACCEL1", {20}), "ACCEL1,7,,1.,0.,0.,1.\n+,1,THRU,9,20");
  EXPECT_EQ(joined("SET3,7,GRID,1,THRU,9", "SET3", {20}), "SET3,7,GRID,1,THRU,9,20");
  EXPECT_EQ(joined("SET,7,GRID,LIST\n+,1", "SET", {20}), "SET,7,GRID,LIST\n+,1,20");
  EXPECT_EQ(joined("TEMPP1,7,1,1.\n+,2,3", "TEMPP1", {20}), "TEMPP1,7,1,1.\n+,2,3,20");
  for (const char* card : {"SET1,7,1,THRU,9", "BSURF,7,1,THRU,9", "ELIST,7,1,THRU,9", "TEMPP1,7,1,1.\n+,2,THRU,9", "SEEXCLD,1,2,1,THRU,9"})
    EXPECT_EQ(joined(card, std::string(card).substr(0, std::string(card).find(',')).c_str(), {20}),
              "names a range, which leaves no room for more ids");
  for (const char* card : {"BLSEG,7,1,2,3", "CNGRNT,1,2,3", "SOMENEW,1,2"})
    EXPECT_EQ(joined(card, std::string(card).substr(0, std::string(card).find(',')).c_str(), {20}), "has a list that can't take more ids");
}

std::string changed(const std::string& text, const char* keyword, std::vector<std::int64_t> joining, std::vector<std::int64_t> leaving) {
  Referrer set;
  set.keyword = keyword;
  set.end = text.size();
  const std::string file = text + "\nGRID,1\n";
  const auto replacements = kWriter->change_list(file, set, joining, leaving);
  if (!replacements) return replacements.error().message;
  std::string out = file;
  for (const Replacement& r : *replacements) out.replace(r.offset, r.length, r.text);
  EXPECT_EQ(out.substr(out.size() - 8), "\nGRID,1\n");
  return out.substr(0, out.size() - 8);
}

TEST(NastranWriter, ids_leave_lists) {
  EXPECT_EQ(changed("SPC1           7     123       1       2       3", "SPC1", {}, {2}), "SPC1           7     123       1       3");
  EXPECT_EQ(changed("SPC1,7,123,1,2,3,4,5,6\n+,7", "SPC1", {}, {1, 2}), "SPC1,7,123,3,4,5,6,7");
  EXPECT_EQ(changed("SPC1           7     123       1       2       3       4       5       6+A\n+A             7", "SPC1", {}, {7}),
            "SPC1           7     123       1       2       3       4       5       6+A");
  EXPECT_EQ(changed("SPC1,7,123,1,2", "SPC1", {20}, {2}), "SPC1,7,123,1\nSPC1,7,123,20");
  EXPECT_EQ(changed("SET1,7,1,2", "SET1", {20}, {1}), "SET1,7,2,20");
  EXPECT_EQ(changed("SPC1,7,123,1", "SPC1", {}, {1}), "would name nothing any more");
  EXPECT_EQ(changed("SET 4 = 1, 2, 3", "SET", {}, {1}), "SET 4 = 2, 3");
  EXPECT_EQ(changed("SET 4 = 1, 2, 3", "SET", {}, {3}), "SET 4 = 1, 2");
  EXPECT_EQ(changed("SET 4 = 1, 2,\n  3,\n  4 THRU 9 BY 2", "SET", {20}, {2, 3, 4, 9}), "SET 4 = 1,\n  4 THRU 9 BY 2,\n  20");
  EXPECT_EQ(changed("SET 4 = 1", "SET", {}, {1}), "would name nothing any more");
  EXPECT_EQ(changed("SET 4 = 1 THRU 9 EXCEPT 5, 20", "SET", {}, {20}), "ends with what it leaves out");
  EXPECT_NE(changed("SET 4 = 1 THRU 9 EXCEPT 5", "SET", {20}, {}).substr(0, 7), "SET 4 =") << "what is added would be left out";
  EXPECT_EQ(changed("SET 4 = 1, 2,\n$ why\n  3", "SET", {}, {3}), "has comments between its ids");
}

/// Two lines in columns, of which the second has another name than the first asks for.
std::string out_of_order(const std::string& first) { return first + std::string(72 - first.size(), ' ') + "+A\n+B             9"; }

struct RefusedList {
  const char* keyword;
  std::string text;
  std::vector<std::int64_t> joining, leaving;
  const char* why;
};

TEST(NastranWriter, lists_that_cant_change_say_why) {
  const std::string long_line = "  2, " + std::string(64, ' ') + "3";
  const RefusedList cases[] = {
      {"SET", "SET 4 1, 2", {}, {1}, "isn't read"},
      {"SET", "SET 4 = 1,\n" + long_line, {}, {1}, "would have a line that is too long"},
      {"SPC1", "SPC1,7,123,5\n=,8,==", {20}, {}, "is made by replication"},
      {"SPC1", "SPC1,7,123,5,6\n=,8,==", {}, {5}, "is made by replication"},
      {"SPC1", "=,8,==", {20}, {}, "is made by replication"},
      {"SET3", "SET3,7,GRID,1,2,EXCEPT,5", {20}, {1}, "ends with what it leaves out"},
      {"SET3", "SET3,7,GRID,1,THRU,9,EXCEPT,5", {20}, {}, "ends with what it leaves out"},
      {"PLOAD4", out_of_order("PLOAD4        10       1     1.5"), {20}, {}, "has continuations that aren't in order"},
      {"PLOAD4", "PLOAD4,10,1,1.5,,,,,,+,9", {20}, {}, "has continuations that aren't in order"},
      {"PLOAD4", "PLOAD4,10,1,1.5,,,,5", {20}, {}, "says by corners on which face it acts"},
      {"PLOAD4", "PLOAD4,10,1,1.5,,,,,5", {20}, {}, "says by corners on which face it acts"},
      {"PLOAD4", "PLOAD4,10,1,1.5,,2.", {20}, {}, "gives the corners different pressures"},
      {"SET1", out_of_order("SET1           7       1       2"), {20}, {}, "has lines that can't be continued"},
      {"SET1", "SET1,7,1,2,3,4,5,6,7,+,9,9", {20}, {}, "has lines that can't be continued"},
      {"SET", "SET,7,GRID,ALL", {20}, {}, "doesn't list its ids"},
      {"BLSEG", "BLSEG,7,1,2,3", {}, {1}, "has a list that ids can't be taken out of"},
      {"SET1", out_of_order("SET1           7       1       2"), {}, {1}, "has continuations that aren't in order"},
      {"SET1", "SET1,7,1,2,3,4,5,6,7,+,9,9", {}, {1}, "has continuations that aren't in order"},
      {"SPC1", "SPC1,7,123,1,THRU,9", {}, {5}, "has ranges beside the ids that would have to be taken out"},
  };
  for (const RefusedList& c : cases) EXPECT_EQ(changed(c.text, c.keyword, c.joining, c.leaving), c.why) << c.text;
}

TEST(NastranWriter, ids_leave_lists_in_the_manner_of_the_card) {
  EXPECT_EQ(changed("SPC1    7       123     1       2       3", "SPC1", {}, {1}), "SPC1    7       123     2       3");
  EXPECT_EQ(changed("SET1,7,1,2,3,4,5,6,7\n$ more\n+,8,9", "SET1", {}, {8}), "SET1,7,1,2,3,4,5,6,7\n$ more\n+,9");
  EXPECT_EQ(changed("SET1*                  7               1               2               3*\n*                      4", "SET1", {}, {1}),
            "SET1*                  7               2               3               4*");
  EXPECT_EQ(changed("SET 4 = 1, 2,\r\n  3", "SET", {}, {2}), "SET 4 = 1,\r\n  3");
}

TEST(NastranWriter, single_cards_that_cant_be_copied_say_why) {
  const auto refused = [](const std::string& text, const char* keyword) {
    Referrer card;
    card.keyword = keyword;
    Reference single;
    single.first = single.last = 1;
    const std::vector<std::int64_t> ids{20};
    const auto replacements = kWriter->copy_single(text, card, single, ids);
    return replacements ? (*replacements)[0].text : replacements.error().message;
  };
  EXPECT_EQ(refused("SPC,7,1,123,0.\n=,8,==", "SPC"), "is made by replication");
  EXPECT_EQ(refused("PLOAD4,7,1,1.5\n=,8,==", "PLOAD4"), "is made by replication");
  EXPECT_EQ(refused("PLOAD4,7,1,1.5,,,,5", "PLOAD4"), "says by corners on which face it acts");
}

TEST(NastranWriter, single_cards_are_copied) {
  const auto copied = [](const std::string& text, const char* keyword, Referred referred, std::int64_t named) {
    Referrer card;
    card.keyword = keyword;
    EXPECT_EQ(kWriter->inheritance(card, referred), Inheritance::follows);
    Reference single;
    single.first = single.last = named;
    const std::vector<std::int64_t> ids{20};
    const auto replacements = kWriter->copy_single(text, card, single, ids);
    return replacements ? (*replacements)[0].text : replacements.error().message;
  };
  EXPECT_EQ(copied("SPC,7,1,123,0.,2,456,.5", "SPC", Referred::node, 2), "\nSPC,7,20,456,.5");
  EXPECT_EQ(copied("PLOAD4         7       1     1.5", "PLOAD4", Referred::shell, 1), "\nPLOAD4         7      20     1.5");
  EXPECT_EQ(copied("PLOAD4,7,1,1.5,,1.50", "PLOAD4", Referred::shell, 1), "\nPLOAD4,7,20,1.5,,1.50");
  EXPECT_NE(copied("PLOAD4,7,1,1.5,,2.5", "PLOAD4", Referred::shell, 1).find("different pressures"), std::string::npos);
}

TEST(NastranSave, a_moved_node_changes_its_card_alone_whatever_its_system) {
  const DeckFolder folder;
  const std::string text =
      "SOL 101\r\nCEND\r\nBEGIN BULK\r\nCORD2C         1       0      1.      2.      3.      1.      2.      4.\r\n"
      "              2.      2.      3.\r\nGRID           1       1     10.     30.      5.\r\nGRID,2,,1.,2.,3.\r\nENDDATA\r\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  const Vec3 at = position_of(opened->model, 1);
  const Vec3 out = (Vec3(at.x(), at.y(), 3) - Vec3(1, 2, 3)).normalized();
  const auto moved = save(*opened->deck, opened->model, with_node_at(opened->model, 1, at + 2.5 * out), folder / "out.k");
  ASSERT_TRUE(moved) << moved.error().text();
  std::string wanted = text;
  wanted.replace(wanted.find("     10.     30."), 16, "    12.5     30.");
  EXPECT_EQ(content(folder / "out.k"), wanted);
}

/// A deck of one node in a cylindrical system at (1, 2, 3) whose z axis is the x axis and whose r axis is turned besides.
std::string turned_system(const std::string& grid) { return "BEGIN BULK\nCORD2C,7,,1.,2.,3.,2.,2.,3.\n,1.,2.6,3.8\n" + grid + "ENDDATA\n"; }

/// The text of the deck after a node was moved, its own cylindrical coordinates by `by`.
std::string moved_in_its_system(const DeckFolder& folder, const std::string& grid, double radius, double degrees, const Vec3& by) {
  const auto opened = folder.open(turned_system(grid));
  if (!opened) return opened.error().text();
  const auto place = [&](double r, double angle) {
    const double radians = angle * 3.14159265358979323846 / 180;
    return Vec3(r * std::cos(radians) * Vec3(0, 0.6, 0.8) + r * std::sin(radians) * Vec3(0, -0.8, 0.6));
  };
  const Vec3 at = position_of(opened->model, 1);
  const Vec3 to = at + place(radius + by[0], degrees + by[1]) - place(radius, degrees) + Vec3(by[2], 0, 0);
  const auto moved = save(*opened->deck, opened->model, with_node_at(opened->model, 1, to), folder / "out.k");
  if (!moved) return moved.error().text();
  return content(folder / "out.k");
}

TEST(NastranSave, an_angle_of_more_than_half_a_turn_keeps_its_turns) {
  const DeckFolder folder;
  EXPECT_EQ(moved_in_its_system(folder, "GRID,1,7,10.,390.,5.\n", 10, 390, Vec3(2.5, 0, 0)), turned_system("GRID,1,7,12.5,390.,5.\n"));
  EXPECT_EQ(moved_in_its_system(folder, "GRID,1,7,10.,-200.,5.\n", 10, -200, Vec3(2.5, 0, 0)), turned_system("GRID,1,7,12.5,-200.,5.\n"));
  const std::string text = moved_in_its_system(folder, "GRID*,1,7,10.,725.\n*,5.\n", 10, 725, Vec3(0, 20, 0));
  const std::size_t begin = text.find("GRID*,1,7,10.,");
  ASSERT_NE(begin, std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(begin + 14)), 745, 1e-9) << text;
}

TEST(NastranSave, in_a_turned_system_only_the_coordinates_that_change_are_written_however_little) {
  const DeckFolder folder;
  for (const auto& [radius, degrees] : {std::pair("10.1", "33.3"), std::pair("1234.567", "-71.9"), std::pair("0.377", "179.9")}) {
    const std::string place = std::string("GRID,1,7,") + radius + "," + degrees + ",";
    EXPECT_EQ(moved_in_its_system(folder, place + "5.\n", std::stod(radius), std::stod(degrees), Vec3(0, 0, 1e-4)),
              turned_system(place + "5.0001\n"));
  }
}

TEST(NastranSave, new_ids_fit_the_eight_columns_or_sixteen_of_their_cards) {
  const DeckFolder folder;
  const auto new_ids = [&](const std::string& star) {
    const auto opened =
        folder.open("GRID" + star + ",11,,0.,0.\nGRID" + star + ",12,,1.,0.\nGRID" + star + ",99999999,,1.,1.\nCTRIA3" + star +
                    ",99999999,1,11,12," + (star.empty() ? "" : "\n*,") + "99999999\nPSHELL,1,1,.1\nMAT1,1,1.,,.3\n");
    EXPECT_TRUE(opened) << opened.error().text();
    Growing edit(*opened);
    EXPECT_EQ(edit.model.shell_count(), 1u);
    return std::pair(edit.ids.node(edge_origin(edit.node(11), edit.node(12))).value_or(-1),
                     edit.ids.shell(edit.shell(99999999)).value_or(-1));
  };
  EXPECT_EQ(new_ids(""), (std::pair<std::int64_t, std::int64_t>(1, 1)));
  EXPECT_EQ(new_ids("*"), (std::pair<std::int64_t, std::int64_t>(100000000, 100000000)));
}

constexpr const char* kOneQuad =
    "GRID,11,,0.,0.\nGRID,12,,1.,0.\nGRID,13,,1.,1.\nGRID,14,,0.,1.\nCQUAD4,1,1,11,12,13,14\nPSHELL,1,1,.1\nMAT1,1,1.,,.3\n";

/// What comes to the deck's text when shell 1 is divided in four.
std::string comes_with_a_split(const DeckFolder& folder, const std::string& cards) {
  const auto opened = folder.open(kOneQuad + cards);
  if (!opened) return opened.error().text();
  Growing edit(*opened);
  edit.split_in_four(edit.shell(1));
  const auto saved = save(edit.deck, edit.original, edit.model, folder / "out.k");
  if (!saved) return saved.error().message;
  std::string out;
  for (const std::string& line : line_difference(content(folder / "deck.k"), content(folder / "out.k")).come)
    if (line.substr(0, 4) != "GRID" && line.substr(0, 6) != "CQUAD4") out += line + "\n";
  return out;
}

TEST(NastranSave, cards_of_one_set_constrain_together_what_lies_between) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string(kOneQuad) + "SPC1,1,123456,11\nSPC1,1,654321,12\n");
  ASSERT_OPENED(opened);
  Growing edit(*opened);
  edit.split_in_four(edit.shell(1));
  const std::int64_t between = edit.model.node_ids[edit.middle(edit.node(11), edit.node(12)).value];
  EXPECT_EQ(comes_with_a_split(folder, "SPC1,1,123456,11\nSPC1,1,654321,12\n"), "SPC1,1,123456," + std::to_string(between) + "\n");
  EXPECT_EQ(comes_with_a_split(folder, "SPC1,1,123456,11\nSPC1,1,123,12\n"), "");
  EXPECT_EQ(comes_with_a_split(folder, "SPC1,1,123456,11\nSPC1,2,123456,12\n"), "");
  EXPECT_EQ(comes_with_a_split(folder, "ASET1,123,11\nASET1,123,12\n"), "ASET1,123," + std::to_string(between) + "\n");
  EXPECT_EQ(comes_with_a_split(folder, "SPC1,1,123,11\nSPC1,1,123,11,12\n"), "SPC1,1,123," + std::to_string(between) + "\n");
}

TEST(NastranSave, a_pressure_on_a_range_acts_on_the_pieces_too) {
  const DeckFolder folder;
  const std::string come = comes_with_a_split(folder, "PLOAD4,10,1,1.5,,,,THRU,1\n");
  EXPECT_EQ(std::count(come.begin(), come.end(), '\n'), 3) << come;
  EXPECT_EQ(come.find("+"), std::string::npos) << come;
  EXPECT_EQ(come.find("PLOAD4,10,"), 0u) << come;
}

TEST(NastranSave, refusals_speak_as_the_deck_does) {
  const DeckFolder folder;
  const std::string refused = comes_with_a_split(folder, "BLSEG,7,11,12\n");
  EXPECT_EQ(refused.substr(0, 5), "BLSEG") << refused;
  EXPECT_EQ(refused.find('*'), std::string::npos) << refused;
}

TEST(NastranSave, a_new_node_stands_in_the_system_of_those_it_comes_from) {
  const DeckFolder folder;
  const std::string text =
      "CORD2C,7,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2S,8,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,11,7,2.,0.,5.\nGRID,12,7,4.,0.,5.\n"
      "GRID,13,7,4.,450.,5.\nGRID,14,7,2.,450.,5.\nGRID,15,8,2.,90.,-270.\nGRID,16,8,6.,90.,-270.\nCQUAD4,1,1,11,12,13,14\nPSHELL,1,1,.1\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  Growing edit(*opened);
  edit.middle(edit.node(11), edit.node(12));
  edit.middle(edit.node(13), edit.node(14));
  edit.middle(edit.node(15), edit.node(16));
  const auto saved = save(edit.deck, edit.original, edit.model, folder / "out.k");
  ASSERT_TRUE(saved) << saved.error().text();
  const LineDifference lines = line_difference(text, content(folder / "out.k"));
  EXPECT_EQ(lines.come, (std::vector<std::string>{"GRID,17,7,3.0,0.0,5.0", "GRID,18,7,3.0,450.0,5.0", "GRID,19,8,4.0,90.0,-270.0"}));
  EXPECT_TRUE(lines.gone.empty());
}

TEST(NastranSave, a_node_moves_in_its_spherical_system) {
  const DeckFolder folder;
  const std::string text = "CORD2S,8,,1.,2.,3.,1.,2.,4.\n,2.,2.,3.\nGRID,1,8,2.,90.,-270.\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  EXPECT_LT((position_of(opened->model, 1) - Vec3(1, 4, 3)).norm(), 1e-12);
  ASSERT_TRUE(save(*opened->deck, opened->model, with_node_at(opened->model, 1, {1, 4.5, 3}), folder / "out.k"));
  EXPECT_EQ(line_difference(text, content(folder / "out.k")).come, std::vector<std::string>{"GRID,1,8,2.5,90.,-270."});
  ASSERT_TRUE(save(*opened->deck, opened->model, with_node_at(opened->model, 1, {3, 2, 3}), folder / "out.k"));
  const std::string turned = line_difference(text, content(folder / "out.k")).come.at(0);
  EXPECT_EQ(turned.substr(0, 16), "GRID,1,8,2.,90.,") << "the two others stay";
  EXPECT_NEAR(std::stod(turned.substr(16)), -360, 1e-5) << turned;
}

/// Why an edit of the deck can't be saved.
std::string refusal_of(const DeckFolder& folder, const std::string& text, const std::function<void(Growing&)>& edit_it) {
  const auto opened = folder.open(text);
  if (!opened) return opened.error().text();
  Growing edit(*opened);
  edit_it(edit);
  const auto may = can_save(edit.deck, edit.original, edit.model);
  if (may) return "may be saved";
  EXPECT_EQ(may.error().file, (folder / "deck.k").string());
  return std::to_string(may.error().line) + ": " + may.error().message;
}

TEST(NastranSave, edits_that_cant_be_saved_name_the_card_that_forbids_them) {
  const DeckFolder folder;
  const auto split = [](Growing& edit) {
    const auto n = edit.model.shell(edit.shell(1)).node;
    set_shell_nodes(edit.model, edit.shell(1), {{n[0], n[1], n[2], n[2]}});
    edit.child(edit.shell(1), n[0], n[2], n[3], n[3]);
  };
  EXPECT_EQ(refusal_of(folder, std::string("GRID,1,,0.,0.,0.,,12\nGRID,2,,1.,0.,0.,,3\n"),
                       [](Growing& edit) { edit.middle(edit.node(1), edit.node(2)); }),
            "2: the new node 3 lies between nodes whose cards constrain them in different ways; nothing was written");
  EXPECT_EQ(refusal_of(folder, std::string(kOneQuad) + "=,*1,==\n", [](Growing& edit) { remove_shell(edit.model, edit.shell(1)); }),
            "may be saved")
      << "a MAT1 is copied";
  EXPECT_EQ(refusal_of(folder, "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nCTRIA3,1,1,1,2,3\n=,*1,==\n",
                       [](Growing& edit) { remove_shell(edit.model, edit.shell(2)); }),
            "5: shell 2 has no card that is its alone; it can't be removed; nothing was written");
  EXPECT_EQ(refusal_of(folder, "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nCTRIA3,1,1,1,2,3\n=,*1,==\n",
                       [](Growing& edit) { remove_shell(edit.model, edit.shell(1)); }),
            "4: shell 1 has no card that is its alone; it can't be removed; nothing was written");
  EXPECT_EQ(
      refusal_of(folder, "GRID,11,,0.,0.\nGRID,12,,1.,0.\nGRID,13,,1.,1.\nGRID,123456789,,0.,1.\nCQUAD4,1,1,11,12,13,123456789\n", split),
      "5: the new shell 2 has a node whose id doesn't fit the fields of its card; nothing was written")
      << "in free fields it can be read";
  EXPECT_EQ(refusal_of(folder, kOneQuad,
                       [](Growing& edit) {
                         const auto n = edit.model.shell(edit.shell(1)).node;
                         add_shell(edit.model, 100000000, {{n[0], n[1], n[2], n[2]}}, edit.shell(1));
                       }),
            "5: the new shell 100000000 has an id that doesn't fit the fields of the cards beside it; nothing was written");
  EXPECT_EQ(refusal_of(folder, std::string(kOneQuad) + "GRID,15,,.5,0.\nCQUAD8,2,1,11,12,13,14,15\n",
                       [](Growing& edit) { remove_node(edit.model, edit.node(15)); }),
            "8: node 15 can't be removed: shell 2 has it; nothing was written");
  EXPECT_EQ(refusal_of(folder, kOneQuad, [](Growing& edit) { edit.model.shell_thickness.set(0, 3.f); }),
            "5: shell 1 has another thickness than its card, which this version can't write; nothing was written");
}

TEST(NastranSave, told_to_stop_while_cards_are_made_it_writes_nothing) {
  const DeckFolder folder;
  const auto opened = folder.open(kOneQuad);
  ASSERT_OPENED(opened);
  const auto stopped = [&](const Growing& edit) {
    const auto saved = save(edit.deck, edit.original, edit.model, folder / "out.k", [](double) { return false; });
    EXPECT_FALSE(std::filesystem::exists(folder / "out.k"));
    return saved ? "saved" : saved.error().message;
  };
  Growing nodes(*opened);
  nodes.middle(nodes.node(11), nodes.node(12));
  EXPECT_EQ(stopped(nodes), cancelled().message);
  Growing shells(*opened);
  const auto n = shells.model.shell(shells.shell(1)).node;
  set_shell_nodes(shells.model, shells.shell(1), {{n[0], n[1], n[2], n[2]}});
  EXPECT_EQ(stopped(shells), cancelled().message);
}

TEST(NastranSave, a_node_that_spans_a_system_stays) {
  const DeckFolder folder;
  const auto opened = folder.open("CORD1R,1,1,2,3\nGRID,1\nGRID,2,,,,1.\nGRID,3,,1.\nGRID,4,1,1.,2.,3.\n");
  ASSERT_OPENED(opened);
  const auto refused = save(*opened->deck, opened->model, with_node_at(opened->model, 3, {2, 0, 0}), folder / "out.k");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 4);
  EXPECT_NE(refused.error().message.find("spans a coordinate system"), std::string::npos) << refused.error().message;
  EXPECT_TRUE(save(*opened->deck, opened->model, with_node_at(opened->model, 4, {2, 0, 0}), folder / "out.k"));
}

}  // namespace
}  // namespace prismesh::mesh::deck
