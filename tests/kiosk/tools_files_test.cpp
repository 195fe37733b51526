// Choosing decks: what a typed path can go on with, the recent decks, and the box.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include <sys/socket.h>
#include <sys/un.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/link/wanted_deck.h"
#include "kiosk/tools/files/browse.h"
#include "kiosk/tools/files/path_box.h"
#include "kiosk/tools/files/report_writer.h"
#include "kiosk/tools/files/shelf.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::files {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "prismesh-browse-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
    fs::create_directories(path_ / "includes" / "deep");
    fs::create_directory(path_ / ".hidden");
    for (const char* file : {"car.k", "CAR_v2.KEY", "door.rad", "sill.k.gz", "notes.txt", ".secret.k", "old car.k"})
      std::ofstream(path_ / file) << "*KEYWORD\n";
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::vector<std::string> words(const Browsed& found) {
  std::vector<std::string> all;
  for (const BrowseRow& row : found.rows) all.push_back(row.words);
  return all;
}

TEST(Browse, lists_folders_then_decks_and_counts_the_rest) {
  const Folder folder;
  const Browsed found = browse(folder / "", false);
  EXPECT_THAT(words(found), ElementsAre("includes/", "CAR_v2.KEY", "car.k", "door.rad", "old car.k", "sill.k.gz"));
  EXPECT_EQ(found.folders, 1U);
  EXPECT_EQ(found.decks, 5U);
  EXPECT_EQ(found.others, 1U);
  EXPECT_EQ(found.rows[1].detail, "9 B");
  EXPECT_THAT(words(browse(folder / "", true)), testing::Contains("notes.txt"));
}

TEST(Browse, a_piece_is_the_beginning_without_case_else_any_part_of_a_name) {
  const Folder folder;
  EXPECT_THAT(words(browse(folder / "car", false)), ElementsAre("CAR_v2.KEY", "car.k"));
  EXPECT_THAT(words(browse(folder / "LL.K", false)), ElementsAre("sill.k.gz"));
  EXPECT_THAT(words(browse(folder / ".", false)), testing::Contains(".secret.k"));
  EXPECT_THAT(words(browse(folder / "xyz", false)), IsEmpty());
}

TEST(Browse, says_what_is_wrong_with_a_folder) {
  const Folder folder;
  EXPECT_THAT(browse(folder / "missing/x", false).problem, HasSubstr("missing/: No such file"));
  EXPECT_THAT(browse(folder / "car.k/x", false).problem, HasSubstr("Not a directory"));
  EXPECT_THAT(browse(std::string("/\0/x", 4), false).rows, testing::Not(testing::Contains(testing::Field(&BrowseRow::words, "x"))));
}

TEST(RecentDecks, are_kept_by_path_the_newest_first) {
  const std::vector<std::string> lines{line_of({"/d/a b.k", 10, 20, 2}), line_of({"/d/c.k", 1, 2, 1}), "nonsense", "1 2 x /d",
                                       line_of({"/d/a b.k", 11, 21, 2})};
  EXPECT_THAT(recent_decks(lines, 8), ElementsAre(RecentDeck{"/d/a b.k", 11, 21, 2}, RecentDeck{"/d/c.k", 1, 2, 1}));
  EXPECT_EQ(recent_decks(lines, 1).size(), 1U);
  EXPECT_EQ(recent_from("").path, "");
  EXPECT_EQ(recent_from("99999999999999999999999 1 1 /d").path, "");
}

class PathBox : public panels::GuiTest {
 protected:
  std::optional<std::string> lay_out() {
    panels::PanelLayout layout{{1000, 640}};
    std::optional<std::string> entered;
    gui_->layout(layout.picture, 0.016, [&] { entered = path_box(facts_, entry_, layout); });
    facts_.opened = false;
    items_ = std::move(layout.items);
    return entered;
  }
  void open(const std::string& deck) {
    for (int closed = 0; closed < 2; ++closed) gui_->layout({1000, 640}, 0.016, [] {});
    facts_.opened = true;
    facts_.deck = deck;
    for (int round = 0; round < 4; ++round) lay_out();
    ASSERT_TRUE(gui_->wants_keys()) << "one types at once";
  }
  std::optional<std::string> press(display::Key key) {
    gui_->feed(display::KeyChanged{key, true, false, {}});
    const auto down = lay_out();
    gui_->feed(display::KeyChanged{key, false, false, {}});
    const auto up = lay_out();
    for (int round = 0; round < 3; ++round) lay_out();
    return down ? down : up;
  }
  void type(const std::string& text) {
    gui_->feed(display::TextTyped{text});
    lay_out();
  }
  std::optional<std::string> click(const std::string& name) { return click_item("file " + name); }
  std::optional<std::string> click_item(const std::string& name) {
    const auto item = std::ranges::find(items_, name, &panels::ScreenItem::name);
    if (item == items_.end()) return "no " + name;
    const double x = item->place.x + 30, y = item->place.y + 4;
    gui_->feed(display::PointerMoved{x, y, {}});
    lay_out();
    gui_->feed(display::ButtonChanged{display::MouseButton::left, true, x, y, {}});
    lay_out();
    gui_->feed(display::ButtonChanged{display::MouseButton::left, false, x, y, {}});
    const auto entered = lay_out();
    for (int round = 0; round < 4; ++round) lay_out();
    return entered;
  }

