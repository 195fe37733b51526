// The exhibition from end to end: the show, visits that end with the deck as it was, no way to files or out, and input at random.
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "tests/station/station.h"

namespace prismesh::test {
namespace {

class ExhibitionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_programs(); !missing.empty())
      GTEST_SKIP() << "SKIPPED: the station can't be tested here, install " << missing;
    station_ = std::make_unique<Station>();
    original_ = whole_file(station_->deck());
  }
  /// `more`: keys of [exhibition].
  void open_doors(const std::string& more) {
    std::ofstream(station_->folder() / "show.jsonl")
        << R"({"title":"A bump in a sheet","words":"Selected, lifted, taken back.","seconds":0.4,"fit":"model"})"
           "\n"
        << R"({"edit":{"edit":"select","expr":"all"},"seconds":0.4,"turn":[20,5]})"
           "\n"
        << R"({"edit":{"edit":"lift","distance":5},"seconds":0.6})"
           "\n";
    const std::filesystem::path settings = station_->folder() / "exhibition.toml";
    std::ofstream(settings) << "[display]\nprofile = \"mono\"\n[exhibition]\ndeck = \"" << station_->deck().string()
                            << "\"\nshow = \"show.jsonl\"\npin = \"" << kHashOf4711 << "\"\n"
                            << more;
    station_->start_exhibition(settings);
  }
  /// A visitor comes; the deck is as it was, and the tour begins.
  void begin_visit() {
    station_->kiosk().skip_lines();
    station_->move(300, 300);
    station_->click(340, 320);  // as a touch: a way and a press, which does nothing else
    ASSERT_FALSE(station_->kiosk().wait_for("exhibition visit").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("exhibition deck").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("tour ").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
    EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("selected 0 warn 0 fail 0 changed 0"))
        << station_->kiosk().last("generation ");
    let_settle();  // what comes right after the first touch belongs to it
  }
  /// Panels that fit their content have their place after a few pictures; while a caret blinks the kiosk never rests.
  static void let_settle() { std::this_thread::sleep_for(std::chrono::milliseconds(500)); }
  std::set<std::filesystem::path> files() const {
    std::set<std::filesystem::path> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(station_->folder()))
      if (entry.path().extension() == ".k") all.insert(entry.path());
    return all;
  }

  std::unique_ptr<Station> station_;
  std::string original_;
};

TEST_F(ExhibitionTest, the_show_edits_by_itself_and_begins_again_with_the_deck_as_it_was) {
  open_doors("");
  Process& kiosk = station_->kiosk();
  for (int round = 0; round < 2; ++round) {
    ASSERT_FALSE(kiosk.wait_for("show 1 of 3 A bump in a sheet").empty());
    if (round == 0) station_->show_people("exhibition_show");
    ASSERT_FALSE(kiosk.wait_for("show 3 of 3").empty());
    ASSERT_FALSE(
        kiosk.wait_until([](const std::string& line) { return line.starts_with("generation ") && line.ends_with("changed 1"); }).empty())
        << "it is the real program that edits";
    ASSERT_FALSE(kiosk.wait_for("exhibition deck").empty());
  }
  EXPECT_EQ(whole_file(station_->deck()), original_);
}

TEST_F(ExhibitionTest, a_visit_ends_by_itself_and_leaves_nothing) {
  open_doors("idle_s = 5\nwarning_s = 3\n");
  begin_visit();
  station_->show_people("exhibition_visit");
  station_->key("ctrl+a");
  station_->kiosk().skip_lines();
  station_->select_middle();
  station_->pull_arrow(50);
  station_->release();
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition warning").empty());
  station_->settled_aim();
  station_->show_people("exhibition_warning");
  // Any touch keeps it, and does nothing else.
  station_->kiosk().skip_lines();
  station_->move(310, 310);
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition visit").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition warning").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition over").empty());
  const auto over = std::chrono::steady_clock::now();
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition show").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition deck").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - over).count();
  RecordProperty("pristine_after_s", std::to_string(took));
  std::printf("pristine after %.2f s\n", took);
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 0")) << station_->kiosk().last("generation ");
  EXPECT_EQ(whole_file(station_->deck()), original_);
}

TEST_F(ExhibitionTest, a_model_server_that_crashes_in_a_visit_brings_none_of_its_edits_back) {
  open_doors("");
  begin_visit();
  station_->select_middle();
  station_->pull_arrow(50);
  station_->release();
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  station_->kiosk().skip_lines();
  station_->kill_model_server();
  station_->start_model_server();
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition over").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition show").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition deck").empty());
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 0")) << station_->kiosk().last("generation ");
  EXPECT_EQ(whole_file(station_->deck()), original_);
}

