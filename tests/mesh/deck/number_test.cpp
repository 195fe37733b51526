#include "mesh/deck/text/number.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "mesh/deck/text/format_number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

struct RealCase {
  const char* text;
  double value;
};

TEST(ParseReal, knows_fortrans_forms) {
  const RealCase cases[] = {{"", 0},
                            {"      ", 0},
                            {"1", 1},
                            {" 1. ", 1},
                            {".5", 0.5},
                            {"+7.25", 7.25},
                            {"-0.125", -0.125},
                            {"1.0-3", 1e-3},
                            {"1.5+2", 150},
                            {"1.D0", 1},
                            {"2.5d-1", 0.25},
                            {"1E5", 1e5},
                            {"1.e+05", 1e5},
                            {"-1.00000+4", -1e4},
                            {"7.34000-4", 7.34e-4},
                            {"1.0E-3 ", 1e-3},
                            {"-6.3173120E-6", -6.3173120e-6},
                            {"00012.5", 12.5},
                            {"0.1", 0.1},
                            {"1.0E22", 1e22},
                            {"123456789012345678", 123456789012345678.0},
                            {"0.30000000000000004", 0.1 + 0.2},
                            {"2.2250738585072014E-308", std::numeric_limits<double>::min()},
                            {"1.7976931348623157E308", std::numeric_limits<double>::max()},
                            {"1e-400", 0},
                            {"9007199254740993", 9007199254740992.0},
                            {"9007199254740993.0000001", 9007199254740994.0}};
  for (const RealCase& c : cases) {
    double value = -1;
    EXPECT_TRUE(parse_real(c.text, value)) << c.text;
    EXPECT_EQ(value, c.value) << c.text;
  }
}

TEST(ParseReal, refuses_what_is_no_number) {
  for (const char* text : {"abc", "1.0.0", "--1", "1e", "1e+", "+", ".", "1 2", "0x10", "nan", "inf", "1e400", "&name", "1,0", "1.0E-3x"}) {
    double value = 0;
    EXPECT_FALSE(parse_real(text, value)) << text;
  }
  double value = 0;
  EXPECT_FALSE(parse_real(std::string(1000000, '1'), value));
}

TEST(ParseInteger, takes_whole_numbers_in_any_form) {
  const std::pair<const char*, std::int64_t> cases[] = {
      {"", 0}, {"   12", 12}, {"-7", -7}, {"+3", 3}, {"12.", 12}, {"12.0", 12}, {"1.2E1", 12}, {"999999999999999999", 999999999999999999}};
  for (const auto& [text, wanted] : cases) {
    std::int64_t value = -1;
    EXPECT_TRUE(parse_integer(text, value)) << text;
    EXPECT_EQ(value, wanted) << text;
  }
  for (const char* text : {"1.5", "x", "1 2", "1e30", "99999999999999999999"}) {
    std::int64_t value = 0;
    EXPECT_FALSE(parse_integer(text, value)) << text;
  }
}

TEST(PlainInteger, takes_blanks_around_up_to_eighteen_digits) {
  for (std::size_t digits = 0; digits <= 40; ++digits) {
    for (const auto& [before, after] : {std::pair{"", ""}, {"  ", ""}, {"", "  "}, {"   ", " "}}) {
      const std::string text = before + std::string(digits, '9') + after;
      std::int64_t value = -1;
      ASSERT_EQ(plain_integer(text.data(), text.data() + text.size(), value), digits <= 18) << '"' << text << '"';
      if (digits <= 18) {
        ASSERT_EQ(value, digits == 0 ? 0 : std::stoll(text)) << '"' << text << '"';
      }
    }
  }
}

TEST(FormatCoordinate, takes_the_shortest_text_that_reads_back) {
  const std::pair<double, const char*> cases[] = {
      {0, "0.0"},       {-0.0, "0.0"},     {1, "1.0"},           {-12.5, "-12.5"}, {0.1, "0.1"},
      {1200, "1200.0"}, {1e-5, "0.00001"}, {1.5e-20, "1.5E-20"}, {3e30, "3.0E30"}, {-886.41901, "-886.41901"}};
  for (const auto& [value, wanted] : cases) EXPECT_EQ(format_coordinate(value, 16), wanted);
}

TEST(FormatCoordinate, is_as_precise_as_the_field_allows) {
  EXPECT_EQ(format_coordinate(1.0 / 3, 16), ".333333333333333");
  EXPECT_EQ(format_coordinate(-1.0 / 3, 16), "-.33333333333333");
  EXPECT_EQ(format_coordinate(-123.456789012345678, 16), "-123.45678901235");
  EXPECT_EQ(format_coordinate(9.99999999999999999, 4), "10.0");
  EXPECT_EQ(format_coordinate(1.0 / 3, 20), "0.3333333333333333");
}

/// Whatever the width, no text of that width would be nearer than a unit in its last place.
TEST(FormatCoordinate, reads_back_within_the_fields_precision) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200000; ++i) {
    const double magnitude = std::pow(10.0, static_cast<double>(random() % 24) - 12.0);
    const double value =
        (static_cast<double>(random() % 2000001) / 1e6 - 1) * magnitude * (1 + 1e-13 * static_cast<double>(random() % 1000));
    for (const std::size_t width : {std::size_t{16}, std::size_t{20}}) {
      const std::string text = format_coordinate(value, width);
      ASSERT_LE(text.size(), width);
      ASSERT_NE(text.find('.'), std::string::npos) << text;
      double back = 0;
      ASSERT_TRUE(parse_real(text, back)) << text;
      ASSERT_EQ(back, std::strtod(text.c_str(), nullptr)) << text;
      // 16 columns with sign, point and an exponent like E-12 leave ten digits.
      ASSERT_NEAR(back, value, std::abs(value) * (width == 16 ? 1e-9 : 1e-13)) << text;
    }
  }
}

TEST(ParseEightDigits, takes_blanks_then_digits_and_nothing_else) {
  constexpr std::string_view kOthers = "0123456789 +-.:/!*\tpP\xf5\x10";
  std::mt19937_64 random(3);
  for (int i = 0; i < 500000; ++i) {
    std::string text(8, ' ');
    const std::size_t first = random() % 9;
    for (std::size_t c = first; c < 8; ++c)
      text[c] = random() % 40 > 0 ? static_cast<char>('0' + random() % 10) : kOthers[random() % kOthers.size()];
    const std::size_t begin = text.find_first_not_of(' ');
    const bool plain = begin != std::string::npos && text.find_first_not_of("0123456789", begin) == std::string::npos;
    std::int64_t value = -1;
    ASSERT_EQ(parse_eight_digits(text.data(), value), plain) << text;
    if (plain) {
      ASSERT_EQ(value, std::stoll(text)) << text;
    }
  }
}

TEST(ParseReal, rounds_as_the_standard_library_does) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 200000; ++i) {
    std::string text = std::to_string(random() % 1000000) + "." + std::to_string(random());
    text.resize(std::min<std::size_t>(text.size(), 8 + random() % 16));
    if (random() % 2) text += "E" + std::to_string(static_cast<int>(random() % 60) - 30);
    double value = 0;
    ASSERT_TRUE(parse_real(text, value)) << text;
    ASSERT_EQ(value, std::strtod(text.c_str(), nullptr)) << text;
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck::lsdyna
