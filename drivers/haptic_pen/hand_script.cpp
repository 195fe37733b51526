#include "drivers/haptic_pen/hand_script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <system_error>

namespace prismesh::drivers::haptic_pen {
namespace {

constexpr double kMaxPlaceMm = 60;
constexpr double kMaxSeconds = 86'400;
constexpr double kMaxTrembleMm = 5;
/// A hand trembles at about 9 times a second; two further rates keep it from repeating.
constexpr std::array kTrembleRates{9.0, 11.3, 7.7};

std::string_view take_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t\r"), line.size());
  const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// Takes a number from `least` to `most`.
template <class Number>
bool take(std::string_view& line, Number least, Number most, Number& number) {
  const std::string_view word = take_word(line);
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  return problem == std::errc() && end == word.data() + word.size() && !word.empty() && number >= least && number <= most;
}

}  // namespace

Result<HandScript> HandScript::parse(std::string_view text, const std::string& file) {
  HandScript script;
  long number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = text.substr(0, std::min(text.substr(0, end).find('#'), end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (rest.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    Line line;
    const bool has_place = take(rest, 0.0, kMaxSeconds, line.seconds) && take(rest, -kMaxPlaceMm, kMaxPlaceMm, line.place_mm.x()) &&
                           take(rest, -kMaxPlaceMm, kMaxPlaceMm, line.place_mm.y()) &&
                           take(rest, -kMaxPlaceMm, kMaxPlaceMm, line.place_mm.z());
    if (!has_place) return fail(file, number, "expected seconds, then x y z from -60 to 60 mm");
    if (!take(rest, 0U, 3U, line.buttons)) return fail(file, number, "expected the buttons behind the place: 0 to 3");
    if (!take(rest, 0.0, kMaxTrembleMm, line.tremble_mm))
      return fail(file, number, "expected how far the hand trembles behind the buttons: 0 to 5 mm");
    const std::string_view grip = take_word(rest);
    if ((grip != "holds" && grip != "free") || !take_word(rest).empty())
      return fail(file, number, "expected \"holds\" or \"free\" at the end");
    line.holds = grip == "holds";
    if (!script.lines_.empty() && !(line.seconds > script.lines_.back().seconds))
      return fail(file, number, "the time must be later than that of the line before");
    script.lines_.push_back(line);
  }
  if (script.lines_.empty()) return fail(file, "it says nothing of what the hand does");
  return script;
}

SimulatedHand HandScript::at(double seconds) const {
  const auto next = std::upper_bound(lines_.begin(), lines_.end(), seconds, [](double s, const Line& line) { return s < line.seconds; });
  const Line& now = next == lines_.begin() ? lines_.front() : *std::prev(next);
  SimulatedHand hand;
  hand.goal_mm = now.place_mm;
  if (next != lines_.begin() && next != lines_.end()) {
    const double share = (seconds - now.seconds) / (next->seconds - now.seconds);
    hand.goal_mm += share * (next->place_mm - now.place_mm);
  }
  for (int axis = 0; axis < 3; ++axis)
    hand.goal_mm[axis] += now.tremble_mm * std::sin(2 * M_PI * kTrembleRates[static_cast<std::size_t>(axis)] * seconds + axis);
  hand.buttons = now.buttons;
  if (!now.holds) hand.stiffness_newton_m = hand.damping_newton_s_m = 0;
  return hand;
}

}  // namespace prismesh::drivers::haptic_pen