TEST_F(ExhibitionTest, files_are_closed_and_only_the_pin_leads_out) {
  open_doors("");
  const auto before = files();
  begin_visit();
  Process& kiosk = station_->kiosk();
  for (const char* key : {"ctrl+o", "ctrl+s", "ctrl+shift+s", "ctrl+shift+c"}) {
    kiosk.skip_lines();
    station_->key(key);
    EXPECT_FALSE(kiosk.wait_for("notice information Files are closed").empty()) << key;
    station_->key("Escape");
  }
  kiosk.skip_lines();
  station_->key("ctrl+q");
  ASSERT_FALSE(kiosk.wait_for("item \"pin back\"").empty()) << "the pad for the PIN";
  let_settle();
  station_->show_people("exhibition_pin");
  station_->type("0815");
  station_->key("Return");
  ASSERT_FALSE(kiosk.wait_for("exhibition PIN refused").empty());
  EXPECT_TRUE(kiosk.running());
  // By fingers, this time.
  for (const char* key : {"pin 4", "pin 7", "pin 1", "pin 1", "pin OK"}) {
    let_settle();
    station_->click_item(key);
  }
  ASSERT_FALSE(kiosk.wait_for("exhibition unlocked").empty());
  let_settle();
  station_->show_people("exhibition_unlocked");
  EXPECT_FALSE(station_->save_copy("by_staff.k").empty()) << "whoever knows the PIN works as always";
  EXPECT_EQ(files().size(), before.size() + 1);
  kiosk.skip_lines();
  station_->click_item("exhibition lock");
  ASSERT_FALSE(kiosk.wait_for("exhibition show").empty());
  EXPECT_EQ(whole_file(station_->deck()), original_);
}

TEST_F(ExhibitionTest, a_touch_target_is_as_large_as_a_finger) {
  open_doors("");
  begin_visit();
  station_->key("ctrl+q");
  ASSERT_FALSE(station_->kiosk().wait_for("item \"pin back\"").empty());
  let_settle();                  // a panel that fits its content has its place then
  const double pixel_mm = 0.27;  // of the profile mono
  for (const char* name : {"pin 1", "pin OK", "pin back"}) {
    const auto item = station_->item(name);
    ASSERT_TRUE(item.has_value());
    EXPECT_GE(item->height * pixel_mm, 15) << name;
    EXPECT_GE(item->width * pixel_mm, 15) << name;
  }
}

/// Seconds of random input; $PRISMESH_MONKEY_S sets others, for a soak.
double monkey_seconds() {
  const char* wanted = std::getenv("PRISMESH_MONKEY_S");  // NOLINT(concurrency-mt-unsafe): tests don't set it
  return wanted != nullptr ? std::stod(wanted) : 12;
}

long resident_mb(int pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/statm");
  long pages = 0, resident = 0;
  status >> pages >> resident;
  return resident * 4096 / 1'000'000;
}

TEST_F(ExhibitionTest, input_at_random_never_leads_out_and_leaves_nothing) {
  open_doors("idle_s = 5\nwarning_s = 1\n");
  const auto before = files();
  begin_visit();
  const int pid = station_->kiosk().pid();
  const char* seed = std::getenv("PRISMESH_SEED");  // NOLINT(concurrency-mt-unsafe): tests don't set it
  std::mt19937 random(seed != nullptr ? static_cast<unsigned>(std::stoul(seed)) : 20261128U);
  const auto any = [&](auto& list) { return list[random() % std::size(list)]; };
  const char* const kNamed[] = {"Escape", "Return", "Tab",  "space",  "Up",     "Down",      "Left",  "Right", "Home",
                                "End",    "Prior",  "Next", "Insert", "Delete", "BackSpace", "Print", "Menu",  "Super_L",
                                "F1",     "F2",     "F3",   "F4",     "F5",     "F6",        "F7",    "F8",    "F9",
                                "F10",    "F11",    "F12",  "plus",   "minus",  "period",    "comma", "slash"};
  const char* const kModifiers[] = {"", "", "ctrl+", "shift+", "ctrl+shift+", "alt+", "ctrl+alt+", "super+"};
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(monkey_seconds());
  std::size_t events = 0;
  std::vector<long> memory;
  while (std::chrono::steady_clock::now() < until) {
    std::vector<std::string> batch;
    for (int i = 0; i < 40; ++i, ++events) {
      const auto kind = random() % 10;
      const std::string x = std::to_string(random() % 1600), y = std::to_string(random() % 900);
      if (kind < 4) {
        const std::string letter(1, static_cast<char>('a' + random() % 26)), digit(1, static_cast<char>('0' + random() % 10));
        const auto which = random() % 3;
        batch.insert(batch.end(), {"key", std::string(any(kModifiers)) + (which == 0   ? std::string(any(kNamed))
                                                                          : which == 1 ? letter
                                                                                       : digit)});
      } else if (kind < 7) {
        batch.insert(batch.end(), {"mousemove", x, y, "click", std::to_string(1 + random() % 5)});
      } else {
        const std::string button = std::to_string(1 + random() % 3);
        batch.insert(batch.end(), {"mousemove", x, y, "mousedown", button, "mousemove", std::to_string(random() % 1600),
                                   std::to_string(random() % 900), "mouseup", button});
      }
    }
    station_->input(batch);
    ASSERT_TRUE(station_->kiosk().running()) << "after " << events << " inputs\n" << station_->kiosk().standard_error();
    memory.push_back(resident_mb(pid));
  }
  for (const char* button : {"1", "2", "3"}) station_->input({"mouseup", button});
  // Nobody is there any more: the show goes on, if the last visit hasn't ended already.
  station_->kiosk().skip_lines();
  ASSERT_FALSE(station_->kiosk().wait_for("show 1 of 3").empty());
  ASSERT_FALSE(station_->kiosk().wait_for("exhibition deck").empty());
  EXPECT_EQ(station_->kiosk().pid(), pid);
  EXPECT_EQ(files(), before) << "no deck was written";
  EXPECT_EQ(whole_file(station_->deck()), original_);
  std::printf("%zu inputs; MB resident: first %ld, most %ld, last %ld\n", events, memory.front(), *std::ranges::max_element(memory),
              resident_mb(pid));
}

}  // namespace
}  // namespace prismesh::test
