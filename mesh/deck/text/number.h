// Reads numbers in the fields of a card, in Fortran's forms and the usual ones. A blank field is zero.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace prismesh::mesh::deck {

/// Reads "-1.5", "1.5e-3", "1.D0", "1.5-3" (an exponent without its letter), "+7", ".5", "7.", with blanks around it. `value` is
/// correctly rounded. False: it isn't a number, or is too large for a double.
bool parse_real(std::string_view field, double& value);

/// Reads a whole number; "12." and "1.2E1" count as one. False: it isn't a whole number, or has more than 18 digits.
bool parse_integer(std::string_view field, std::int64_t& value);

/// Reads eight characters, blanks and then digits up to the end: the form of most ids. False: anything else, also blanks alone; use
/// parse_integer.
inline bool parse_eight_digits(const char* at, std::int64_t& value) {
  if constexpr (std::endian::native != std::endian::little) return false;
  constexpr std::uint64_t kEach = 0x0101010101010101u;
  std::uint64_t text = 0;
  std::memcpy(&text, at, sizeof text);
  // Digits have the bit 0x10, a blank is 0x20: a byte without the bit must be a blank, and blanks come first (in the low bytes).
  const std::uint64_t blank = ((~text >> 4) & kEach) * 0xffu;
  if (((text ^ (kEach * ' ')) & blank) != 0 || (blank & (blank + 1)) != 0 || blank == ~std::uint64_t{0}) return false;
  const std::uint64_t digits = (text | (kEach * 0x10u)) ^ (kEach * '0');
  if (((digits | (digits + kEach * 6)) & (kEach * 0xf0u)) != 0) return false;
  // Neighbours are combined: pairs, fours, eight.
  const std::uint64_t pairs = (digits * 10 + (digits >> 8)) & 0x00ff00ff00ff00ffu;
  const std::uint64_t fours = (pairs * 100 + (pairs >> 16)) & 0x0000ffff0000ffffu;
  value = static_cast<std::int64_t>((fours * 10000 + (fours >> 32)) & 0xffffffffu);
  return true;
}

/// Reads up to 18 digits with blanks around them; blanks alone are 0. False: anything else; use parse_integer.
inline bool plain_integer(const char* at, const char* end, std::int64_t& value) {
  if (end - at == 8 && parse_eight_digits(at, value)) return true;
  while (at < end && *at == ' ') ++at;
  std::int64_t sum = 0;
  const char* const limit = end - at > 18 ? at + 18 : end;
  while (at < limit && static_cast<unsigned char>(*at - '0') < 10) sum = sum * 10 + (*at++ - '0');
  while (at < end && *at == ' ') ++at;
  value = sum;
  return at == end;
}

/// The number of the line at an offset of a text, from 1.
long line_number(std::string_view text, std::size_t offset);

/// The text in quotes, for a message: at most 40 characters, unprintable ones as '?'.
std::string quoted(std::string_view text);

/// Without blanks, tabs, form feeds and a carriage return around it.
std::string_view trim(std::string_view text);

}  // namespace prismesh::mesh::deck