  Folder folder_;
  PathFacts facts_;
  PathEntry entry_;
  std::vector<panels::ScreenItem> items_;
};

TEST_F(PathBox, has_a_button_that_opens_and_one_that_does_not) {
  open(folder_ / "car.k");
  type("car.k");
  EXPECT_EQ(click_item("path ok"), folder_ / "car.k");
  EXPECT_FALSE(entry_.cancelled);
  EXPECT_EQ(click_item("path cancel"), std::nullopt);
  EXPECT_TRUE(entry_.cancelled);
}

TEST_F(PathBox, is_used_by_arrow_keys_tab_and_enter) {
  open(folder_ / "car.k");
  EXPECT_EQ(entry_.typed, folder_ / "");
  press(display::Key::down);  // the folder above
  press(display::Key::down);
  EXPECT_EQ(press(display::Key::enter), std::nullopt) << "a folder is gone into";
  EXPECT_EQ(entry_.typed, folder_ / "includes/");
  press(display::Key::down);
  EXPECT_EQ(press(display::Key::enter), std::nullopt);
  EXPECT_EQ(entry_.typed, folder_ / "") << "and out of";
  type("do");
  press(display::Key::tab);
  EXPECT_EQ(entry_.typed, folder_ / "door.rad");
  EXPECT_EQ(press(display::Key::enter), folder_ / "door.rad");
}

TEST_F(PathBox, takes_a_path_from_the_root_that_is_typed_behind_the_folder) {
  EXPECT_EQ(before_absolute_path("/home/deck.k"), 0U);
  EXPECT_EQ(before_absolute_path("/home//tmp/x"), 6U);
  EXPECT_EQ(before_absolute_path("//tmp//a//b"), 9U);
  open(folder_ / "car.k");
  type("includes/");
  EXPECT_EQ(entry_.typed, folder_ / "includes/");
  type("/etc");
  EXPECT_EQ(entry_.typed, "/etc");
}

TEST_F(PathBox, is_used_by_clicks) {
  open(folder_ / "car.k");
  EXPECT_EQ(click(folder_ / "includes/"), std::nullopt);
  EXPECT_EQ(entry_.typed, folder_ / "includes/");
  EXPECT_EQ(click(folder_ / ""), std::nullopt) << "up again";
  EXPECT_EQ(click(folder_ / "old car.k"), folder_ / "old car.k");
}

TEST_F(PathBox, offers_recent_decks_until_something_is_typed_and_pastes) {
  facts_.recent = {{folder_ / "door.rad", 1200, 1300, 4}};
  open("");
  EXPECT_EQ(entry_.typed, folder_ / "") << "where the last deck was";
  press(display::Key::down);
  EXPECT_EQ(press(display::Key::enter), folder_ / "door.rad");
  open("");
  gui_->feed(display::KeyChanged{display::letter('A'), true, false, {false, true, false}});
  lay_out();
  gui_->feed(display::KeyChanged{display::letter('A'), false, false, {}});
  lay_out();
  gui_->set_clipboard(folder_ / "sill.k.gz");
  gui_->feed(display::KeyChanged{display::letter('V'), true, false, {false, true, false}});
  lay_out();
  gui_->feed(display::KeyChanged{display::letter('V'), false, false, {}});
  lay_out();
  EXPECT_EQ(entry_.typed, folder_ / "sill.k.gz");
}

