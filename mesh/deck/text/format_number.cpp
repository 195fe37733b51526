#include "mesh/deck/text/format_number.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace prismesh::mesh::deck {
namespace {

constexpr int kMaxDigits = 17;  // as many as tell any two doubles apart

/// value = d.ddd... * 10^exponent, without trailing zeros.
struct Digits {
  std::string digits;
  int exponent = 0;
};

Digits split(const char* begin, const char* end) {
  Digits out;
  const char* at = begin;
  for (; at < end && *at != 'e'; ++at)
    if (*at != '.') out.digits += *at;
  out.exponent = std::atoi(at + 1);
  while (out.digits.size() > 1 && out.digits.back() == '0') out.digits.pop_back();
  return out;
}

Digits shortest_digits(double value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer - 1, value, std::chars_format::scientific).ptr;
  *end = '\0';
  return split(buffer, end);
}

Digits rounded_digits(double value, int digits) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer - 1, value, std::chars_format::scientific, digits - 1).ptr;
  *end = '\0';
  return split(buffer, end);
}

/// "12.5", "0.0125", "1200.0"; empty beyond what any field holds.
std::string fixed_text(const Digits& d, bool leading_zero) {
  const int count = static_cast<int>(d.digits.size());
  if (std::abs(d.exponent) > 40) return {};
  if (d.exponent < 0)
    return std::string(leading_zero ? "0." : ".") + std::string(static_cast<std::size_t>(-d.exponent - 1), '0') + d.digits;
  if (d.exponent >= count - 1)
    return d.digits + std::string(static_cast<std::size_t>(d.exponent - count + 1), '0') + (leading_zero ? ".0" : ".");
  return d.digits.substr(0, static_cast<std::size_t>(d.exponent) + 1) + "." + d.digits.substr(static_cast<std::size_t>(d.exponent) + 1);
}

std::string scientific_text(const Digits& d, Exponent exponent) {
  const std::string power = std::to_string(d.exponent);
  if (exponent == Exponent::bare) return d.digits.substr(0, 1) + "." + d.digits.substr(1) + (d.exponent < 0 ? "" : "+") + power;
  return d.digits.substr(0, 1) + "." + (d.digits.size() > 1 ? d.digits.substr(1) : "0") + "E" + power;
}

/// The first of the ways to write the digits that fits; empty if none does.
std::string fit(const Digits& d, bool negative, std::size_t width, Exponent exponent) {
  const std::string sign = negative ? "-" : "";
  for (const std::string& text : {fixed_text(d, true), fixed_text(d, false), scientific_text(d, exponent)})
    if (!text.empty() && sign.size() + text.size() <= width) return sign + text;
  return {};
}

}  // namespace

std::string format_coordinate(double value, std::size_t width, Exponent exponent) {
  if (value == 0) return std::string("0.0").substr(0, std::max<std::size_t>(width, 1));
  const bool negative = value < 0;
  const double magnitude = std::abs(value);
  std::string text = fit(shortest_digits(magnitude), negative, width, exponent);
  for (int digits = kMaxDigits - 1; text.empty() && digits >= 1; --digits)
    text = fit(rounded_digits(magnitude, digits), negative, width, exponent);
  return text;
}

}  // namespace prismesh::mesh::deck
