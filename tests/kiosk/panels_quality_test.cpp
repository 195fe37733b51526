// The quality panel gives back what was clicked: a metric's row, a bar, an error.
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/panels/message_panels.h"
#include "kiosk/tools/quality/quality_panel.h"
#include "kiosk/tools/quality/quality_words.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::quality {
namespace {

using panels::PanelLayout;

using mesh::document::SelectMode;

constexpr display::PixelSize kPanelPicture{900, 700};

class QualityPanel : public panels::GuiTest {
 protected:
  void SetUp() override {
    panels::GuiTest::SetUp();
    if (HasFatalFailure() || IsSkipped()) return;
    figures_.metrics = {{"warpage", "deg", 12, 3}, {"aspect", "", 0, 2}, {"skew", "deg", 0, 0}};
    figures_.metric = "warpage";
    for (int i = 0; i < 8; ++i) figures_.bars.push_back({i * 2.0, i * 2.0 + 2, false, i == 7, 100, i > 5 ? 6U : 0U, i > 6 ? 3U : 0U});
    figures_.errors = {{11, "warpage", "deg", 31.5, true, {}}, {12, "warpage", "deg", 20, true, {}}};
    figures_.error_count = 15;
    figures_.parts = {{7, 800, 12, 5, 0.61, -0.4}};
    facts_.figures = &figures_;
    facts_.metric = "warpage";
    lay_out();
    lay_out();
  }
  QualityActions lay_out() {
    QualityActions actions;
    PanelLayout layout{kPanelPicture};
    gui_->layout(kPanelPicture, 0.016, [&] { in_dock(kPanelPicture, [&] { actions = quality_panel(facts_, layout); }); });
    return actions;
  }
  QualityActions click(double x, double y, bool shift = false) {
    const display::Modifiers modifiers{shift, false, false};
    gui_->feed(display::PointerMoved{x, y, modifiers});
    lay_out();
    gui_->feed(display::ButtonChanged{display::MouseButton::left, true, x, y, modifiers});
    lay_out();
    gui_->feed(display::ButtonChanged{display::MouseButton::left, false, x, y, modifiers});
    return lay_out();
  }
  /// What clicks down the panel give, one every few pixels.
  template <class Action>
  std::vector<Action> clicked_down(double x, bool shift = false) {
    std::vector<Action> found;
    for (double y = 20; y < kPanelPicture.height; y += 5)
      for (const QualityAction& action : click(x, y, shift))
        if (const auto* wanted = std::get_if<Action>(&action)) found.push_back(*wanted);
    return found;
  }

