#include "base/readable_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace prismesh {

namespace {

constexpr double kMin = 1e-9, kMax = 1e12;  ///< range of numbers without an exponent

std::string in_format(double value, std::chars_format format, int precision) {
  std::array<char, 64> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, precision).ptr;
  return {text.data(), end};
}

/// The decimal position of the first digit after rounding to that many digits: 0 for ones, 1 for tens, -1 for tenths.
int place_of_first_digit(double value, int digits) {
  const std::string text = in_format(value, std::chars_format::scientific, digits - 1);
  const std::size_t exponent = text.find('e');
  int place = 0;
  const char* begin = text.data() + exponent + (text[exponent + 1] == '+' ? 2 : 1);
  std::from_chars(begin, text.data() + text.size(), place);
  return place;
}

std::string with_decimals(double value, int decimals) {
  std::string text = in_format(value, std::chars_format::fixed, std::max(0, decimals));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

bool plain(double value) { return value == 0 || (std::abs(value) >= kMin && std::abs(value) < kMax); }

}  // namespace

std::string readable(double value, int digits) {
  if (!std::isfinite(value) || !plain(value)) return in_format(value, std::chars_format::general, digits);
  return value == 0 ? "0" : with_decimals(value, digits - 1 - place_of_first_digit(value, digits));
}

std::string readable(const std::array<double, 3>& values, int digits) {
  double largest = 0;
  bool all_plain = true;
  for (const double value : values) {
    all_plain = all_plain && std::isfinite(value);
    largest = std::max(largest, std::abs(value));
  }
  all_plain = all_plain && plain(largest);
  const int decimals = all_plain && largest > 0 ? digits - 1 - place_of_first_digit(largest, digits) : 0;
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : " ") + (all_plain ? with_decimals(value, decimals) : readable(value, digits));
  return text;
}

}  // namespace prismesh