TEST_F(PathBox, says_in_place_what_could_not_be_opened) {
  facts_.tried = folder_ / "gone.k";
  facts_.problem = "gone.k was not opened: no such file";
  open(folder_ / "car.k");
  EXPECT_EQ(entry_.typed, folder_ / "gone.k") << "one goes on with what was tried";
  EXPECT_NE(std::ranges::find(items_, "open problem", &panels::ScreenItem::name), items_.end());
  press(display::Key::backspace);
  EXPECT_EQ(std::ranges::find(items_, "open problem", &panels::ScreenItem::name), items_.end());
}

TEST(CopyName, is_beside_the_deck_and_new) {
  const Folder folder;
  EXPECT_EQ(copy_name(folder / "car.k"), folder / "car_copy.k");
  std::ofstream(folder / "car_copy.k") << "x";
  EXPECT_EQ(copy_name(folder / "car.k"), folder / "car_copy_2.k");
  EXPECT_EQ(copy_name(folder / "sill.k.gz"), folder / "sill_copy.k.gz");
  EXPECT_EQ(copy_name(folder / "plain"), folder / "plain_copy");
}

TEST_F(PathBox, a_save_takes_a_files_name_and_keeps_typing) {
  facts_.dialog = PathDialog::save_copy;
  open(folder_ / "car.k");
  EXPECT_EQ(entry_.typed, folder_ / "car_copy.k") << "Enter must not replace the deck";
  facts_.dialog = PathDialog::save_as;
  open(folder_ / "car.k");
  EXPECT_EQ(entry_.typed, folder_ / "car.k");
  EXPECT_EQ(click(folder_ / "car.k"), std::nullopt) << "nothing is replaced by a click";
}

TEST(Shelf, tells_of_models_who_sent_them_and_what_they_were_edited_from) {
  ipc::store::ModelRecord sent;
  sent.model = ipc::store::sha256("sent");
  sent.name = "car.k";
  sent.who = "ann's laptop";
  sent.when_s = 1'800'000'000;
  sent.bytes = 12'345'678;
  ipc::store::ModelRecord edited = sent;
  edited.model = ipc::store::sha256("edited");
  edited.who = "(station)";
  edited.when_s += 7200;
  edited.derived_from = sent.model;
  edited.figures = ipc::store::ModelFigures{100, 90, 2, 0, 0};
  const std::vector<BrowseRow> rows = shelf_of(std::vector{edited, sent}, edited.when_s + 90);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].words, "car.k   from (station), edited from that of ann's laptop");
  EXPECT_EQ(rows[0].detail, "90 elements, 1 minute ago");
  EXPECT_EQ(rows[1].words, "car.k   from ann's laptop");
  EXPECT_EQ(rows[1].detail, "12 MB, 2 hours ago");
  EXPECT_EQ(rows[1].path, "stored:" + sent.model.hex());
  EXPECT_TRUE(link::is_stored_name(rows[1].path));
  EXPECT_FALSE(link::is_stored_name("/decks/stored:1"));
  EXPECT_THAT(read_shelf("/nowhere/intake.sock"), IsEmpty());
}

