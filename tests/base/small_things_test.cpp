// Errors, hashes, units and clocks.
#include <array>
#include <chrono>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/progress.h"
#include "base/toml_text.h"
#include "base/units.h"

namespace prismesh {
namespace {

TEST(TomlText, escapes_what_would_end_or_spoil_a_string) {
  EXPECT_EQ(toml_quoted("prism-mask"), "\"prism-mask\"");
  EXPECT_EQ(toml_quoted("a\"b\\c"), "\"a\\\"b\\\\c\"");
  EXPECT_EQ(toml_quoted("\n\x7f\xc3\xa4"), "\"\\u000A\\u007F\xc3\xa4\"");
}

TEST(Error, text_leaves_out_what_is_absent) {
  EXPECT_EQ((Error{"a.k", 12, "is wrong"}.text()), "a.k:12: is wrong");
  EXPECT_EQ((Error{"a.k", 0, "is wrong"}.text()), "a.k: is wrong");
  EXPECT_EQ((Error{"", 0, "is wrong"}.text()), "is wrong");
  EXPECT_EQ(cancelled().text(), "cancelled");
  const Result<int> failed = fail("expression", 7, "what is this");
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().text(), "expression:7: what is this");
}

TEST(Error, of_stopped_work_is_told_apart_by_its_kind_whatever_it_says) {
  EXPECT_TRUE(is_cancelled(cancelled()));
  Error named = cancelled();
  named.file = "a.k";
  named.message = "stopped";
  EXPECT_TRUE(is_cancelled(named));
  EXPECT_FALSE(is_cancelled(Error{"", 0, "cancelled"}));
}

TEST(Hash, is_the_same_in_pieces_and_tells_texts_apart) {
  const std::string text(100000, 'q');
  const std::string_view whole = text;
  const Hash128 hash = hash128(std::as_bytes(std::span(text)));
  const std::array<std::string_view, 4> pieces = {whole.substr(0, 1), whole.substr(1, 0), whole.substr(1, 70000), whole.substr(70001)};
  EXPECT_EQ(hash128(std::span<const std::string_view>(pieces)), hash);
  std::string other = text;
  other[5000] = 'p';
  EXPECT_FALSE(hash128(std::as_bytes(std::span(other))) == hash);
  EXPECT_NE(hash64(std::as_bytes(std::span(other))), hash64(std::as_bytes(std::span(text))));
  EXPECT_EQ(hash.hex().size(), 32u);
  // The published XXH3-128 of nothing.
  EXPECT_EQ(hash128(std::span<const std::byte>()).hex(), "99aa06d3014798d86001c324468d497f");
}

TEST(Units, have_names_and_sizes) {
  for (const LengthUnit unit : {LengthUnit::mm, LengthUnit::m, LengthUnit::in}) EXPECT_EQ(length_unit_from(name(unit)), unit);
  EXPECT_FALSE(length_unit_from("ft").has_value());
  EXPECT_FALSE(length_unit_from("").has_value());
  EXPECT_EQ(millimetres_per(LengthUnit::mm), 1.0);
  EXPECT_EQ(millimetres_per(LengthUnit::m), 1000.0);
  EXPECT_EQ(millimetres_per(LengthUnit::in), 25.4);
}

TEST(Clock, never_goes_back_and_stands_still_when_told) {
  MonotonicClock monotonic;
  // Both are CLOCK_MONOTONIC, which other processes read as well.
  const auto steady_ns = [] { return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count(); };
  std::int64_t last = steady_ns();
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t now = monotonic.now_ns();
    ASSERT_GE(now, last);
    last = now;
  }
  EXPECT_LE(last, steady_ns());
  ManualClock manual;
  EXPECT_EQ(manual.now_ns(), 0);
  manual.advance_ns(25);
  EXPECT_EQ(manual.now_ns(), 25);
}

}  // namespace
}  // namespace prismesh
