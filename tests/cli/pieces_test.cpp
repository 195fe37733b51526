// The small parts: readable text, progress bar.
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

TEST(Text, printable) {
  EXPECT_EQ(printable("plain Tür 面 😀"), "plain Tür 面 😀");
  EXPECT_EQ(printable("T\xfcr"), "T\\xFCr");
  EXPECT_EQ(printable(std::string_view("a\0b\x1b[0m", 7)), "a\\x00b\\x1B[0m");
  EXPECT_EQ(printable("\xc3"), "\\xC3");                    // cut off
  EXPECT_EQ(printable("\xc0\xaf"), "\\xC0\\xAF");           // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xED\\xA0\\x80");  // half a surrogate
  EXPECT_EQ(printable("\xf5\x80\x80\x80"), "\\xF5\\x80\\x80\\x80");
}

TEST(Text, numbers_in_the_fewest_digits) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(5), "5");
  EXPECT_EQ(as_written(8.07f), 8.07);
  EXPECT_EQ(as_written(-1e9f), -1e9);
}

TEST(ProgressBar, draws_on_a_terminal_after_a_while_and_goes_away) {
  std::ostringstream out, err;
  const Context context{out, err, true};
  ManualClock clock;
  {
    ProgressBar bar(context, "reading a.k", clock);
    const Progress progress = bar.progress();
    EXPECT_TRUE(progress(0.1));
    EXPECT_EQ(err.str(), "");
    clock.advance_ns(400'000'000);
    EXPECT_TRUE(progress(0.5));
    EXPECT_THAT(err.str(), HasSubstr("reading a.k [###############...............] 50 %"));
    const std::size_t drawn = err.str().size();
    progress(0.6);  // too soon
    EXPECT_EQ(err.str().size(), drawn);
  }
  EXPECT_THAT(err.str(), ::testing::EndsWith("\r\x1b[K"));
  EXPECT_EQ(out.str(), "");
}

TEST(ProgressBar, is_silent_in_a_pipe_and_stops_work_when_asked) {
  std::ostringstream out, err;
  std::atomic<bool> interrupted{false};
  const Context context{out, err, false, &interrupted};
  ManualClock clock;
  ProgressBar bar(context, "reading", clock);
  const Progress progress = bar.progress();
  clock.advance_ns(5'000'000'000);
  EXPECT_TRUE(progress(0.5));
  interrupted = true;
  EXPECT_FALSE(progress(0.6));
  EXPECT_EQ(err.str(), "");
}

}  // namespace
}  // namespace prismesh::cli
