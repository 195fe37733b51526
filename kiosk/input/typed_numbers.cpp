#include "kiosk/input/typed_numbers.h"

#include <charconv>
#include <cmath>
#include <string>

namespace prismesh::kiosk::input {

Result<std::vector<double>> parse_numbers(std::string_view text) {
  constexpr std::string_view kBetween = " ,;\t";
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = text.find_first_not_of(kBetween, at)) != std::string_view::npos;) {
    std::string_view word = text.substr(at, text.find_first_of(kBetween, at) - at);
    at += word.size();
    const std::string_view whole = word;
    if (word.starts_with('+')) word.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number))
      return fail("", "\"" + std::string(whole) + "\" is no number; write it like 12.5");
    numbers.push_back(number);
  }
  if (numbers.empty()) return fail("", "type a number");
  return numbers;
}

}  // namespace prismesh::kiosk::input
