// The panels about the view: they tile every picture, keep what they show within it, and give back what was clicked.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "base/file.h"
#include "kiosk/editor_keys.h"
#include "kiosk/input/key_table.h"
#include "kiosk/kept_arrangement.h"
#include "kiosk/panels/frame_panels.h"
#include "kiosk/panels/option_row.h"
#include "kiosk/tool_list.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::panels {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::array<display::PixelSize, 9> kPictures{
    {{320, 240}, {640, 480}, {800, 600}, {1280, 720}, {1920, 1080}, {1080, 1920}, {2560, 1440}, {3840, 2160}, {7680, 4320}}};

/// Whole pixels of a place.
std::array<int, 4> pixels_of(const Place& place) {
  return {static_cast<int>(place.x), static_cast<int>(place.y), static_cast<int>(place.right()), static_cast<int>(place.bottom())};
}

TEST(Places, tile_every_picture_and_leave_the_view_room) {
  for (const display::PixelSize& picture : kPictures)
    for (const bool stereo : {false, true})
      for (const Arrangement& set :
           {Arrangement{}, Arrangement{40, 0.15F}, Arrangement{-5, 7}, Arrangement{std::numeric_limits<float>::quiet_NaN(), 0.8F}}) {
        const TypeSizes type = type_for(picture, stereo);
        const Places places = place_panels(picture, type.body, set);
        long covered = 0;
        const std::array tiles{places.bar, places.rail, places.upper, places.lower, places.options, places.status, places.view};
        for (const Place& tile : tiles) {
          const auto [x0, y0, x1, y1] = pixels_of(tile);
          ASSERT_TRUE(x0 >= 0 && y0 >= 0 && x1 <= picture.width && y1 <= picture.height) << picture.width;
          covered += static_cast<long>(std::max(0, x1 - x0)) * std::max(0, y1 - y0);
        }
        EXPECT_EQ(covered, static_cast<long>(picture.width) * picture.height)
            << picture.width << "x" << picture.height << " stereo " << stereo;
        EXPECT_GE(places.view.width, 0.4F * static_cast<float>(picture.width)) << picture.width << " stereo " << stereo;
        EXPECT_GE(places.view.height, 0.55F * static_cast<float>(picture.height)) << picture.width << " stereo " << stereo;
      }
}

TEST(Places, text_is_as_large_on_a_display_of_many_rows) {
  for (const display::PixelSize& picture : {display::PixelSize{1920, 1080}, {2560, 1440}, {3840, 2160}})
    EXPECT_NEAR(type_for(picture, false).body / static_cast<float>(picture.height), 16.0F / 1080, 1e-3F) << picture.height;
  EXPECT_EQ(type_for({800, 600}, false), kFlatType) << "never smaller than that";
  EXPECT_LT(type_for({960, 600}, true).body, kStereoType.body) << "in a low picture stereo type leaves the model its room";
}

TEST(KeptArrangement, is_read_again_and_a_broken_file_costs_only_that) {
  std::string name = (std::filesystem::temp_directory_path() / "prismesh-arrangement-XXXXXX").string();
  const std::filesystem::path folder = ::mkdtemp(name.data());
  const std::filesystem::path file = folder / "arrangement.toml";
  {
    KeptArrangement kept(file);
    kept.set({24, 0.3F, "History"});
    kept.keep();
    kept.set({1000, 2});
    EXPECT_EQ(kept.now(), within_limits({1000, 2}));
  }
  const KeptArrangement again(file);
  EXPECT_NEAR(again.now().dock_ems, 24, 0.01);
  EXPECT_NEAR(again.now().upper_share, 0.3, 0.001);
  EXPECT_EQ(again.now().tab, "History");
  for (const char* broken : {"[dock", "dock = 3", "[dock]\nwidth = \"x\"\nupper_share = nan\ntab = 'a\"'", "\xff\xfe"}) {
    std::ofstream(file) << broken;
    EXPECT_EQ(KeptArrangement(file).now(), Arrangement{}) << broken;
  }
  // Where nothing can be written, that isn't tried again for each picture: keep() is called at each.
  std::ofstream(folder / "in the way") << "a file";
  KeptArrangement barred(folder / "in the way" / "arrangement.toml");
  barred.set({22, 0.4F});
  barred.keep();
  std::filesystem::remove(folder / "in the way");
  barred.keep();
  EXPECT_FALSE(std::filesystem::exists(folder / "in the way"));
  barred.set({23, 0.4F});
  barred.keep();
  EXPECT_TRUE(std::filesystem::exists(folder / "in the way" / "arrangement.toml")) << "the next change tries again";
  KeptArrangement nowhere{std::filesystem::path()};
  nowhere.set({20, 0.4F});
  nowhere.keep();
  std::filesystem::remove_all(folder);
}

