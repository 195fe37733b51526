// The panels about the view, driven as a hand drives them: by what is on the screen.
#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

using testing::HasSubstr;

class FrameTest : public StationTestCase {
 protected:
  /// The state of an item, once it says that.
  void expect_state(const std::string& name, const std::string& words) {
    const auto says = [&] {
      const auto item = station_->item(name);
      return item && item->state.find(words) != std::string::npos;
    };
    if (says()) return;
    const std::string beginning = "item \"" + name + "\" ";
    EXPECT_FALSE(
        station_->kiosk()
            .wait_until([&](const std::string& line) { return line.starts_with(beginning) && line.find(words) != std::string::npos; })
            .empty())
        << name << " never said " << words;
  }
  /// The box around all nodes on the screen: left, top, right, bottom.
  std::array<double, 4> box() {
    const Station::Aim aim = station_->settled_aim();
    std::array<double, 4> box{1e9, 1e9, -1e9, -1e9};
    for (const auto& [id, point] : nodes_) {
      const auto [x, y] = aim.pixel_of(point);
      box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
    }
    return box;
  }
  void expect_in_the_middle_of_the_view() {
    const auto [left, top, right, bottom] = box();
    const Station::Item view = *station_->item("view");
    EXPECT_GE(left, view.x);
    EXPECT_GE(top, view.y);
    EXPECT_LE(right, view.x + view.width);
    EXPECT_LE(bottom, view.y + view.height);
    // The view is fitted to the box about the model, whose corners nothing reaches.
    EXPECT_NEAR(0.5 * (left + right), view.middle()[0], 0.03 * view.width);
    EXPECT_NEAR(0.5 * (top + bottom), view.middle()[1], 0.03 * view.height);
    EXPECT_GE(std::max((right - left) / view.width, (bottom - top) / view.height), 0.7) << "it fills the view";
  }
};

TEST_F(FrameTest, the_model_fills_what_the_panels_leave_in_mono_and_stereo) {
  station_->start_kiosk();
  expect_in_the_middle_of_the_view();
  for (const char* profile : {"anaglyph", "side-by-side", "mono"}) {
    if (station_->item("menu Menu")) {  // the large type of stereo has no room for all of them
      station_->click_item("menu Menu");
      ASSERT_FALSE(station_->kiosk().wait_for("item \"menu Display\"").empty());
      station_->settled_aim();
    }
    station_->click_item("menu Display");
    ASSERT_FALSE(station_->kiosk().wait_for(std::string("item \"display ") + profile).empty());
    station_->settled_aim();
    station_->kiosk().skip_lines();
    station_->click_item(std::string("display ") + profile);
    ASSERT_FALSE(station_->kiosk().wait_for(std::string("profile ") + profile).empty());
    station_->settled_aim();
    station_->key("f");
    expect_in_the_middle_of_the_view();
    station_->show_people(profile);
  }
}

TEST_F(FrameTest, a_limit_of_video_memory_is_kept_to_and_said) {
  const std::filesystem::path settings = station_->folder() / "kiosk.toml";
  std::ofstream(settings) << "[display]\nprofile = \"mono\"\nvideo_memory_mb = 40\n";
  station_->start_kiosk({"--config", settings.string()});
  station_->settled_aim();
  const std::string said = station_->kiosk().last("notice warning Video memory ");
  EXPECT_THAT(said, HasSubstr("is limited to 40 MB (video_memory_mb). To keep to it, edges aren't smoothed"));
  EXPECT_THAT(said, testing::Not(HasSubstr("exceeded")));
  int told = 0;
  for (const std::string& line : lines_of(station_->kiosk().all_output())) {
    int held = 0, limit = 0;
    if (std::sscanf(line.c_str(), "video memory %d of %d MB", &held, &limit) != 2) continue;
    ++told;
    EXPECT_EQ(limit, 40);
    EXPECT_LE(held, limit) << line;
    EXPECT_GT(held, 10) << line;
  }
  EXPECT_GT(told, 0);
}

TEST_F(FrameTest, the_rail_takes_tools_in_hand_and_the_status_line_says_which) {
  station_->start_kiosk();
  expect_state("status setting", "Select");
  const std::pair<const char*, const char*> tools[] = {{"Pull", "Pull"},       {"Quality", "Quality"}, {"Contact", "Contact"},
                                                       {"Compare", "Compare"}, {"Mesh", "Mesh"},       {"Select", "Select"}};
  for (const auto& [button, words] : tools) {
    station_->click_item(std::string("rail ") + button);
    expect_state(std::string("rail ") + button, "on");
    expect_state("status setting", words);
  }
  station_->click_item("rail Pull");
  expect_state("option mirror", "off");
  station_->click_item("option mirror");
  expect_state("option mirror", "x");
  expect_state("status setting", "mirror x");
}

