// Mouse and keyboard in the picture: turning, shifting and zooming the view, rectangles, hiding, the ring, and the display profiles.
#include <cmath>
#include <cstdlib>
#include <set>
#include <thread>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/station/station.h"

namespace prismesh::test {
namespace {

using Pixel = std::array<double, 2>;

double distance(const Pixel& a, const Pixel& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

class HandTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_programs(); !missing.empty())
      GTEST_SKIP() << "SKIPPED: the station can't be tested here, install " << missing;
    station_ = std::make_unique<Station>();
  }
  /// The sheet, and its nodes.
  void start_with_sheet(const std::vector<std::string>& arguments = {}) {
    original_ = whole_file(station_->deck());
    nodes_ = nodes_of_deck(original_);
    station_->start_kiosk(arguments);
  }
  /// The closed hat seen from above.
  void start_with_hat() {
    hat_ = write_closed_hat(station_->deck());
    station_->start_kiosk();
    station_->kiosk().skip_lines();
    station_->key("5");
    ASSERT_FALSE(station_->kiosk().wait_for("aim ").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  }
  /// Waits for an aim that `wanted` accepts; false if none came.
  template <class Wanted>
  bool wait_for_aim(const Wanted& wanted) {
    return !station_->kiosk()
                .wait_until([&](const std::string& line) { return line.starts_with("aim ") && wanted(Station::aim_from(line)); })
                .empty();
  }
  /// A rectangle around the whole hat; the number of nodes it selected.
  std::size_t select_all_in_sight() {
    Pixel low{1e9, 1e9}, high{-1e9, -1e9};
    for (const auto* nodes : {&hat_.hat, &hat_.plate})
      for (const auto& [id, point] : *nodes)
        for (std::size_t i = 0; i < 2; ++i) {
          const double at = station_->pixel_of(point)[i];
          low[i] = std::min(low[i], at), high[i] = std::max(high[i], at);
        }
    station_->kiosk().skip_lines();
    station_->drag_rectangle(low[0] - 5, low[1] - 5, high[0] + 5, high[1] + 5);
    return selected_now();
  }
  /// Of the next generation.
  std::size_t selected_now() {
    std::stringstream line(station_->kiosk().wait_for("generation "));
    std::string word;
    std::size_t generation = 0, selected = 0;
    line >> word >> generation >> word >> selected;
    EXPECT_TRUE(line) << "there was no new generation";
    return selected;
  }
  /// Takes the ring beside its arrow and drags it; the button stays down and a preview is seen.
  void pull_ring(double dx, double dy) {
    const auto at = station_->handle();
    ASSERT_TRUE(at.has_value()) << "there is no handle";
    const double length = std::hypot(at->tip_x - at->foot_x, at->tip_y - at->foot_y);
    const double x = at->foot_x - 7 * (at->tip_x - at->foot_x) / length, y = at->foot_y - 7 * (at->tip_y - at->foot_y) / length;
    station_->kiosk().skip_lines();
    station_->move(x, y);
    station_->press();
    for (const double part : {0.5, 1.0}) station_->move(std::round(x) + part * dx, std::round(y) + part * dy);
    ASSERT_FALSE(station_->kiosk().wait_for("drag begun").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("drag shown").empty());
  }
  void let_go() {
    station_->release();
    ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  }

  std::unique_ptr<Station> station_;
  std::string original_;
  std::map<std::int64_t, Point> nodes_;
  HatDeck hat_;
};

TEST_F(HandTest, turning_shifting_and_zooming_change_the_view_and_nothing_else) {
  start_with_sheet();
  station_->select_middle();
  const std::string generation = station_->kiosk().last("generation ");
  const Point pivot = nodes_.at(kFirstNode + 8 * kSheetSide + 8), corner = nodes_.rbegin()->second;

  const auto before = station_->aim();
  const Pixel at = before.pixel_of(pivot);
  station_->kiosk().skip_lines();
  station_->drag(at[0], at[1], at[0] + 120, at[1], 3);
  ASSERT_TRUE(wait_for_aim([&](const Station::Aim& aim) {
    return distance(aim.pixel_of(pivot), at) < 1 && distance(aim.pixel_of(corner), before.pixel_of(corner)) > 40;
  })) << "the model turns about the node under the pointer";

  const auto turned = station_->aim();
  const Pixel from = turned.pixel_of(pivot), to{from[0] + 90, from[1] + 40};
  station_->drag(from[0], from[1], to[0], to[1], 2);
  ASSERT_TRUE(wait_for_aim([&](const Station::Aim& aim) { return distance(aim.pixel_of(pivot), to) < 1.5; }))
      << "what was under the pointer stays under it";

  const auto shifted = station_->aim();
  const Pixel held = shifted.pixel_of(pivot);
  const double apart = distance(held, shifted.pixel_of(corner));
  station_->click(held[0], held[1], 4);
  ASSERT_TRUE(wait_for_aim([&](const Station::Aim& aim) {
    const double now = distance(aim.pixel_of(pivot), aim.pixel_of(corner));
    return distance(aim.pixel_of(pivot), held) < 1.5 && now > apart * 1.08 && now < apart * 1.25;
  })) << "a step of the wheel brings nearer what is under the pointer";
  station_->click(held[0], held[1], 5);
  ASSERT_TRUE(
      wait_for_aim([&](const Station::Aim& aim) { return std::abs(distance(aim.pixel_of(pivot), aim.pixel_of(corner)) - apart) < 1; }));

  EXPECT_EQ(station_->kiosk().last("generation "), generation);
  EXPECT_EQ(station_->save_copy("looked_at.k"), original_);
}

TEST_F(HandTest, a_rectangle_takes_what_is_seen_or_all_through_the_model) {
  start_with_hat();
  const std::size_t seen = select_all_in_sight();
  EXPECT_LE(seen, hat_.hat.size()) << "the hat hides its plate";
  EXPECT_GT(seen, hat_.hat.size() * 9 / 10);
  station_->key("v");
  EXPECT_EQ(select_all_in_sight(), hat_.hat.size() + hat_.plate.size());
}

TEST_F(HandTest, a_part_that_was_hidden_is_not_picked_until_it_is_shown_again) {
  start_with_hat();
  const Pixel roof = station_->pixel_of({4, 57, 30}), node = station_->pixel_of({50, 60, 0});
  ASSERT_GT(distance(node, station_->pixel_of({40, 60, -3})), 20) << "the plate must be out of a click's reach";
  station_->kiosk().skip_lines();
  station_->click(node[0], node[1]);
  ASSERT_TRUE(station_->wait_for_selection(1));

  station_->move(roof[0], roof[1]);
  station_->key("h");
  ASSERT_TRUE(station_->wait_for_selection(0)) << "what is hidden isn't selected";
  EXPECT_EQ(select_all_in_sight(), hat_.plate.size());
  station_->click(node[0], node[1]);
  ASSERT_TRUE(station_->wait_for_selection(0)) << "only the background is left where the hat was";

  station_->key("s");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  station_->click(node[0], node[1]);
  ASSERT_TRUE(station_->wait_for_selection(1));

  station_->move(roof[0], roof[1]);
  station_->key("o");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  station_->key("v");
  EXPECT_EQ(select_all_in_sight(), hat_.hat.size()) << "only the hat is left, through the model too";
}

TEST_F(HandTest, the_ring_moves_the_selection_in_the_plane_of_the_screen) {
  start_with_sheet();
  const std::vector<std::int64_t> selected = station_->select_middle();
  const auto aim = station_->aim();
  pull_ring(60, 25);
  let_go();
  const std::string saved = station_->save_copy("moved.k");
  const DeckDifference difference = compare_decks(original_, saved);
  EXPECT_TRUE(difference.same_line_count && difference.other_changes.empty());
  const std::map<std::int64_t, Point> after = nodes_of_deck(saved);
  const std::set<std::int64_t> allowed(selected.begin(), selected.end());
  double farthest = 0;
  for (const std::int64_t id : difference.nodes) {
    EXPECT_TRUE(allowed.contains(id)) << "node " << id << " moved but was not selected";
    Point by{};
    for (std::size_t i = 0; i < 3; ++i) by[i] = after.at(id)[i] - nodes_.at(id)[i];
    const double length = std::hypot(by[0], by[1], by[2]);
    const double steepest = std::hypot(aim.m[3], aim.m[7], aim.m[11]);
    EXPECT_NEAR(aim.depth_of(by), 0, steepest * (1e-3 * length + 2e-6)) << "node " << id << " changed its depth";
    const Pixel was = aim.pixel_of(nodes_.at(id)), is = aim.pixel_of(after.at(id));
    if (distance(was, is) > farthest) {
      farthest = distance(was, is);
      EXPECT_NEAR((is[1] - was[1]) * 60, (is[0] - was[0]) * 25, 60 * 2) << "node " << id << " moved in another direction than the pointer";
    }
  }
  EXPECT_NEAR(farthest, std::hypot(60, 25), 2) << "the grab follows the pointer";
}

TEST_F(HandTest, the_part_below_the_pointer_is_highlighted_and_named_and_no_scene_is_drawn_for_it) {
  start_with_sheet();
  station_->select_middle();
  station_->settled_aim();
  const auto at = station_->handle();
  ASSERT_TRUE(at.has_value());
  const std::string scenes = station_->kiosk().last("scenes ");
  ASSERT_FALSE(scenes.empty());
  const Pixel foot{at->foot_x, at->foot_y}, tip{at->tip_x, at->tip_y};
  const double length = distance(foot, tip);
  const Pixel along{(tip[0] - foot[0]) / length, (tip[1] - foot[1]) / length};
  const auto green = [&](const Pixel& pixel) {
    const Station::Pixels picture = station_->window_pixels();
    const auto first =
        3 * (static_cast<std::size_t>(pixel[1]) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(pixel[0]));
    const auto value = [&](std::size_t c) { return static_cast<int>(static_cast<unsigned char>(picture.rgb[first + c])); };
    return value(1) - (value(0) + value(2)) / 2;
  };
  const Pixel middle{foot[0] + 0.6 * (tip[0] - foot[0]), foot[1] + 0.6 * (tip[1] - foot[1])};
  const int before = green(middle);
  const std::tuple<const char*, const char*, Pixel> parts[] = {
      {"drag: lift", "hand_lift", tip},
      {"drag: move", "hand_move", {foot[0] - 7 * along[0], foot[1] - 7 * along[1]}},
      {"drag: slide", "hand_slide", {foot[0] - 22 * along[1], foot[1] + 22 * along[0]}}};
  for (const auto& [words, name, pixel] : parts) {
    station_->move(pixel[0], pixel[1]);
    station_->settled_aim();
    const auto said = station_->item("hand");
    ASSERT_TRUE(said.has_value()) << words;
    EXPECT_EQ(said->state, words);
    if (words == std::string("drag: lift")) {
      EXPECT_GT(green(middle), before + 40) << "the whole arrow is lit";
    }
    station_->show_people(name);
  }
  const Station::Item view = *station_->item("view");
  station_->move(view.x + 8, view.y + 8);
  station_->settled_aim();
  EXPECT_FALSE(station_->item("hand").has_value());
  EXPECT_NEAR(green(middle), before, 3);
  EXPECT_EQ(station_->kiosk().last("scenes "), scenes) << "what is highlighted lies over the picture";
}

TEST_F(HandTest, a_rigid_pull_moves_all_selected_nodes_alike) {
  start_with_sheet();
  const std::vector<std::int64_t> selected = station_->select_middle();
  station_->key("t");
  station_->settled_aim();
  ASSERT_TRUE(station_->item("option moves").has_value());
  EXPECT_EQ(station_->item("option moves")->state, "falloff");
  station_->click_item("option moves");
  station_->settled_aim();
  EXPECT_EQ(station_->item("option moves")->state, "rigid");
  station_->show_people("rigid");
  pull_ring(60, 25);
  let_go();
  const std::map<std::int64_t, Point> after = nodes_of_deck(station_->save_copy("rigid.k"));
  const Point &first = nodes_.at(selected.front()), &moved = after.at(selected.front());
  EXPECT_GT(std::hypot(moved[0] - first[0], moved[1] - first[1], moved[2] - first[2]), 1);
  for (const std::int64_t id : selected)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(after.at(id)[i] - nodes_.at(id)[i], moved[i] - first[i], 1e-4) << "node " << id;
}

TEST_F(HandTest, undo_takes_a_move_by_the_ring_back) {
  start_with_sheet();
  station_->select_middle();
  pull_ring(-50, 40);
  let_go();
  EXPECT_NE(station_->save_copy("moved.k"), original_);
  station_->key("ctrl+z");
  EXPECT_EQ(station_->save_copy("undone.k"), original_);
}

/// How much pixels differ from those `step` columns further, on average over the picture's middle.
double contrast(const Station::Pixels& pixels, int step) {
  double sum = 0;
  long count = 0;
  for (int y = pixels.height / 4; y < pixels.height * 3 / 4; ++y)
    for (int x = pixels.width / 4; x < pixels.width * 3 / 4; ++x)
      for (int c = 0; c < 3; ++c, ++count) {
        const auto value = [&](int column) {
          return static_cast<unsigned char>(
              pixels.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels.width) + static_cast<std::size_t>(column)) * 3 +
                         static_cast<std::size_t>(c)]);
        };
        sum += std::abs(value(x) - value(x + step));
      }
  return sum / static_cast<double>(count);
}