class FramePanels : public GuiTest {
 protected:
  struct Shown {
    std::vector<ScreenItem> items;
    std::vector<input::Command> asked;
    std::optional<Arrangement> dragged;
    Places places;
  };

  Shown lay_out(display::PixelSize picture) {
    PanelLayout layout{picture, [this](const input::Command& command) { asked_.push_back(command); }};
    Shown shown;
    gui_->layout(picture, 0.016, [&] {
      layout.places = place_panels(picture, ImGui::GetFontSize(), arrangement_);
      const auto key = [](EditorCommand command) -> const input::KeyBinding& {
        return input::binding_of(key_bindings(), command_of(command));
      };
      const BarKeys keys{key(EditorCommand::undo), key(EditorCommand::redo), key(EditorCommand::deck_warnings), &key(EditorCommand::menu),
                         key(EditorCommand::help)};
      bar_panel(
          {"a_deck_with_a_name_that_is_longer_than_any_bar_has_room_for_in_a_small_picture.k", "/d/a.k", true, true, false}, keys,
          key_bindings(), [](input::Menu) {}, layout);
      const std::vector<RailButton> rail{{"Select", &key(EditorCommand::undo), true}, {"Compare", &key(EditorCommand::redo), false}};
      rail_panel(rail, layout);
      if (!layout.places.options.empty()) {
        begin_docked("Options", layout.places.options);
        OptionRow row(layout);
        for (const char* label : {"falloff", "mirror", "free edges", "along", "at most", "origin", "across welds", "by number"})
          row.value(label, "a value of some length", key(EditorCommand::undo));
        ImGui::End();
      }
      status_panel({"Pull \u00b7 smooth \u00b7 mirror off",
                    "node 5000766  (1234.56 -78.9012 345.678) mm   shell 5000123   part 12 Reinforcement of the sill",
                    "592 nodes selected",
                    "mm",
                    {{"eyes", "good"}, {"mask", "at rest"}, {"model server", "connected"}}},
                   layout);
      shown.dragged = borders(arrangement_, layout);
    });
    for (const std::function<void()>& action : layout.actions) action();
    shown.items = std::move(layout.items);
    shown.asked = std::exchange(asked_, {});
    shown.places = layout.places;
    return shown;
  }
  Shown click(display::PixelSize picture, const Place& at) {
    return press_and_move(picture, at, at.x + at.width / 2, at.y + at.height / 2);
  }
  Shown press_and_move(display::PixelSize picture, const Place& at, float x, float y) {
    const double px = at.x + at.width / 2, py = at.y + at.height / 2;
    gui_->feed(display::PointerMoved{px, py, {}});
    lay_out(picture);
    gui_->feed(display::ButtonChanged{display::MouseButton::left, true, px, py, {}});
    Shown all = lay_out(picture);
    gui_->feed(display::PointerMoved{x, y, {}});
    Shown moved = lay_out(picture);
    all.dragged = moved.dragged;
    gui_->feed(display::ButtonChanged{display::MouseButton::left, false, x, y, {}});
    const Shown last = lay_out(picture);
    all.asked.insert(all.asked.end(), last.asked.begin(), last.asked.end());
    all.items = last.items;
    return all;
  }
  static const ScreenItem* find(const Shown& shown, const std::string& name) {
    const auto found = std::ranges::find(shown.items, name, &ScreenItem::name);
    return found == shown.items.end() ? nullptr : &*found;
  }

  Arrangement arrangement_;
  std::vector<input::Command> asked_;
};