TEST_F(FrameTest, undo_and_save_are_seen_and_clicked) {
  station_->start_kiosk();
  expect_state("save", "saved");
  expect_state("undo", "can't");
  const auto selected = station_->select_middle();
  expect_state("status selection", std::to_string(selected.size()) + " nodes selected");
  expect_state("undo", "can");
  station_->settled_aim();
  station_->click_item("undo");
  ASSERT_TRUE(station_->wait_for_selection(0));
  expect_state("redo", "can");
  station_->settled_aim();
  station_->click_item("redo");
  ASSERT_TRUE(station_->wait_for_selection(selected.size()));
}

TEST_F(FrameTest, what_is_under_the_pointer_is_told) {
  station_->start_kiosk();
  const std::int64_t id = std::next(nodes_.begin(), static_cast<long>(nodes_.size() / 2))->first;
  const auto [x, y] = station_->settled_aim().pixel_of(nodes_.at(id));
  station_->move(x, y);
  expect_state("status pointed", "node " + std::to_string(id) + " ");
  EXPECT_THAT(station_->item("status pointed")->state, HasSubstr("part 7 Roof panel"));
  const Station::Item view = *station_->item("view");
  station_->move(view.x + 8, view.y + 8);
  EXPECT_FALSE(station_->kiosk().wait_for("item \"status pointed\" gone").empty()) << "nothing is there";
}

TEST_F(FrameTest, an_open_menu_has_pointer_and_esc_to_itself) {
  station_->start_kiosk();
  const auto selected = station_->select_middle();
  const std::string generation = station_->kiosk().last("generation ");
  const auto [x, y] = station_->settled_aim().pixel_of(nodes_.begin()->second);
  for (const bool by_key : {true, false}) {
    station_->click_item("menu Parts");
    ASSERT_FALSE(station_->kiosk().wait_for("item \"entry ").empty());
    station_->settled_aim();
    if (by_key)
      station_->key("Escape");
    else
      station_->click(x, y);
    station_->settled_aim();
    EXPECT_FALSE(station_->item("entry show all parts")) << "the menu is closed";
  }
  EXPECT_EQ(station_->kiosk().last("generation "), generation) << "the selection stays";
}

TEST_F(FrameTest, a_dragged_border_moves_the_model_along_and_is_kept) {
  station_->start_kiosk();
  const Station::Item before = *station_->item("view");
  const auto border = station_->item("border dock")->middle();
  station_->drag(border[0], border[1], border[0] - 60, border[1]);
  station_->settled_aim();
  const Station::Item after = *station_->item("view");
  EXPECT_NEAR(after.width, before.width - 60, 6);
  station_->key("f");
  expect_in_the_middle_of_the_view();
  station_->open_in_another_kiosk(station_->deck());
  ASSERT_FALSE(station_->kiosk()
                   .wait_until([](const std::string& line) { return line.starts_with("picture ") && !line.ends_with("none"); })
                   .empty());
  station_->settled_aim();
  EXPECT_EQ(station_->item("view")->width, after.width);
}

TEST_F(FrameTest, a_command_is_found_by_its_words_and_carried_out) {
  station_->start_kiosk({"--title", "The sheet as it was drawn"});
  EXPECT_TRUE(says("guidance", "The sheet as it was drawn"));
  station_->key("ctrl+p");
  station_->type("single creases pie");
  station_->key("Return");
  station_->settled_aim();
  station_->key("Escape");
  station_->kiosk().skip_lines();
  station_->key("ctrl+p");
  station_->type("quality figures");
  ASSERT_FALSE(station_->kiosk()
                   .wait_until([](const std::string& line) {
                     return line.starts_with("item \"found Mesh: quality: show or hide") && line.ends_with("chosen");
                   })
                   .empty());
  station_->key("Return");
  EXPECT_FALSE(station_->kiosk().wait_for("panel quality").empty());
  station_->key("ctrl+p");
  EXPECT_FALSE(station_->kiosk()
                   .wait_until([](const std::string& line) {
                     return line.starts_with("item \"found Mesh: quality: show or hide") && line.ends_with("chosen");
                   })
                   .empty())
      << "what was used last comes first";
  station_->show_people("find");
}