TEST_F(HandTest, p_goes_through_the_display_profiles_and_a_prism_mask_gets_its_columns) {
  start_with_sheet({"--eye", "0,0,650"});  // no tracker here: without eyes a mask's picture is mono
  const auto column_contrast = [&] {
    const Station::Pixels pixels = station_->window_pixels();
    return contrast(pixels, 1) / contrast(pixels, 2);
  };
  EXPECT_LT(column_contrast(), 1) << "mono: a column is most like its neighbour";
  std::set<std::string> seen;
  station_->kiosk().skip_lines();
  for (std::string profile; profile != "profile mono";) {
    station_->key("p");
    profile = station_->kiosk().wait_for("profile ");
    ASSERT_TRUE(seen.insert(profile).second) << "again " << profile;
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
    if (profile != "profile prism-mask") continue;
    // The picture has been handed over; the display may take a moment longer.
    double ratio = column_contrast();
    for (int wait = 0; ratio <= 1 && wait < 20; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      ratio = column_contrast();
    }
    EXPECT_GT(ratio, 1) << "prism mask: a column is most like the next one of its own eye";
  }
  EXPECT_GE(seen.size(), 11u);
}

TEST_F(HandTest, another_deck_is_opened_by_keyboard) {
  start_with_sheet();
  const std::filesystem::path other = station_->folder() / "hat.k";
  const HatDeck hat = write_closed_hat(other);
  station_->kiosk().skip_lines();
  station_->key("ctrl+o");
  station_->type("hat.k");  // the field begins with the folder of the deck that is open
  station_->key("Return");
  EXPECT_EQ(station_->kiosk().wait_for("document "), "document " + other.string());
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  station_->key("i");
  EXPECT_TRUE(station_->wait_for_selection(hat.hat.size() + hat.plate.size()));
}

}  // namespace
}  // namespace prismesh::test
