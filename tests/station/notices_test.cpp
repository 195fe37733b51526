// The kiosk's notices on a deck: the worst first, none on a closed deck, and a list of all.
#include <fstream>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class NoticesTest : public StationTestCase {
 protected:
  /// The sheet with an unknown last card and a missing include file.
  std::filesystem::path write_deck_without_its_include(const std::string& name) const {
    std::string text = original_;
    text.insert(text.find("*END"), "*INCLUDE\nlost.k\n");
    const std::filesystem::path file = station_->folder() / name;
    std::ofstream(file) << text;
    return file;
  }
  void open(const std::filesystem::path& deck) {
    station_->key("ctrl+o");
    station_->key("ctrl+a");
    station_->type(deck.string());
    station_->key("Return");
    ASSERT_FALSE(station_->kiosk().wait_for("document " + deck.string()).empty());
  }
};

TEST_F(NoticesTest, a_missing_include_is_said_first_and_the_list_has_every_warning) {
  std::filesystem::rename(write_deck_without_its_include("incomplete.k"), station_->deck());
  station_->start_kiosk();
  const std::string notice = station_->kiosk().last("notice ");
  EXPECT_TRUE(notice.starts_with("notice error")) << notice;
  EXPECT_NE(notice.find("lost.k"), std::string::npos) << notice;
  EXPECT_EQ(notice.find("prismesh info"), std::string::npos) << "what is wrong can be read here";
  station_->key("ctrl+i");
  EXPECT_EQ(station_->kiosk().wait_for("warnings "), "warnings shown errors 1 warnings 1");
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  station_->show_people("warnings");
  station_->key("Escape");
  EXPECT_EQ(station_->kiosk().wait_for("warnings "), "warnings closed");
}

TEST_F(NoticesTest, what_was_said_of_a_deck_goes_when_another_is_opened) {
  station_->start_kiosk();
  ASSERT_FALSE(station_->kiosk().last("reads warning").empty()) << "the warning on the unknown card is missing";
  const std::filesystem::path other = write_deck_without_its_include("other.k");
  station_->kiosk().skip_lines();
  open(other);
  EXPECT_NE(station_->kiosk().wait_for("reads ").find("lost.k"), std::string::npos);
  station_->kiosk().skip_lines();
  station_->key("Escape");
  EXPECT_EQ(station_->kiosk().wait_for("reads "), "reads none") << "a notice on the first deck is still in the list";
}

}  // namespace
}  // namespace prismesh::test