TEST_F(FramePanels, keep_what_they_show_within_every_picture) {
  for (const display::PixelSize& picture : kPictures) {
    if (picture.width > 4000) continue;
    for (const bool stereo : {false, true}) {
      ASSERT_TRUE(gui_->set_type(type_for(picture, stereo)));
      lay_out(picture);
      const Shown shown = lay_out(picture);
      EXPECT_GE(shown.items.size(), 5U);
      for (const ScreenItem& item : shown.items) {
        const Place& at = item.place;
        const bool inside = at.x >= 0 && at.y >= 0 && at.right() <= static_cast<float>(picture.width) + 0.5F &&
                            at.bottom() <= static_cast<float>(picture.height) + 0.5F;
        EXPECT_TRUE(inside) << item.name << " in " << picture.width << "x" << picture.height << (stereo ? " stereo: " : ": ") << at.x << " "
                            << at.y << " " << at.right() << " " << at.bottom();
        if (item.name.starts_with("option ")) {
          EXPECT_LE(at.right(), shown.places.options.right()) << item.name;
        }
      }
      // What stands side by side doesn't overlap.
      for (std::size_t i = 0; i < shown.items.size(); ++i)
        for (std::size_t j = i + 1; j < shown.items.size(); ++j) {
          const Place &a = shown.items[i].place, &b = shown.items[j].place;
          if (shown.items[i].name.starts_with("border") || shown.items[j].name.starts_with("border")) continue;
          const float across = std::min(a.right(), b.right()) - std::max(a.x, b.x),
                      down = std::min(a.bottom(), b.bottom()) - std::max(a.y, b.y);
          EXPECT_FALSE(across > 1.5F && down > 1.5F) << shown.items[i].name << " over " << shown.items[j].name << " in " << picture.width
                                                     << "x" << picture.height << (stereo ? " stereo" : "");
        }
    }
  }
}

TEST_F(FramePanels, every_command_is_two_clicks_away_in_the_menus) {
  constexpr display::PixelSize kPicture{1600, 1000};
  ASSERT_TRUE(gui_->set_type(kFlatType));
  lay_out(kPicture);
  for (const input::KeyBinding& binding : key_bindings()) {
    const Shown closed = lay_out(kPicture);
    const ScreenItem* menu = find(closed, "menu " + std::string(input::kMenuNames[static_cast<std::size_t>(binding.menu)]));
    ASSERT_NE(menu, nullptr);
    click(kPicture, menu->place);
    const Shown open = lay_out(kPicture);
    EXPECT_TRUE(gui_->popup_open());
    EXPECT_TRUE(gui_->on_panel(700, 900)) << "an open menu has the pointer everywhere";
    const ScreenItem* entry = find(open, "entry " + std::string(binding.meaning));
    ASSERT_NE(entry, nullptr) << binding.meaning;
    ASSERT_LE(entry->place.bottom(), static_cast<float>(kPicture.height)) << binding.meaning;
    const Shown done = click(kPicture, entry->place);
    EXPECT_THAT(done.asked, ElementsAre(binding.command)) << binding.meaning;
    lay_out(kPicture);
    EXPECT_FALSE(gui_->popup_open());
  }
}

TEST_F(FramePanels, buttons_ask_for_their_commands_and_borders_are_dragged) {
  constexpr display::PixelSize kPicture{1600, 1000};
  lay_out(kPicture);
  const Shown shown = lay_out(kPicture);
  EXPECT_THAT(click(kPicture, find(shown, "undo")->place).asked, ElementsAre(command_of(EditorCommand::undo)));
  EXPECT_THAT(click(kPicture, find(shown, "redo")->place).asked, ElementsAre()) << "there is nothing to redo";
  EXPECT_THAT(click(kPicture, find(shown, "rail Compare")->place).asked, ElementsAre(command_of(EditorCommand::redo)));
  EXPECT_THAT(click(kPicture, find(shown, "help")->place).asked, ElementsAre(command_of(EditorCommand::help)));
  EXPECT_EQ(find(shown, "rail Select")->state, "on");
  EXPECT_THAT(find(shown, "save")->state, HasSubstr("modified"));
  const Place border{shown.places.dock.x - 2, 300, 4, 4};
  const Shown wider = press_and_move(kPicture, border, shown.places.dock.x - 100, 302);
  ASSERT_TRUE(wider.dragged);
  EXPECT_NEAR(wider.dragged->dock_ems, (shown.places.dock.width + 100) / 16, 0.3);
  const Place halves{shown.places.dock.x + 100, shown.places.lower.y - 2, 4, 4};
  const Shown lower = press_and_move(kPicture, halves, halves.x, shown.places.lower.y + 150);
  ASSERT_TRUE(lower.dragged);
  EXPECT_GT(lower.dragged->upper_share, 0.6F);
}

}  // namespace
}  // namespace prismesh::kiosk::panels
