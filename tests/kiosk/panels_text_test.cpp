// Numbers, names and paths as panels show them.
#include "kiosk/panels/text.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace prismesh::kiosk::panels {
namespace {

double bytes(std::string_view text) { return static_cast<double>(text.size()); }

TEST(PanelTextTest, numbers_are_grouped_by_threes) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1\u00a0000");
  EXPECT_EQ(grouped(1048576), "1\u00a0048\u00a0576");
}

TEST(PanelTextTest, lengths_carry_their_unit_and_zero_no_sign) {
  EXPECT_EQ(length_text(12.3456, "mm"), "12.35\u00a0mm");
  EXPECT_EQ(length_text(-0.0519, "m"), "-0.0519\u00a0m");
  EXPECT_EQ(length_text(-0.0, "in"), "0\u00a0in");
}

TEST(PanelTextTest, bytes_that_are_no_text_are_written_out) {
  EXPECT_EQ(printable("T\u00fcr"), "T\u00fcr");
  EXPECT_EQ(printable("T\xfcr"), "T\\xfcr");
  EXPECT_EQ(printable("a\tb\x7f"), "a\\x09b\\x7f");
  EXPECT_EQ(printable(std::string_view("\xe2\x82", 2)), "\\xe2\\x82");  // cut off in the middle
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");              // half of a surrogate pair
}

TEST(PanelTextTest, long_names_lose_their_middle_and_keep_their_ends) {
  EXPECT_EQ(elide_middle("short.k", 20, bytes), "short.k");
  const std::string shown = elide_middle("a_very_long_name_of_a_deck_v135.k", 16, bytes);
  EXPECT_LE(shown.size(), 16u);
  EXPECT_TRUE(shown.starts_with("a_very"));
  EXPECT_TRUE(shown.ends_with("v135.k"));
  EXPECT_NE(shown.find("\u2026"), std::string::npos);
}

TEST(PanelTextTest, eliding_never_cuts_a_character_and_survives_no_room) {
  const std::string name = "\u00e4\u00f6\u00fc\u00e4\u00f6\u00fc\u00e4\u00f6\u00fc";
  for (int room = 0; room < 20; ++room) EXPECT_EQ(printable(elide_middle(name, room, bytes)), elide_middle(name, room, bytes));
  EXPECT_EQ(elide_middle("", -5, bytes), "");
  EXPECT_EQ(elide_middle("abc", -5, bytes), "\u2026");
}

TEST(PanelTextTest, lines_break_between_words_never_within_a_number) {
  EXPECT_EQ(break_at_spaces("moved by -0.03 mm", 40, bytes), "moved by -0.03 mm");
  EXPECT_EQ(break_at_spaces("moved by -0.03 mm", 12, bytes), "moved by\n-0.03 mm");
  EXPECT_EQ(break_at_spaces("one two\nthree four", 7, bytes), "one two\nthree\nfour") << "a line feed begins a line";
  EXPECT_EQ(break_at_spaces("a_word_wider_than_the_panel x", 5, bytes), "a_word_wider_than_the_panel\nx");
  EXPECT_EQ(break_at_spaces("", 5, bytes), "");
  EXPECT_EQ(break_at_spaces("x", -1, bytes), "x");
}

class CompletionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("prismesh_completion_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_ / "decks");
    for (const char* name : {"door.k", "door_v2.k", "roof.k", ".hidden.k"}) std::ofstream(folder_ / name) << "*END\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string in(const std::string& name) const { return folder_.string() + "/" + name; }

  std::filesystem::path folder_;
};

TEST_F(CompletionTest, a_path_is_completed_from_its_folder) {
  EXPECT_EQ(completions(in("do"), 10), (std::vector<std::string>{in("door.k"), in("door_v2.k")}));
  EXPECT_EQ(completions(in(""), 10), (std::vector<std::string>{in("decks/"), in("door.k"), in("door_v2.k"), in("roof.k")}));
  EXPECT_EQ(completions(in(".h"), 10), (std::vector<std::string>{in(".hidden.k")}));
  EXPECT_EQ(completions(in(""), 2).size(), 2u);
}

TEST_F(CompletionTest, a_folder_that_is_not_there_offers_nothing) { EXPECT_TRUE(completions(in("nowhere/x"), 10).empty()); }

TEST_F(CompletionTest, the_common_beginning_is_what_tab_fills_in) {
  EXPECT_EQ(common_beginning(completions(in("d"), 10)), in("d"));
  EXPECT_EQ(common_beginning(completions(in("do"), 10)), in("door"));
  EXPECT_EQ(common_beginning({}), "");
}

}  // namespace
}  // namespace prismesh::kiosk::panels
