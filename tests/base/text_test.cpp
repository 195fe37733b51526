// Bytes as text, and names that were mistyped.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "base/base64.h"
#include "base/letter_case.h"
#include "base/nearest_name.h"

namespace prismesh {
namespace {

using namespace std::string_view_literals;

std::string encoded(std::string_view text) { return base64_encode(std::as_bytes(std::span(text))); }
std::optional<std::string> decoded(std::string_view text) {
  const std::optional<std::vector<std::byte>> bytes = base64_decode(text);
  if (!bytes) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

TEST(Base64, is_that_of_the_standard) {
  // RFC 4648, section 10, and the alphabet's last two.
  constexpr std::pair<std::string_view, std::string_view> kVectors[] = {{"", ""},
                                                                        {"f", "Zg=="},
                                                                        {"fo", "Zm8="},
                                                                        {"foo", "Zm9v"},
                                                                        {"foob", "Zm9vYg=="},
                                                                        {"fooba", "Zm9vYmE="},
                                                                        {"foobar", "Zm9vYmFy"},
                                                                        {"\xfb\xff\xbf"sv, "+/+/"},
                                                                        {"\0\0\0\0"sv, "AAAAAA=="}};
  for (const auto& [bytes, text] : kVectors) {
    EXPECT_EQ(encoded(bytes), text);
    EXPECT_EQ(decoded(text), bytes) << text;
  }
  std::string all;
  for (int i = 0; i < 256; ++i) {
    EXPECT_EQ(decoded(encoded(all)), all) << i;
    all.push_back(static_cast<char>(i * 37));
  }
}

TEST(Base64, takes_nothing_that_it_would_not_have_written) {
  for (const std::string_view text :
       {"Z"sv, "Zg"sv, "Zg="sv, "Zm9vY"sv, "Zg==Zg=="sv, "Z==="sv, "===="sv, "=Zg="sv, "Z=g="sv, "Zh=="sv, "Zm9="sv, "Zm 9"sv, "Zm9\n"sv,
        "Zm9-"sv, "Zm9_"sv, "Zm9\0"sv, "Zm9\xff"sv, "Zm9vZm9v\n"sv, "Zg==\n\n\n\n"sv})
    EXPECT_FALSE(base64_decode(text)) << text;
  for (const std::size_t length : {1U, 2U, 3U, 5U, 6U, 7U})
    EXPECT_FALSE(base64_decode("Zm9vZm9v"sv.substr(0, length))) << "what lies behind a text is none of it";
}

TEST(NearestName, counts_missing_surplus_wrong_and_exchanged_letters) {
  struct Case {
    std::string_view a, b;
    std::size_t distance;
  };
  for (const Case& each :
       {Case{"", "", 0}, Case{"abc", "", 3}, Case{"", "ab", 2}, Case{"port", "port", 0}, Case{"PORT", "port", 0}, Case{"pot", "port", 1},
        Case{"portt", "port", 1}, Case{"pert", "port", 1}, Case{"prot", "port", 1}, Case{"pROt", "PoRT", 1}, Case{"buad", "baud", 1},
        Case{"ba", "ab", 1}, Case{"ca", "abc", 3}, Case{"kitten", "sitting", 3}, Case{"z", "a", 1}, Case{"[", "{", 1}}) {
    EXPECT_EQ(edit_distance(each.a, each.b), each.distance) << each.a << ' ' << each.b;
    EXPECT_EQ(edit_distance(each.b, each.a), each.distance) << each.b << ' ' << each.a;
  }
  const std::string same(64, 'x');
  EXPECT_EQ(edit_distance(same + "abc", same), 0U) << "64 letters are compared";
  EXPECT_EQ(edit_distance(same.substr(1) + "ab", same), 1U);
}

TEST(NearestName, is_the_first_of_equals) {
  const std::vector<std::string_view> known{"still", "sway", "lean", "turn", "tour"};
  EXPECT_EQ(nearest_name("torn", known), "turn");
  EXPECT_EQ(nearest_name("tuor", known), "tour");
  EXPECT_EQ(nearest_name("SWAY", known), "sway");
  EXPECT_EQ(nearest_name("", known), "sway");
  EXPECT_EQ(nearest_name("still", {}), "");
}

TEST(LetterCase, is_that_of_a_to_z_alone) {
  EXPECT_EQ(upper("azAZ09_@[`{\xe4"sv), "AZAZ09_@[`{\xe4");
  EXPECT_EQ(lower("azAZ09_@[`{\xc4"sv), "azaz09_@[`{\xc4");
}

}  // namespace
}  // namespace prismesh