  ipc::Quality figures_;
  QualityFacts facts_;
};

TEST_F(QualityPanel, a_row_chooses_its_metric_and_the_chosen_one_lets_go) {
  std::set<std::string> chosen;
  for (const ChooseMetric& choice : clicked_down<ChooseMetric>(60)) chosen.insert(choice.metric);
  EXPECT_EQ(chosen, (std::set<std::string>{"", "aspect"})) << "warpage is chosen already, of skew nothing is wrong";
}

TEST_F(QualityPanel, a_bar_selects_its_shells) {
  std::set<double> from;
  bool last_open = false;
  for (double x = 20; x < 300; x += 12)
    for (const BarClicked& clicked : clicked_down<BarClicked>(x)) {
      from.insert(clicked.bar.from);
      last_open = last_open || clicked.bar.open_above;
      EXPECT_EQ(clicked.mode, SelectMode::set);
    }
  EXPECT_EQ(from.size(), figures_.bars.size());
  EXPECT_TRUE(last_open);
}

TEST_F(QualityPanel, a_bar_clicked_with_shift_adds_its_shells) {
  const std::vector<BarClicked> clicked = clicked_down<BarClicked>(60, true);
  ASSERT_FALSE(clicked.empty());
  for (const BarClicked& each : clicked) EXPECT_EQ(each.mode, SelectMode::add);
  // As the window system says it: the key that is released comes with what was held before.
  gui_->feed(display::KeyChanged{display::Key::none, false, false, {true, false, false}});
  for (const BarClicked& each : clicked_down<BarClicked>(60)) EXPECT_EQ(each.mode, SelectMode::set) << "Shift was let go";
}

TEST_F(QualityPanel, target_sizes_are_shown_and_guessed_again_by_a_click) {
  EXPECT_TRUE(clicked_down<SizeChosen>(60).empty()) << "without parts there is no size";
  facts_.sizes = SizeFacts{5, 130, "mm", true};
  std::set<mesh::document::TargetSize> chosen;
  for (double x = 20; x < 300; x += 16)
    for (const SizeChosen& choice : clicked_down<SizeChosen>(x)) chosen.insert(choice.size);
  EXPECT_EQ(chosen, (std::set<mesh::document::TargetSize>{mesh::document::SizeGuess::part, mesh::document::SizeGuess::deck}));
}

TEST_F(QualityPanel, criteria_are_chosen_from_the_list_and_given_up_for_the_decks) {
  facts_.criteria = CriteriaFacts{"default", {{"strict", "7"}}, {"default", "strict", "/decks/ours.toml"}, true};
  std::set<std::string> chosen;
  bool listed = false;
  // A click opens the list, a second one chooses from it or closes it.
  for (double y = 20; y < kPanelPicture.height; y += 8)
    for (const double down : {0.0, 28.0, 46.0, 64.0, 82.0, 100.0})
      for (int clicks = 0; clicks < (down > 0 ? 2 : 1); ++clicks)
        for (const QualityAction& action : click(200, clicks == 0 ? y : std::min(y + down, kPanelPicture.height - 1.0))) {
          listed = listed || std::holds_alternative<CriteriaListed>(action);
          if (const auto* criteria = std::get_if<CriteriaChosen>(&action)) chosen.insert(criteria->criteria);
        }
  EXPECT_TRUE(listed);
  EXPECT_EQ(chosen, (std::set<std::string>{"deck", "default", "strict", "/decks/ours.toml"}));
}

TEST(CriteriaFactsTest, name_what_is_known_once_and_who_has_criteria_of_their_own) {
  ipc::SnapshotInfo info;
  info.criteria = "/decks/ours.toml";
  for (std::int64_t id = 1; id <= 4; ++id) info.parts.push_back({id, "", false, false, 10, 5, {}, id == 3 ? "" : "strict"});
  info.parts.push_back({9, "", false, false, 0, 5, {}, "/else/where.toml"});
  const CriteriaFacts facts = criteria_facts(info, {"/decks/ours.toml", "/decks/theirs.toml"});
  EXPECT_EQ(facts.of_deck, "/decks/ours.toml");
  EXPECT_FALSE(facts.of_selection);
  EXPECT_THAT(facts.known, ::testing::ElementsAre("default", "strict", "skew_and_thickness", "/decks/ours.toml", "/decks/theirs.toml",
                                                  "/else/where.toml"));
  EXPECT_THAT(facts.own, ::testing::ElementsAre(std::pair<std::string, std::string>("/else/where.toml", "9"),
                                                std::pair<std::string, std::string>("strict", "1-2,4")));
  info.selected_shells = 1;
  EXPECT_TRUE(criteria_facts(info, {}).of_selection);
  EXPECT_EQ(short_criteria("/decks/ours.toml"), "ours.toml");
  EXPECT_EQ(short_criteria("strict"), "strict");
}

TEST_F(QualityPanel, an_error_is_gone_to_and_named) {
  std::set<std::size_t> errors;
  for (const ErrorClicked& clicked : clicked_down<ErrorClicked>(60)) errors.insert(clicked.error);
  EXPECT_EQ(errors, (std::set<std::size_t>{0, 1}));
  EXPECT_EQ(error_words(figures_.errors[0]), "shell 11: warpage 31.5\u00b0 fails");
  EXPECT_EQ(error_words({12, "no_area", "", std::nullopt, true, {}}), "shell 12: no area");
  const ipc::QualityError crowded{12, "triangle_clusters", "", 6, false, {}, 45};
  EXPECT_EQ(error_words(crowded), "node 45: many triangles together, 6 about it");
  EXPECT_EQ(error_row_words(crowded), "node 45  6 triangles together");
  EXPECT_EQ(error_row_words(figures_.errors[0]), "11  warpage  31.5\u00b0");
  EXPECT_EQ(kind_words("triangle_clusters"), "many triangles together");
  EXPECT_EQ(kind_words("min_length"), "min length");
}

TEST_F(QualityPanel, panels_keep_the_pointer_from_the_picture_and_words_on_it_do_not) {
  PanelLayout layout{kPanelPicture};
  for (int round = 0; round < 2; ++round)
    gui_->layout(kPanelPicture, 0.016, [&] {
      in_dock(kPanelPicture, [&] { quality_panel(facts_, layout); });
      panels::guidance_panel("Axis: click the first node, Esc gives up", panels::whole(kPanelPicture));
    });
  EXPECT_TRUE(gui_->on_panel(60, 60)) << "the panel at the left";
  EXPECT_FALSE(gui_->on_panel(kPanelPicture.width / 2.0, 20)) << "a hint must not catch clicks";
  EXPECT_FALSE(gui_->on_panel(kPanelPicture.width / 2.0, kPanelPicture.height / 2.0));
}

}  // namespace
}  // namespace prismesh::kiosk::tools::quality
