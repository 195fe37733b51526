// Pictures from the command line: drawn by the kiosk beside the program, whole or not at all.
#include <cstdint>

#include <unistd.h>

#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

class Render : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    const auto kiosk = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "prismesh-kiosk";
    if (access(kiosk.c_str(), X_OK) != 0) GTEST_SKIP() << "RENDER IS NOT TESTED: " << kiosk << " isn't built";
    deck_ = write("plate.k", "*KEYWORD\n*NODE\n" + node_card(1, 0, 0, 0) + node_card(2, 10, 0, 0) + node_card(3, 10, 10, 0) +
                                 node_card(4, 0, 10, 0) + "*ELEMENT_SHELL\n" + shell_card(1, 1, 1, 2, 3, 4) + "*END\n");
    if (draw({}).status != kDone) GTEST_SKIP() << "RENDER IS NOT TESTED: no picture can be drawn here: " << said_;
    std::filesystem::remove(path("a.png"));
  }
  /// `render` with these options; what the kiosk says on standard error is in `said_`.
  Outcome draw(const std::vector<std::string>& options) {
    std::vector<std::string> args{"render", deck_, "-o", path("a.png")};
    if (std::find(options.begin(), options.end(), "--size") == options.end()) args.insert(args.end(), {"--size", "64x48"});
    args.insert(args.end(), options.begin(), options.end());
    ::testing::internal::CaptureStderr();
    const Outcome outcome = prismesh(args);
    said_ = ::testing::internal::GetCapturedStderr() + outcome.err;
    return outcome;
  }
  std::string deck_, said_;
};

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

TEST_F(Render, writes_a_png_of_the_size_asked_for) {
  ASSERT_EQ(draw({"--view", "top", "--eye", "-30,10,600", "--colour", "quality", "--profile", "mono-left"}).status, kDone) << said_;
  const std::string png = read(path("a.png"));
  ASSERT_GT(png.size(), 100U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(big_endian(png, 16), 64U);
  EXPECT_EQ(big_endian(png, 20), 48U);
  ASSERT_EQ(draw({"--view", "top", "--eye", "-30,10,600", "--colour", "quality", "--profile", "mono-left"}).status, kDone);
  EXPECT_EQ(read(path("a.png")), png) << "the same picture every time";
  ASSERT_EQ(draw({"--view", "top", "--eye", "-30,10,600", "--colour", "quality", "--profile", "mono-left", "--select", "1,3"}).status,
            kDone);
  EXPECT_NE(read(path("a.png")), png) << "selected nodes show";
}

TEST_F(Render, draws_shells_with_their_thickness_and_says_which_have_none) {
  ASSERT_EQ(draw({"--view", "front", "--profile", "mono"}).status, kDone) << said_;
  const std::string surfaces = read(path("a.png"));
  ASSERT_EQ(draw({"--view", "front", "--profile", "mono", "--thickness"}).status, kDone) << said_;
  EXPECT_EQ(read(path("a.png")), surfaces);
  EXPECT_THAT(said_, HasSubstr("1 part with shells without thickness is drawn as surfaces"));
  deck_ = write("thick.k", "*KEYWORD\n*PART\nplate\n         1         1\n*SECTION_SHELL\n         1         2\n       2.0\n*NODE\n" +
                               node_card(1, 0, 0, 0) + node_card(2, 10, 0, 0) + node_card(3, 10, 10, 0) + node_card(4, 0, 10, 0) +
                               "*ELEMENT_SHELL\n" + shell_card(1, 1, 1, 2, 3, 4) + "*END\n");
  ASSERT_EQ(draw({"--view", "front", "--profile", "mono"}).status, kDone) << said_;
  const std::string thin = read(path("a.png"));
  ASSERT_EQ(draw({"--view", "front", "--profile", "mono", "--thickness"}).status, kDone) << said_;
  EXPECT_NE(read(path("a.png")), thin);
  EXPECT_THAT(said_, Not(HasSubstr("without thickness")));
}

TEST_F(Render, wrong_usage_lists_what_there_is) {
  const std::pair<std::vector<std::string>, const char*> wrong[] = {{{"--view", "sideways"}, "front, back, left, right, top, bottom, iso"},
                                                                    {{"--profile", "tv"}, "prism-mask, prism-mask-columns"},
                                                                    {{"--colour", "red"}, "parts, quality"},
                                                                    {{"--eye", "1,2"}, "X,Y,Z"},
                                                                    {{"--eye", "0,0,-5"}, "X,Y,Z"},
                                                                    {{"--mask", "left"}, "--mask left: write where the mask stands"},
                                                                    {{"--size", "12"}, "1920x1080"}};
  for (const auto& [options, words] : wrong) {
    EXPECT_EQ(draw(options).status, kWrongUsage) << options[1];
    EXPECT_THAT(said_, HasSubstr(words));
    EXPECT_FALSE(exists("a.png"));
  }
}

TEST_F(Render, a_field_that_cannot_be_shown_says_what_is_missing) {
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"--colour", "displacement"}, "--colour displacement: say with --against which deck to compare with"},
      {{"--colour", "distance", "--from", "1"}, "--colour distance: say with --from which nodes are coloured, and with --to"},
      {{"--colour", "metric:warpige"}, "the nearest is \"metric:warpage\""},
      {{"--colour", "metric:warpage", "--against", deck_}, "--colour metric:warpage: is compared with nothing"},
      {{"--colour", "displacement", "--against", deck_, "--to", "1"}, "--from and --to are for --colour distance"},
      {{"--limits", "1,5"}, "--limits: is for the colours of a field"},
      {{"--colour", "quality", "--against", deck_}, "--against: is for the colours of a field"}};
  for (const auto& [options, words] : wrong) {
    EXPECT_EQ(draw(options).status, kWrongUsage) << options[1];
    EXPECT_THAT(said_, HasSubstr(words));
    EXPECT_FALSE(exists("a.png"));
  }
  EXPECT_EQ(draw({"--colour", "displacement", "--against", "none.k"}).status, kFailed);
  EXPECT_THAT(said_, HasSubstr("none.k: can't be opened"));
  EXPECT_FALSE(exists("a.png"));
}

TEST_F(Render, nothing_is_written_on_failure) {
  EXPECT_EQ(draw({"--select", "1,99"}).status, kFailed);
  EXPECT_THAT(said_, StartsWith("expression:3: "));
  EXPECT_FALSE(exists("a.png"));
  write("wide.toml", "weave = \"columns\"\npitch = 3\n");
  EXPECT_EQ(draw({"--profile", path("wide.toml")}).status, kFailed);
  EXPECT_THAT(said_, HasSubstr("wide.toml:2: "));
  EXPECT_FALSE(exists("a.png"));
  EXPECT_EQ(prismesh({"render", path("none.k"), "-o", path("a.png")}).status, kFailed);
  ::testing::internal::CaptureStderr();
  const int status = prismesh({"render", deck_, "-o", path("no/folder/here.txt/a.png")}).status;
  ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(status, kDone) << "missing folders are made, as for decks";
}

}  // namespace
}  // namespace prismesh::cli