TEST_F(FrameTest, a_word_typed_beside_a_field_edits_nothing_and_goes_to_the_search) {
  station_->start_kiosk();
  station_->select_middle();
  station_->settled_aim();
  const std::string generation = station_->kiosk().last("generation ");
  for (const char* word : {"hood", "grow", "fork", "body"}) {
    station_->kiosk().skip_lines();
    station_->type(word);
    EXPECT_FALSE(station_->kiosk().wait_for("item \"find field\"").empty()) << word;
    station_->key("Escape");
    station_->settled_aim();
  }
  EXPECT_EQ(station_->kiosk().last("generation "), generation) << "nothing was hidden, grown or inverted";
  station_->kiosk().skip_lines();
  for (int of_two = 0; of_two < 2; ++of_two) station_->key("g");
  EXPECT_FALSE(station_->kiosk().wait_for("generation ").empty());
  EXPECT_FALSE(station_->kiosk().wait_for("generation ").empty()) << "the same letter twice is that key twice";
  station_->settled_aim();
  const std::string grown = station_->kiosk().last("generation ");
  station_->kiosk().skip_lines();
  station_->type("car");  // the last letter would select a region
  EXPECT_FALSE(station_->kiosk().wait_for("item \"find field\"").empty());
  station_->key("Escape");
  station_->settled_aim();
  EXPECT_EQ(station_->kiosk().last("generation "), grown);
}

TEST_F(FrameTest, an_id_is_flown_to_and_marked) {
  station_->start_kiosk();
  const std::int64_t id = nodes_.begin()->first;
  for (const std::string& typed : {std::to_string(id), "node " + std::to_string(id)}) {
    station_->kiosk().skip_lines();
    station_->key("ctrl+p");
    station_->type(typed);
    ASSERT_FALSE(station_->kiosk().wait_for("item \"found node " + std::to_string(id)).empty());
    station_->key("Return");
    ASSERT_FALSE(station_->kiosk().wait_for("gone to node " + std::to_string(id)).empty());
  }
  const auto at = station_->settled_aim().pixel_of(nodes_.at(id));
  const auto middle = station_->item("view")->middle();
  EXPECT_NEAR(at[0], middle[0], 2);
  EXPECT_NEAR(at[1], middle[1], 2);
  station_->show_people("gone_to");
  const std::string generation = station_->kiosk().last("generation ");
  station_->key("Escape");
  station_->settled_aim();
  EXPECT_EQ(station_->kiosk().last("generation "), generation) << "Esc takes the mark away first";
  station_->kiosk().skip_lines();
  station_->key("ctrl+p");
  station_->type("node 999999999");
  EXPECT_FALSE(station_->kiosk().wait_for("item \"find field\"").empty());
  station_->key("Return");
  station_->settled_aim();
  EXPECT_TRUE(station_->item("find field")) << "nothing was taken";
}

TEST_F(FrameTest, the_menu_under_the_pointer_acts_there) {
  station_->start_kiosk();
  const std::int64_t id = std::next(nodes_.begin(), static_cast<long>(nodes_.size() / 2))->first;
  const auto [x, y] = station_->settled_aim().pixel_of(nodes_.at(id));
  for (const bool by_key : {true, false}) {
    station_->kiosk().skip_lines();
    station_->move(x, y);
    if (by_key)
      station_->key("space");
    else
      station_->click(x, y, 3);
    expect_state("menu at pointer", "node " + std::to_string(id) + " ");
    station_->settled_aim();
    station_->show_people("menu_at_pointer");
    station_->kiosk().skip_lines();
    station_->click_item("entry select the region under the pointer");
    EXPECT_FALSE(station_->kiosk()
                     .wait_until([](const std::string& line) {
                       return line.starts_with("generation ") && line.find("selected 0") == std::string::npos;
                     })
                     .empty())
        << "the region of the node that the pointer was on";
    station_->settled_aim();
    if (by_key) {
      for (int of_the_warning_and_of_the_selection = 0; of_the_warning_and_of_the_selection < 2; ++of_the_warning_and_of_the_selection)
        station_->key("Escape");
      ASSERT_TRUE(station_->wait_for_selection(0));
    }
  }
}

}  // namespace
}  // namespace prismesh::test
