#include "kiosk/display/kms/input.h"

#include <linux/input-event-codes.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::kiosk::display::kms {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Hands : public testing::Test {
 protected:
  explicit Hands(const KeyboardNames& names = {"pc105", "us", "", ""}) : input(*Keyboard::create(names), clock, {800, 600}) {}
  void press(std::uint32_t code) { input.key(code, true); }
  void release(std::uint32_t code) { input.key(code, false); }
  void type(std::uint32_t code) {
    press(code);
    release(code);
  }
  /// "down A shift", "text x", .. of all events.
  std::vector<std::string> said() {
    std::vector<std::string> lines;
    for (const WindowEvent& event : input.take()) {
      if (const auto* key = std::get_if<KeyChanged>(&event))
        lines.push_back(std::string(key->repeat ? "repeat "
                                    : key->down ? "down "
                                                : "up ") +
                        name_of(key->key) + (key->modifiers.shift ? " shift" : "") + (key->modifiers.ctrl ? " ctrl" : "") +
                        (key->modifiers.alt ? " alt" : ""));
      if (const auto* text = std::get_if<TextTyped>(&event)) lines.push_back("text " + text->text);
      if (std::holds_alternative<FocusLost>(event)) lines.emplace_back("lost");
      if (const auto* moved = std::get_if<PointerMoved>(&event))
        lines.push_back("at " + std::to_string(std::lround(moved->x)) + " " + std::to_string(std::lround(moved->y)));
      if (const auto* button = std::get_if<ButtonChanged>(&event)) lines.emplace_back(button->down ? "button" : "no button");
      if (const auto* wheel = std::get_if<WheelTurned>(&event)) lines.push_back("wheel " + std::to_string(std::lround(wheel->steps)));
    }
    return lines;
  }
  static std::string name_of(Key key) {
    const int code = static_cast<int>(key);
    return code > ' ' && code < 128 ? std::string(1, static_cast<char>(code)) : std::to_string(code);
  }

  ManualClock clock;
  Input input;
};

TEST_F(Hands, keys_have_their_meaning_and_text) {
  type(KEY_A);
  EXPECT_THAT(said(), ElementsAre("down A", "text a", "up A"));
  press(KEY_LEFTSHIFT);
  type(KEY_1);
  release(KEY_LEFTSHIFT);
  EXPECT_THAT(said(), ElementsAre("down 0", "down 1 shift", "text !", "up 1 shift", "up 0 shift"));
  press(KEY_LEFTCTRL);
  type(KEY_Z);
  EXPECT_THAT(said(), ElementsAre("down 0", "down Z ctrl", "up Z ctrl"));
}

TEST_F(Hands, a_key_of_two_keyboards_or_without_a_press_counts_once) {
  press(KEY_A);
  press(KEY_A);
  release(KEY_A);
  release(KEY_A);
  release(KEY_B);
  EXPECT_THAT(said(), ElementsAre("down A", "text a", "up A"));
}

TEST_F(Hands, held_keys_repeat) {
  press(KEY_A);
  said();
  ASSERT_EQ(input.next_ns(), Input::kFirstRepeatNs);
  clock.advance_ns(Input::kFirstRepeatNs - 1);
  input.turn();
  EXPECT_THAT(said(), IsEmpty());
  clock.advance_ns(1);
  input.turn();
  EXPECT_THAT(said(), ElementsAre("repeat A", "text a"));
  clock.advance_ns(100 * Input::kRepeatNs);  // a slow picture
  input.turn();
  input.turn();
  input.turn();
  EXPECT_LE(said().size(), 4U);
  release(KEY_A);
  EXPECT_FALSE(input.next_ns());
  press(KEY_LEFTSHIFT);
  EXPECT_FALSE(input.next_ns());
}

TEST_F(Hands, the_pointer_stays_in_the_picture_and_its_moves_are_one) {
  input.move_to(0.5, 0.5);
  input.move_by(10, -10);
  input.move_by(5, 0);
  const std::vector<WindowEvent> events = input.take();
  ASSERT_EQ(events.size(), 1U);
  const auto& moved = std::get<PointerMoved>(events[0]);
  EXPECT_EQ(moved.x, 415);
  EXPECT_EQ(moved.y, 290);
  EXPECT_THAT(moved.passed, ElementsAre(std::array{400.0, 300.0}, std::array{410.0, 290.0}));
  input.move_by(1e9, -1e9);
  EXPECT_THAT(said(), ElementsAre("at 799 0"));
  input.set_size({400, 300});
  EXPECT_THAT(said(), ElementsAre("at 399 0"));
}

TEST_F(Hands, buttons_and_wheel_have_a_place) {
  input.move_to(0.25, 0.5);
  input.button(MouseButton::left, true, 7);
  input.button(MouseButton::left, true, 8);  // the button of a second mouse
  input.button(MouseButton::left, false, 9);
  input.button(MouseButton::left, false, 10);
  input.wheel(-2);
  EXPECT_THAT(said(), ElementsAre("at 200 300", "button", "no button", "wheel -2"));
}

TEST_F(Hands, everything_counts_as_released_when_the_screen_is_lost) {
  press(KEY_LEFTCTRL);
  input.button(MouseButton::left, true, 0);
  said();
  input.lose();
  EXPECT_THAT(said(), ElementsAre("lost"));
  EXPECT_FALSE(input.next_ns());
  type(KEY_A);
  EXPECT_THAT(said(), ElementsAre("down A", "text a", "up A"));
  release(KEY_LEFTCTRL);
  EXPECT_THAT(said(), IsEmpty());
}

TEST_F(Hands, ask_for_a_text_console) {
  press(KEY_LEFTCTRL);
  press(KEY_LEFTALT);
  said();
  press(KEY_F3);
  EXPECT_EQ(input.take_console(), 3);
  EXPECT_EQ(input.take_console(), 0);
  EXPECT_THAT(said(), IsEmpty());
}

class GermanHands : public Hands {
 protected:
  GermanHands() : Hands({"pc105", "de", "", ""}) {}
};

TEST_F(GermanHands, type_their_layout) {
  type(KEY_Y);
  type(KEY_APOSTROPHE);
  EXPECT_THAT(said(), ElementsAre("down Z", "text z", "up Z", "down 0", "text \xc3\xa4", "up 0"));
}

TEST(Keyboard, layouts_that_dont_exist_are_an_error) {
  const Result<Keyboard> keyboard = Keyboard::create({"", "klingon", "", ""});
  ASSERT_FALSE(keyboard);
  EXPECT_EQ(keyboard.error().text(), "/etc/default/keyboard: there is no keyboard layout \"klingon\" with the variant \"\"");
}

}  // namespace
}  // namespace prismesh::kiosk::display::kms
