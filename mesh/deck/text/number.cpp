#include "mesh/deck/text/number.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace prismesh::mesh::deck {
namespace {

constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::size_t kMaxNumberLength = 128;
constexpr std::uint64_t kExactIntegers = std::uint64_t{1} << 53;

bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

/// The parts of a decimal number.
struct Decimal {
  bool negative = false;
  std::uint64_t digits = 0;  ///< all significant digits, where there are at most 19
  int digit_count = 0;       ///< significant ones
  int after_point = 0;
  int exponent = 0;
};

/// Reads the exponent that starts at text[at]: "e-3", "D+10", "-3". False: there is something else.
bool read_exponent(std::string_view text, std::size_t at, int& exponent) {
  const char letter = text[at];
  if (letter == 'e' || letter == 'E' || letter == 'd' || letter == 'D') ++at;
  bool negative = false;
  if (at < text.size() && (text[at] == '+' || text[at] == '-')) negative = text[at++] == '-';
  if (at >= text.size()) return false;
  int value = 0;
  for (; at < text.size(); ++at) {
    if (!is_digit(text[at])) return false;
    if (value < 100000) value = value * 10 + (text[at] - '0');
  }
  exponent = negative ? -value : value;
  return true;
}

/// Splits a trimmed, non-empty number into its parts. False: it isn't one.
bool take_apart(std::string_view text, Decimal& decimal) {
  std::size_t at = 0;
  if (text[0] == '+' || text[0] == '-') decimal.negative = text[at++] == '-';
  bool any = false;
  bool point = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (is_digit(c)) {
      any = true;
      decimal.digits = decimal.digits * 10 + static_cast<std::uint64_t>(c - '0');  // wraps beyond 19: not used then
      if (decimal.digit_count > 0 || c != '0') ++decimal.digit_count;
      if (point) ++decimal.after_point;
    } else if (c == '.' && !point) {
      point = true;
    } else {
      break;
    }
  }
  if (!any) return false;
  return at == text.size() || read_exponent(text, at, decimal.exponent);
}

/// Reads a number with from_chars, in the form it needs: no leading plus, an 'e' before the exponent.
bool parse_slowly(std::string_view text, const Decimal& decimal, double& value) {
  char buffer[kMaxNumberLength + 16];
  char* out = buffer;
  std::size_t at = 0;
  if (text[0] == '+' || text[0] == '-') at = 1;
  while (at < text.size() && (is_digit(text[at]) || text[at] == '.')) *out++ = text[at++];
  *out++ = 'e';
  out = std::to_chars(out, buffer + sizeof buffer, decimal.exponent).ptr;
  const auto [end, error] = std::from_chars(buffer, out, value);
  if (error == std::errc::result_out_of_range) {
    if (decimal.exponent + decimal.digit_count - decimal.after_point > 0) return false;
    value = 0;
  } else if (error != std::errc() || end != out) {
    return false;
  }
  if (decimal.negative) value = -value;
  return std::isfinite(value);
}

}  // namespace

std::string_view trim(std::string_view text) {
  // Form feeds come from printer output.
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '\f')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r' || text.back() == '\f')) text.remove_suffix(1);
  return text;
}

bool parse_real(std::string_view field, double& value) {
  while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
  while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
  value = 0;
  if (field.empty()) return true;
  if (field.size() > kMaxNumberLength) return false;
  Decimal decimal;
  if (!take_apart(field, decimal)) return false;
  const int power = decimal.exponent - decimal.after_point;
  // Both factors are exact, so the product or quotient is rounded once and correctly [Clinger 1990].
  if (decimal.digit_count <= 19 && decimal.digits <= kExactIntegers && power >= -22 && power <= 22) {
    const auto digits = static_cast<double>(decimal.digits);
    value = power < 0 ? digits / kPowersOfTen[-power] : digits * kPowersOfTen[power];
    if (decimal.negative) value = -value;
    return true;
  }
  return parse_slowly(field, decimal, value);
}

bool parse_integer(std::string_view field, std::int64_t& value) {
  if (field.size() == 8 && parse_eight_digits(field.data(), value)) return true;
  while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
  while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
  value = 0;
  if (field.empty()) return true;
  std::size_t at = 0;
  bool negative = false;
  if (field[0] == '+' || field[0] == '-') negative = field[at++] == '-';
  const std::size_t first = at;
  while (at < field.size() && at - first < 18 && is_digit(field[at])) value = value * 10 + (field[at++] - '0');
  if (at == field.size() && at > first) {
    if (negative) value = -value;
    return true;
  }
  double real = 0;
  if (!parse_real(field, real) || real != std::floor(real) || std::abs(real) >= 1e18) return false;
  value = static_cast<std::int64_t>(real);
  return true;
}

long line_number(std::string_view text, std::size_t offset) {
  return 1 + static_cast<long>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size())), '\n'));
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c != 127 ? c : '?';
  return out + (text.size() > 40 ? "...\"" : "\"");
}

}  // namespace prismesh::mesh::deck
