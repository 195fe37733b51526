// The exhibition without a display: its stages on a virtual clock, the PIN and its waits, the show's file, and what is asked of the server.
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/tools/exhibition/allowed_requests.h"
#include "kiosk/tools/exhibition/exhibition_tool.h"
#include "kiosk/tools/exhibition/pin_gate.h"
#include "kiosk/tools/exhibition/show_clock.h"
#include "kiosk/tools/exhibition/show_script.h"
#include "mesh/document/edit_json.h"

namespace prismesh::kiosk::tools::exhibition {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecondNs = 1'000'000'000;

class ExhibitionStages : public testing::Test {
 protected:
  void wait(double seconds) {
    now_ += static_cast<std::int64_t>(seconds * 1e9);
    clock_.turn(now_);
  }
  std::int64_t now_ = 7 * kSecondNs;
  ShowClock clock_{{60 * kSecondNs, 10 * kSecondNs, 300 * kSecondNs}};
};

TEST_F(ExhibitionStages, the_show_goes_on_until_somebody_touches_it) {
  wait(100'000);
  EXPECT_EQ(clock_.stage(), Stage::show);
  EXPECT_TRUE(clock_.touched(now_)) << "the first touch does nothing to the model";
  EXPECT_EQ(clock_.stage(), Stage::visit);
  EXPECT_FALSE(clock_.touched(now_)) << "the next one does";
}

TEST_F(ExhibitionStages, a_visit_ends_with_a_warning_that_any_touch_takes_back) {
  clock_.touched(now_);
  for (int minute = 0; minute < 10; ++minute) {
    wait(59);
    EXPECT_EQ(clock_.stage(), Stage::visit);
    clock_.touched(now_);
  }
  wait(60);
  ASSERT_EQ(clock_.stage(), Stage::warning);
  EXPECT_EQ(clock_.seconds_left(now_), 10);
  wait(9.5);
  EXPECT_EQ(clock_.seconds_left(now_), 1);
  EXPECT_TRUE(clock_.touched(now_)) << "what keeps the visit is no work on the model";
  EXPECT_EQ(clock_.stage(), Stage::visit);
  wait(60);
  wait(10);
  EXPECT_EQ(clock_.stage(), Stage::over);
  EXPECT_TRUE(clock_.touched(now_)) << "too late";
  EXPECT_EQ(clock_.stage(), Stage::over);
}

TEST_F(ExhibitionStages, a_face_that_comes_ends_the_show_and_one_that_stays_does_not_end_the_next) {
  clock_.face(true, now_);
  wait(5);
  clock_.face(true, now_);
  EXPECT_EQ(clock_.stage(), Stage::show) << "it was there before: it has seen the visit that ended";
  clock_.face(false, now_);
  wait(1);
  clock_.face(true, now_);
  wait(1);
  clock_.face(true, now_);
  EXPECT_EQ(clock_.stage(), Stage::show) << "the tracker has lost it for a moment";
  const auto leave = [&] {
    clock_.face(false, now_);
    wait(2);
    clock_.face(false, now_);
  };
  leave();
  clock_.face(true, now_);
  wait(0.3);
  clock_.face(true, now_);
  EXPECT_EQ(clock_.stage(), Stage::show) << "somebody walks by";
  leave();
  clock_.face(true, now_);
  wait(0.8);
  clock_.face(true, now_);
  EXPECT_EQ(clock_.stage(), Stage::visit);
  for (int second = 0; second < 60; ++second) {
    wait(1);
    clock_.face(true, now_);
  }
  EXPECT_EQ(clock_.stage(), Stage::warning) << "a chair has a face too";
}

TEST(ExhibitionFace, is_seen_by_a_tracker_that_works) {
  using toolkit::EyesFacts;
  EyesFacts facts;
  EXPECT_EQ(face_seen(std::nullopt), std::nullopt);
  facts.condition = EyesFacts::Condition::trouble;
  EXPECT_EQ(face_seen(facts), std::nullopt) << "a tracker that is unplugged says nothing of who is there";
  facts.condition = EyesFacts::Condition::waiting;
  EXPECT_EQ(face_seen(facts), std::optional(false));
  facts.condition = EyesFacts::Condition::good;
  EXPECT_EQ(face_seen(facts), std::optional(true));
}

TEST_F(ExhibitionStages, it_locks_itself_again) {
  clock_.touched(now_);
  clock_.unlock(now_);
  wait(299);
  EXPECT_FALSE(clock_.touched(now_));
  wait(299);
  EXPECT_EQ(clock_.stage(), Stage::unlocked);
  wait(1);
  EXPECT_EQ(clock_.stage(), Stage::over);
}

TEST_F(ExhibitionStages, it_wakes_the_program_in_time) {
  clock_.touched(now_);
  EXPECT_EQ(clock_.next_ns(now_), now_ + 60 * kSecondNs);
  wait(60);
  EXPECT_LE(clock_.next_ns(now_), now_ + kSecondNs) << "the seconds are counted down";
}

// --- the PIN ---

/// `openssl passwd -6 -salt saltsalt 4711`
constexpr const char* kHashOf4711 = "$6$saltsalt$FMJn4/2F8fwlOAepBqo55eJQliVblvlAkyYrm7ZgY2hOG.THZlaAgT9HsBp.0WJ9xljSPF4I6D1oS.F1QFWKI.";

TEST(ExhibitionPin, is_compared_with_its_hash) {
  EXPECT_TRUE(pin_matches("4711", kHashOf4711));
  EXPECT_FALSE(pin_matches("4712", kHashOf4711));
  EXPECT_FALSE(pin_matches("", kHashOf4711));
  for (const char* hash : {"", "4711", "*", "*0", "$", "$6$", "$9$unknown$x", "$6$saltsalt$"})
    EXPECT_FALSE(pin_matches("4711", hash)) << hash;
}

TEST(ExhibitionPin, whoever_guesses_waits_longer_each_time) {
  PinTries tries;
  std::int64_t now = 1'000'000;
  std::vector<std::int64_t> waits;
  for (int i = 0; i < 12; ++i) {
    tries = after_wrong(tries, now);
    waits.push_back(wait_s(tries, now));
    now += waits.back();
  }
  EXPECT_THAT(waits, testing::ElementsAre(0, 0, 30, 60, 120, 240, 480, 960, 1920, 3600, 3600, 3600));
  EXPECT_EQ(wait_s(tries, now - 100'000'000), 3600) << "a clock that was set back locks nobody out for longer";
}

TEST(ExhibitionPin, waits_survive_the_program) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "pin-tries-test" / "tries";
  std::filesystem::remove_all(file.parent_path());
  constexpr std::int64_t kNow = 1'000'000;
  {
    PinGate gate(kHashOf4711, file);
    for (int i = 0; i < kFreeTries; ++i) EXPECT_FALSE(gate.try_pin("0000", kNow));
  }
  PinGate again(kHashOf4711, file);
  EXPECT_EQ(again.wait_s(kNow), 30);
  EXPECT_FALSE(again.try_pin("4711", kNow)) << "even the right one";
  EXPECT_TRUE(again.try_pin("4711", kNow + 30));
  EXPECT_EQ(PinGate(kHashOf4711, file).wait_s(kNow), 0) << "the right one forgives";
  const std::filesystem::path nowhere = "/proc/nothing/can/be/written/here";
  for (int i = 0; i < kFreeTries; ++i) EXPECT_FALSE(PinGate(kHashOf4711, nowhere).try_pin("0000", kNow)) << "a gate for each visit";
  EXPECT_EQ(PinGate(kHashOf4711, nowhere).wait_s(kNow), 30) << "the program remembers";
  EXPECT_FALSE(PinGate("", file).try_pin("", kNow)) << "without a PIN there is no way in";
  std::filesystem::remove_all(file.parent_path());
}

// --- the show ---

TEST(ExhibitionShow, is_read_line_by_line) {
  const auto show = parse_show(
      "# a comment\n\n{\"title\":\"A bead\",\"words\":\"in three strokes\",\"seconds\":2.5,\"fit\":\"model\"}\r\n"
      "{\"edit\":{\"edit\":\"undo\"},\"turn\":[30,-10],\"zoom\":2}",
      "show.jsonl");
  ASSERT_TRUE(show) << show.error().text();
  ASSERT_EQ(show->size(), 2U);
  EXPECT_EQ((*show)[0].title, "A bead");
  EXPECT_EQ((*show)[0].seconds, 2.5);
  EXPECT_EQ((*show)[0].fit, ShowStep::Fit::model);
  EXPECT_FALSE((*show)[0].edit);
  EXPECT_TRUE((*show)[1].edit);
  EXPECT_EQ((*show)[1].turn_up, -10);
  EXPECT_EQ((*show)[1].zoom, 2);
}

TEST(ExhibitionShow, says_what_is_wrong_and_where) {
  const auto fault = [](const std::string& text) {
    const auto show = parse_show(text, "show.jsonl");
    return show ? std::string("none") : show.error().text();
  };
  EXPECT_THAT(fault(""), HasSubstr("no step"));
  EXPECT_EQ(fault("{}\nthis"), "show.jsonl:2: this isn't JSON");
  EXPECT_THAT(fault("[]"), HasSubstr("show.jsonl:1: a step is an object"));
  EXPECT_THAT(fault("{\"titel\":\"x\"}"), HasSubstr("\"titel\" is no field"));
  EXPECT_THAT(fault("{\"seconds\":-1}"), HasSubstr("\"seconds\" must be a number from 0 to 120"));
  EXPECT_THAT(fault("{\"zoom\":0}"), HasSubstr("\"zoom\""));
  EXPECT_THAT(fault("{\"turn\":[1]}"), HasSubstr("two numbers"));
  EXPECT_THAT(fault("{\"fit\":\"all\"}"), HasSubstr("\"fit\""));
  EXPECT_THAT(fault("{\"edit\":{\"edit\":\"lfit\"}}"), HasSubstr("lift"));
  EXPECT_THAT(fault("{\"edit\":{\"edit\":\"replace_part\",\"part\":1,\"deck\":\"/etc/passwd\"}}"), HasSubstr("reads or writes a file"));
  EXPECT_THAT(fault("{\"title\":\"" + std::string(500, 'x') + "\"}"), HasSubstr("at most 400"));
  EXPECT_FALSE(read_show("/nonexistent/show.jsonl"));
}

TEST(ExhibitionShow, survives_any_text) {
  const std::string good = "{\"title\":\"A\",\"seconds\":2,\"turn\":[1,2],\"edit\":{\"edit\":\"lift\",\"distance\":10,\"on\":\"1-9\"}}\n";
  std::mt19937 random(4);
  for (int round = 0; round < 5000; ++round) {
    std::string text = good + good;
    for (int change = 0; change < 3; ++change) {
      const std::size_t at = random() % text.size();
      if (random() % 3 == 0)
        text.erase(at, random() % 9);
      else
        text[at] = static_cast<char>(random() % 256);
      if (text.empty()) break;
    }
    const auto show = parse_show(text, "x");
    if (!show) {
      EXPECT_FALSE(show.error().message.empty());
    }
  }
}

// --- what the server is asked for ---

TEST(ExhibitionRequests, reach_no_other_file) {
  const std::filesystem::path deck = "/srv/show/sample.k";
  const auto open = [](const std::string& path) {
    ipc::Open request;
    request.path = path;
    return request;
  };
  EXPECT_TRUE(is_allowed(open(deck.string()), deck));
  EXPECT_FALSE(is_allowed(open("/etc/passwd"), deck));
  ipc::Open stored;
  stored.stored = "abc";
  EXPECT_FALSE(is_allowed(stored, deck));
  EXPECT_FALSE(is_allowed(ipc::Save{}, deck));
  ipc::GetField field;
  EXPECT_TRUE(is_allowed(field, deck)) << "against the deck as it was opened";
  field.against = "/etc/passwd";
  EXPECT_FALSE(is_allowed(field, deck));
  const auto edit = [&](const std::string& text) {
    const auto read = mesh::document::parse_edit(text);
    EXPECT_TRUE(read) << text;
    return read ? std::pair(is_allowed(ipc::ApplyEdit{*read}, deck), is_allowed(ipc::PreviewEdit{*read}, deck)) : std::pair(false, true);
  };
  const std::pair both(true, true), neither(false, false);
  EXPECT_EQ(edit(R"({"edit":"lift","distance":3})"), both);
  EXPECT_EQ(edit(R"({"edit":"set_criteria","criteria":"deck"})"), neither) << "kept in a file beside the deck";
  EXPECT_EQ(edit(R"({"edit":"set_target_size","size":5})"), neither) << "as well";
  EXPECT_EQ(edit(R"({"edit":"set_criteria","criteria":"../mine.json"})"), neither);
  EXPECT_EQ(edit(R"({"edit":"replace_part","part":1,"deck":"other.k"})"), neither);
  EXPECT_EQ(edit(R"({"edit":"weld","points_file":"points.csv"})"), neither);
  EXPECT_TRUE(is_allowed(ipc::GetState{}, deck));
  EXPECT_TRUE(is_allowed(ipc::GetSnapshot{}, deck));
}

}  // namespace
}  // namespace prismesh::kiosk::tools::exhibition