TEST(Shelf, is_empty_where_somebody_listens_but_never_answers) {
  const Folder folder;
  const std::string socket = folder / "intake.sock";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socket.copy(address.sun_path, sizeof address.sun_path - 1);
  const ipc::Descriptor listening(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ASSERT_EQ(::bind(listening.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listening.get(), 4), 0);
  EXPECT_THAT(read_shelf(socket), IsEmpty());
}

TEST_F(PathBox, lists_models_of_the_store_while_nothing_is_typed) {
  facts_.shelf = {{"stored:aa", "car.k   from ann", "12 MB, 2 hours ago", false}};
  open(folder_ / "car.k");
  EXPECT_EQ(click("stored:aa"), "stored:aa");
  facts_.dialog = PathDialog::save_as;
  open(folder_ / "car.k");
  EXPECT_TRUE(std::ranges::none_of(items_, [](const panels::ScreenItem& item) { return item.name == "file stored:aa"; }));
}

TEST(Shelf, says_how_to_pair_and_what_a_browser_must_show) {
  ipc::IntakeInfo info;
  info.address = "0.0.0.0:7443";
  info.fingerprint = std::string(60, 'a') + "0123";
  const std::vector<std::string> words = pairing_words({"YH00-XEMD-3596-BM9C-AQDX-456P-B3GK-AAYS", 300}, info);
  ASSERT_EQ(words.size(), 4u);
  EXPECT_THAT(words[0], HasSubstr("YH00-XEMD-3596-BM9C-AQDX-456P-B3GK-AAYS"));
  EXPECT_THAT(words[1], testing::AllOf(HasSubstr("5 minutes"), HasSubstr("https://STATION:7443/")));
  EXPECT_THAT(words[3], testing::AllOf(testing::StartsWith("aaaa aaaa "), testing::EndsWith("aaaa 0123")));
  const std::vector<std::string> refused = ask_for_pairing("/nowhere/intake.sock");
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_THAT(refused[0], testing::AllOf(HasSubstr("No pairing code"), HasSubstr("/nowhere/intake.sock")));
}

TEST_F(PathBox, asks_for_a_pairing_code_and_shows_it) {
  facts_.shelf = {{std::string(kPairName), "Pair a computer or a browser with this station", "shows a code", false}};
  open(folder_ / "car.k");
  EXPECT_EQ(click(std::string(kPairName)), std::string(kPairName));
  facts_.pairing = {"Code: YH00", "Good for one computer"};
  open(folder_ / "car.k");
  EXPECT_TRUE(
      std::ranges::any_of(items_, [](const panels::ScreenItem& item) { return item.name == "pairing 0" && item.state == "Code: YH00"; }));
}

TEST_F(PathBox, lays_out_only_the_rows_in_sight_of_a_large_folder) {
  for (int i = 0; i < 3000; ++i) std::ofstream(folder_ / ("part_" + std::to_string(i) + ".k"));
  open(folder_ / "car.k");
  const auto rows = std::ranges::count_if(items_, [](const panels::ScreenItem& item) { return item.name.starts_with("file "); });
  EXPECT_LT(rows, 60);
  EXPECT_GT(rows, 5);
}

TEST(ReportPage, lies_beside_the_deck_under_a_name_that_is_free) {
  const Folder folder;
  EXPECT_EQ(report_page(folder / "car.k", ""), folder / "car-report.html");
  std::ofstream(folder / "car-report.html") << "kept\n";
  std::ofstream(folder / "car-report-2.html") << "kept\n";
  EXPECT_EQ(report_page(folder / "car.k", ""), folder / "car-report-3.html");
  EXPECT_EQ(report_page("/proc/none/car.k", folder / ""), fs::path(folder / "") / "car-report-3.html") << "nothing can be written there";
}

ReportWriter::Outcome outcome_of(const std::string& script, const fs::path& page, const Folder& folder) {
  const fs::path program = folder / "prismesh";
  std::ofstream(program) << "#!/bin/sh\n" << script;
  fs::permissions(program, fs::perms::owner_all);
  ReportWriter writer;
  EXPECT_TRUE(writer.begin(program, "/run/somewhere", page).has_value());
  EXPECT_FALSE(writer.begin(program, "/run/somewhere", page).has_value()) << "one at a time";
  for (;;)
    if (const std::optional<ReportWriter::Outcome> outcome = writer.look()) {
      EXPECT_FALSE(writer.writes());
      EXPECT_FALSE(writer.look().has_value()) << "told once";
      return *outcome;
    }
}

TEST(ReportWriter, tells_what_came_of_it) {
  const Folder folder;
  const fs::path page = folder / "page.html";
  const ReportWriter::Outcome good = outcome_of("echo \"$@\" > \"$6\"\n", page, folder);
  EXPECT_TRUE(good.is_written) << good.words;
  EXPECT_EQ(good.words, "The report is in " + page.string());
  std::ifstream written(page);
  std::string line;
  std::getline(written, line);
  EXPECT_EQ(line, "session report --runtime-dir /run/somewhere -o " + page.string());
  const ReportWriter::Outcome bare = outcome_of("echo 'warning: a picture is missing: no kiosk' >&2\n", page, folder);
  EXPECT_TRUE(bare.is_written);
  EXPECT_THAT(bare.words, HasSubstr("without pictures: "));
  const ReportWriter::Outcome bad = outcome_of("echo 'first' >&2; echo 'car.k: is gone' >&2; exit 1\n", page, folder);
  EXPECT_FALSE(bad.is_written);
  EXPECT_EQ(bad.words, "No report: car.k: is gone");
  const ReportWriter::Outcome killed = outcome_of("kill -9 $$\n", page, folder);
  EXPECT_FALSE(killed.is_written);
  EXPECT_THAT(killed.words, HasSubstr("signal 9"));
}

}  // namespace
}  // namespace prismesh::kiosk::tools::files
