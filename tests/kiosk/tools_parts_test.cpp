// The tree of files and parts: what is filtered, sorted, folded and chosen; what its rows and buttons ask for; and its error counts.
#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "kiosk/panels/text.h"
#include "kiosk/tools/parts/part_errors.h"
#include "kiosk/tools/parts/part_list.h"
#include "kiosk/tools/parts/part_tree.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::parts {
namespace {

using mesh::document::VisibilityAction;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

PartRow part(std::int64_t id, std::string name, std::uint64_t shells, Errors errors = {}) {
  PartRow row;
  row.id = id;
  row.name = std::move(name);
  row.shells = shells;
  row.errors = errors;
  row.colour = 0xff808080U;
  return row;
}

/// Part 70 has shells in both files, part 4 in none.
PartFacts two_files() {
  PartFacts facts;
  facts.parts = {part(30, "Roof bow", 500, {3, 0}), part(12, "sill", 900, {0, 1}), part(70, "Adhesive", 20), part(4, "ballast", 0)};
  facts.files = {{"main.k", 910, {12, 70}, {0, 1}}, {"roof.k", 510, {30, 70}, {3, 0}}};
  return facts;
}

/// "main.k", "  12", ..: a line for each row.
std::vector<std::string> lines(const PartTree& tree) {
  std::vector<std::string> lines;
  for (const TreeRow& row : tree.rows())
    lines.push_back(row.is_file()                ? tree.facts().files[row.file].name
                    : row.file == TreeRow::kNone ? std::to_string(tree.facts().parts[row.part].id)
                                                 : "  " + std::to_string(tree.facts().parts[row.part].id));
  return lines;
}

std::vector<std::int64_t> acted(const PartTree& tree) {
  std::vector<std::int64_t> ids;
  for (const std::size_t p : tree.acted_on()) ids.push_back(tree.facts().parts[p].id);
  std::ranges::sort(ids);
  return ids;
}

TEST(PartTree, has_parts_beneath_their_files_and_those_of_no_file_last) {
  PartTree tree;
  tree.set_facts(two_files());
  EXPECT_THAT(lines(tree), ElementsAre("main.k", "  12", "  70", "roof.k", "  30", "  70", "4"));
  tree.fold(0);
  EXPECT_THAT(lines(tree), ElementsAre("main.k", "roof.k", "  30", "  70", "4"));
  tree.set_facts(two_files());
  EXPECT_THAT(lines(tree), SizeIs(5)) << "a newer generation leaves it folded";
  tree.set_filter("sill");
  EXPECT_THAT(lines(tree), ElementsAre("main.k", "  12")) << "a filter finds what is folded";
  tree.forget();
  tree.set_facts(two_files());
  EXPECT_THAT(lines(tree), SizeIs(7)) << "another deck has nothing folded";
}

TEST(PartTree, filters_by_id_name_and_file_anywhere_and_in_any_case) {
  PartTree tree;
  tree.set_facts(two_files());
  tree.set_filter("SIL");
  EXPECT_THAT(acted(tree), ElementsAre(12));
  tree.set_filter("0");
  EXPECT_THAT(acted(tree), ElementsAre(30, 70));
  tree.set_filter("B");
  EXPECT_THAT(acted(tree), ElementsAre(4, 30));
  tree.set_filter("Roof.K");
  EXPECT_THAT(lines(tree), ElementsAre("main.k", "  70", "roof.k", "  30", "  70")) << "all parts of that file";
  tree.set_filter("nothing has this");
  EXPECT_THAT(tree.rows(), IsEmpty());
  EXPECT_THAT(tree.acted_on(), IsEmpty());
  tree.set_filter("");
  EXPECT_THAT(acted(tree), ElementsAre(4, 12, 30, 70));
}

TEST(PartTree, sorts_by_each_column_both_ways) {
  PartTree tree;
  PartFacts facts = two_files();
  facts.files.clear();
  tree.set_facts(facts);
  EXPECT_THAT(lines(tree), ElementsAre("4", "12", "30", "70"));
  tree.sort(SortBy::id);
  EXPECT_THAT(lines(tree), ElementsAre("70", "30", "12", "4"));
  tree.sort(SortBy::name);
  EXPECT_THAT(lines(tree), ElementsAre("70", "4", "30", "12")) << "Adhesive, ballast, Roof bow, sill";
  tree.sort(SortBy::shells);
  EXPECT_THAT(lines(tree), ElementsAre("12", "30", "70", "4")) << "most first";
  tree.sort(SortBy::errors);
  EXPECT_THAT(lines(tree), ElementsAre("12", "30", "4", "70")) << "one that fails is worse than three that warn";
  tree.sort(SortBy::errors);
  EXPECT_THAT(lines(tree), ElementsAre("4", "70", "30", "12"));
}

TEST(PartTree, chooses_one_several_and_up_to) {
  PartTree tree;
  tree.set_facts(two_files());  // main.k 12 70, roof.k 30 70, 4
  EXPECT_FALSE(tree.acts_on_chosen());
  tree.choose(1, Choice::only);
  EXPECT_THAT(acted(tree), ElementsAre(12));
  tree.choose(6, Choice::other);
  EXPECT_THAT(acted(tree), ElementsAre(4, 12));
  tree.choose(1, Choice::other);
  EXPECT_THAT(acted(tree), ElementsAre(4));
  tree.choose(1, Choice::only);
  tree.choose(4, Choice::up_to);
  EXPECT_THAT(acted(tree), ElementsAre(12, 30, 70));
  tree.choose(2, Choice::up_to);
  EXPECT_THAT(acted(tree), ElementsAre(12, 70)) << "from where the choice began";
  tree.choose(3, Choice::only);
  EXPECT_THAT(acted(tree), ElementsAre(30, 70)) << "a file is its parts";
  tree.set_filter("bow");
  EXPECT_THAT(acted(tree), ElementsAre(30)) << "what isn't seen isn't acted on";
  tree.set_filter("sill");
  EXPECT_FALSE(tree.acts_on_chosen());
  EXPECT_THAT(acted(tree), ElementsAre(12));
  tree.set_filter("");
  tree.choose_none();
  EXPECT_THAT(acted(tree), SizeIs(4));
}

TEST(PartTree, agrees_with_a_plain_search_of_random_names) {
  std::mt19937 random(7);
  PartTree tree;
  PartFacts facts;
  for (int i = 0; i < 300; ++i) {
    std::string name;
    for (int c = 0; c < 6; ++c) name += "abAB \xff"[random() % 6];
    facts.parts.push_back(part(1000 + static_cast<int>(random() % 100000), name, random() % 50));
  }
  tree.set_facts(facts);
  for (const std::string wanted : {"ab", "BA", "\xff", "9", "a b"}) {
    tree.set_filter(wanted);
    std::size_t expected = 0;
    const auto low = [](std::string text) {
      for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
      return text;
    };
    for (const PartRow& row : facts.parts)
      expected += (std::to_string(row.id) + "|" + low(row.name)).find(low(wanted)) != std::string::npos ? 1 : 0;
    EXPECT_EQ(tree.rows().size(), expected) << wanted;
  }
}

// --- errors ---

using mesh::quality::ShellState;

ShellState state_of(mesh::quality::Grade grade) {
  constexpr std::uint16_t kSomeMetric = 1 << 5;
  return grade == mesh::quality::Grade::fail ? ShellState{0, kSomeMetric} : ShellState{kSomeMetric, 0};
}

TEST(PartErrors, count_each_part_and_follow_what_changes) {
  test::TestSource source;
  std::mt19937 random(11);
  const std::uint32_t node = source.add_node({0, 0, 0});
  for (std::size_t s = 0; s < 3 * mesh::kChunkSize + 17; ++s) {
    source.add_shell(node, node, node, node, static_cast<std::uint32_t>(random() % 5));
    const auto roll = random() % 10;
    if (roll == 9) source.shell_quality.back() = ShellState::removed();
    if (roll < 3) source.shell_quality.back() = state_of(roll == 0 ? mesh::quality::Grade::fail : mesh::quality::Grade::warn);
  }
  const auto expected = [&] {
    std::vector<Errors> all(5);
    for (std::size_t s = 0; s < source.shell_quality.size(); ++s) {
      const auto grade = source.shell_quality[s].grade();
      all[source.shell_parts[s].value].warn += grade == mesh::quality::Grade::warn ? 1 : 0;
      all[source.shell_parts[s].value].fail += grade == mesh::quality::Grade::fail ? 1 : 0;
    }
    return all;
  };
  PartErrors errors;
  EXPECT_EQ(errors.count(source), expected());
  source.shell_quality[mesh::kChunkSize + 5] = state_of(mesh::quality::Grade::fail);
  source.shell_parts[mesh::kChunkSize + 6] = mesh::PartIndex(4);
  source.touch(ipc::SnapshotArray::shell_quality, 1);
  source.touch(ipc::SnapshotArray::shell_parts, 1);
  EXPECT_EQ(errors.count(source), expected());
  source.shell_parts[3] = mesh::PartIndex(1234567);  // no such part
  source.key = 2;
  errors.count(source);
  EXPECT_EQ(errors.count(source), [&] {
    test::TestSource without = source;
    without.shell_quality[3] = {};
    return PartErrors().count(without);
  }());
}

// --- the list ---

class PartList : public panels::GuiTest {
 protected:
  struct Shown {
    PartWishes wishes;
    std::vector<panels::ScreenItem> items;
  };
  Shown lay_out() {
    panels::PanelLayout layout{picture_};
    Shown shown;
    gui_->layout(picture_, 0.016, [&] { in_dock(picture_, [&] { shown.wishes = part_list(tree_, layout); }); });
    shown.items = std::move(layout.items);
    return shown;
  }
  static const panels::ScreenItem* find(const Shown& shown, const std::string& name) {
    const auto found = std::ranges::find(shown.items, name, &panels::ScreenItem::name);
    return found == shown.items.end() ? nullptr : &*found;
  }
  /// Clicks at a share of an item's width.
  PartWishes click(const std::string& name, float share = 0.5F, const display::Modifiers& modifiers = {}) {
    lay_out();
    const Shown shown = lay_out();
    const panels::ScreenItem* item = find(shown, name);
    EXPECT_NE(item, nullptr) << name;
    if (item == nullptr) return {};
    const double x = item->place.x + share * item->place.width, y = item->place.y + item->place.height / 2;
    gui_->feed(display::PointerMoved{x, y, modifiers});
    lay_out();
    PartWishes all;
    for (const bool down : {true, false}) {
      gui_->feed(display::ButtonChanged{display::MouseButton::left, down, x, y, modifiers});
      PartWishes now = lay_out().wishes;
      std::ranges::move(now.edits, std::back_inserter(all.edits));
      std::ranges::move(now.paints, std::back_inserter(all.paints));
    }
    for (int i = 0; i < 30; ++i) lay_out();  // half a second: the next click isn't a second one
    return all;
  }
  static std::vector<std::string> edits(const PartWishes& wishes) {
    std::vector<std::string> words;
    for (const SetVisibility& each : wishes.edits) words.push_back(std::to_string(static_cast<int>(each.action)) + " " + each.on);
    return words;
  }
  static std::string words(VisibilityAction action, const std::string& on) { return std::to_string(static_cast<int>(action)) + " " + on; }

