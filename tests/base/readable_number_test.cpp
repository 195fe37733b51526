#include "base/readable_number.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace prismesh {
namespace {

TEST(ReadableNumber, is_written_as_people_do) {
  struct Case {
    double value;
    int digits;
    const char* text;
  };
  for (const Case& each : {Case{0, 4, "0"}, Case{-0.0, 4, "0"}, Case{5, 4, "5"}, Case{1.5, 4, "1.5"}, Case{-1.25e-06, 4, "-0.00000125"},
                           Case{0.00005, 4, "0.00005"}, Case{12.34567, 4, "12.35"}, Case{9.99996, 5, "10"}, Case{9.99996, 6, "9.99996"},
                           Case{1234567.8, 6, "1234568"}, Case{1e11, 4, "100000000000"}, Case{1e12, 4, "1e+12"},
                           Case{1.25e-10, 4, "1.25e-10"}, Case{0.1 + 0.2, 6, "0.3"}, Case{100, 1, "100"}, Case{-1e-9, 3, "-0.000000001"}})
    EXPECT_EQ(readable(each.value, each.digits), each.text) << each.value;
  EXPECT_EQ(readable(std::numeric_limits<double>::infinity(), 4), "inf");
  EXPECT_EQ(readable(std::nan(""), 4), "nan");
}

TEST(ReadableNumber, of_any_double_gives_it_back_to_its_digits) {
  double value = 3.7e-12;
  for (int i = 0; i < 400; ++i, value *= -1.173)
    for (const int digits : {1, 3, 6, 15})
      EXPECT_NEAR(std::stod(readable(value, digits)) / value, 1, 5.000001 * std::pow(10, -digits)) << value << ' ' << digits;
}

TEST(ReadableNumber, of_a_place_what_is_nothing_beside_the_largest_is_nothing) {
  EXPECT_EQ(readable({1250.5, -1.25e-06, -3.2}, 6), "1250.5 0 -3.2");
  EXPECT_EQ(readable({-1250.5, -1.25e-06, 3.21456}, 6), "-1250.5 0 3.21") << "the largest may be negative";
  EXPECT_EQ(readable({0, 0, 0}, 6), "0 0 0");
  EXPECT_EQ(readable({1e-06, -2e-06, 0.25e-6}, 3), "0.000001 -0.000002 0.00000025");
  EXPECT_EQ(readable({999999.6, 0.4, -0.6}, 6), "1000000 0 -1");
  EXPECT_EQ(readable({1e15, 1, 0}, 4), "1e+15 1 0");
  EXPECT_EQ(readable({std::nan(""), 1.5, 0}, 4), "nan 1.5 0");
  EXPECT_EQ(readable({std::nan(""), 1250.5, -1.25e-06}, 6), "nan 1250.5 -0.00000125") << "each by itself where one is no number";
}

}  // namespace
}  // namespace prismesh