  display::PixelSize picture_{1000, 600};
  PartTree tree_;
};

TEST_F(PartList, buttons_act_on_the_chosen_rows_or_else_on_what_matches) {
  tree_.set_facts(two_files());
  EXPECT_THAT(edits(click("parts hide")), ElementsAre(words(VisibilityAction::hide, "4,12,30,70")));
  click("part 12");
  click("part 30", 0.5F, {.ctrl = true});
  EXPECT_THAT(acted(tree_), ElementsAre(12, 30));
  EXPECT_THAT(edits(click("parts only")), ElementsAre(words(VisibilityAction::only, "12,30")));
  EXPECT_THAT(edits(click("parts reverse")), ElementsAre(words(VisibilityAction::reverse, "12,30")));
  EXPECT_THAT(edits(click("parts show")), ElementsAre(words(VisibilityAction::show, "12,30")));
  EXPECT_THAT(edits(click("parts lock")), ElementsAre(words(VisibilityAction::lock, "12,30")));
  const PartWishes seen_through = click("parts transparent");
  ASSERT_THAT(seen_through.paints, SizeIs(1));
  EXPECT_EQ(seen_through.paints[0].transparent, true);
  EXPECT_THAT(seen_through.paints[0].parts, testing::UnorderedElementsAre(12, 30));
  click("parts none");
  tree_.set_filter("roof bow");
  EXPECT_THAT(edits(click("parts hide")), ElementsAre(words(VisibilityAction::hide, "30")));
  PartFacts facts = two_files();
  facts.parts[0].locked = facts.parts[0].transparent = true;
  tree_.set_facts(facts);
  EXPECT_THAT(edits(click("parts unlock")), ElementsAre(words(VisibilityAction::unlock, "30")));
  EXPECT_EQ(click("parts opaque").paints.at(0).transparent, false);
}

TEST_F(PartList, a_colour_is_chosen_and_given_back) {
  tree_.set_facts(two_files());
  click("part 12");
  click("parts colour");
  const PartWishes blue = click("parts colour 8");
  ASSERT_THAT(blue.paints, SizeIs(1));
  EXPECT_TRUE(blue.paints[0].colours);
  EXPECT_EQ(blue.paints[0].colour, choosable_colours()[8]);
  EXPECT_THAT(blue.paints[0].parts, ElementsAre(12));
  EXPECT_FALSE(blue.paints[0].transparent);
  click("parts colour");
  const PartWishes own = click("parts own colour");
  ASSERT_THAT(own.paints, SizeIs(1));
  EXPECT_TRUE(own.paints[0].colours);
  EXPECT_FALSE(own.paints[0].colour);
}

TEST_F(PartList, a_row_shows_hides_locks_folds_and_shows_only_itself) {
  tree_.set_facts(two_files());
  EXPECT_THAT(edits(click("part 12", 0.09F)), ElementsAre(words(VisibilityAction::hide, "12")));
  EXPECT_THAT(edits(click("part 12", 0.99F)), ElementsAre(words(VisibilityAction::lock, "12")));
  EXPECT_THAT(edits(click("file roof.k", 0.99F)), ElementsAre(words(VisibilityAction::lock, "file:\"roof.k\"")));
  EXPECT_THAT(tree_.acted_on(), SizeIs(4)) << "these choose nothing";
  EXPECT_THAT(edits(click("file roof.k", 0.02F)), IsEmpty());
  EXPECT_TRUE(tree_.folded(1));
  click("parts sort shells");
  EXPECT_EQ(tree_.sorted_by(), SortBy::shells);
  const panels::Place at = find(lay_out(), "part 12")->place;
  const double x = at.x + at.width / 2, y = at.y + at.height / 2;
  gui_->feed(display::PointerMoved{x, y, {}});
  lay_out();
  std::vector<std::string> asked;
  for (const bool down : {true, false, true, false}) {
    gui_->feed(display::ButtonChanged{display::MouseButton::left, down, x, y, {}});
    for (const std::string& each : edits(lay_out().wishes)) asked.push_back(each);
  }
  EXPECT_THAT(asked, ElementsAre(words(VisibilityAction::only, "12")));
}

TEST_F(PartList, a_low_dock_has_the_actions_in_a_menu_and_room_for_rows) {
  tree_.set_facts(two_files());
  picture_.height = 280;
  lay_out();
  EXPECT_EQ(find(lay_out(), "parts hide"), nullptr);
  EXPECT_NE(find(lay_out(), "part 30"), nullptr);
  click("part 12");
  click("parts actions");
  EXPECT_THAT(edits(click("parts hide")), ElementsAre(words(VisibilityAction::hide, "12")));
  EXPECT_FALSE(gui_->popup_open());
  click("parts actions");
  click("parts colour");
  EXPECT_THAT(click("parts colour 3").paints, SizeIs(1));
}

TEST_F(PartList, the_filter_has_the_keyboard_while_it_is_typed_in) {
  tree_.set_facts(two_files());
  click("parts filter");
  lay_out();
  EXPECT_TRUE(gui_->wants_keys());
  gui_->feed(display::TextTyped{"SILL"});
  lay_out();
  lay_out();
  EXPECT_EQ(tree_.filter(), "SILL");
  EXPECT_THAT(acted(tree_), ElementsAre(12));
  click("parts clear");
  EXPECT_EQ(tree_.filter(), "");
}

TEST_F(PartList, draws_only_the_rows_in_sight_of_5000_parts) {
  PartFacts facts;
  for (int i = 0; i < 5000; ++i) facts.parts.push_back(part(i + 1, "", 10));
  tree_.set_facts(facts);
  ASSERT_THAT(tree_.rows(), SizeIs(5000));
  for (int scroll = 0; scroll < 20; ++scroll) {
    gui_->feed(display::PointerMoved{150, 400, {}});
    gui_->feed(display::WheelTurned{-5, 150, 400, {}});
    lay_out();
    const Shown shown = lay_out();
    const auto rows = std::ranges::count_if(shown.items, [](const panels::ScreenItem& item) { return item.name.starts_with("part "); });
    EXPECT_GE(rows, 10);
    EXPECT_LE(rows, 40) << "a picture of 600 rows has room for no more";
  }
  EXPECT_EQ(find(lay_out(), "part 1"), nullptr) << "it has scrolled";
}

TEST_F(PartList, names_that_are_no_text_are_shown_as_what_they_are) {
  PartFacts facts;
  const std::vector<std::string> names{"",        "\xff\xfe\x80",         std::string("nul\0in it", 9), "%s%n%d",  "\xe2\x82", "##id",
                                       "a\nb\tc", std::string(5000, 'x'), "D\xc3\xbcse \xe2\x86\x92",   "\x1b[31m"};
  for (std::size_t i = 0; i < names.size(); ++i) facts.parts.push_back(part(static_cast<std::int64_t>(i) - 2, names[i], i));
  facts.parts.push_back(part(std::numeric_limits<std::int64_t>::max(), "\xff", 1ULL << 40, {4000000000U, 1}));
  facts.files = {{"\xff\xfe.k", 1, {-2, -1}, {}}, {"", 1, {0, 1}, {}}, {"##", 0, {}, {}}};
  tree_.set_facts(facts);
  Shown shown = lay_out();
  shown = lay_out();
  EXPECT_NE(find(shown, "file \\xff\\xfe.k"), nullptr);
  for (const panels::ScreenItem& item : shown.items) EXPECT_EQ(panels::printable(item.name), item.name);
  for (const SortBy by : {SortBy::name, SortBy::shells, SortBy::errors, SortBy::id}) {
    tree_.sort(by);
    lay_out();
  }
  click("part 0");
  tree_.set_filter("\xff");
  lay_out();
  tree_.set_facts({});
  EXPECT_THAT(lay_out().wishes.edits, IsEmpty()) << "a deck without parts";
}

}  // namespace
}  // namespace prismesh::kiosk::tools::parts
