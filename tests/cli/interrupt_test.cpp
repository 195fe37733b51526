// Ctrl-C on a terminal, in the middle of long work: the program in a pseudo-terminal, interrupted when its bar is seen.
#include <chrono>
#include <csignal>

#include <poll.h>
#include <pty.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Max time to wait for output: a loaded machine may be slow.
constexpr std::chrono::seconds kPatience{90};

/// A program with a terminal of its own; ends with the test.
class OnTerminal {
 public:
  explicit OnTerminal(std::vector<std::string> command) {
    std::vector<char*> arguments;
    for (std::string& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ != 0) {
      keep_output();
      return;
    }
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;
  ~OnTerminal() {
    if (pid_ > 0 && !ended_) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(terminal_);
  }

  /// Reads what the program shows until it has shown `text`; false if it ended or the wait timed out before.
  bool shows(const std::string& text) {
    while (shown_.find(text) == std::string::npos)
      if (!read_some()) return false;
    return true;
  }
  void press(char key) { EXPECT_EQ(::write(terminal_, &key, 1), 1); }
  /// Reads to the end; the exit status, or 128 + the signal.
  int wait_for_exit() {
    while (read_some()) {
    }
    int status = 0;
    ::waitpid(pid_, &status, 0);
    ended_ = true;
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }
  const std::string& shown() const { return shown_; }

 private:
  /// Ctrl-C makes a terminal drop what it hasn't handed on yet, after it has sent the signal: the last words of a quick program with it.
  void keep_output() const {
    termios settings{};
    ASSERT_EQ(::tcgetattr(terminal_, &settings), 0);
    settings.c_lflag |= NOFLSH;
    ASSERT_EQ(::tcsetattr(terminal_, TCSANOW, &settings), 0);
  }
  bool read_some() {
    pollfd watched{terminal_, POLLIN, 0};
    if (::poll(&watched, 1, std::chrono::milliseconds(kPatience).count()) <= 0) return false;
    char buffer[4096];
    const ssize_t count = ::read(terminal_, buffer, sizeof buffer);  // an error when the program has closed its side
    if (count > 0) shown_.append(buffer, static_cast<std::size_t>(count));
    return count > 0;
  }

  pid_t pid_ = -1;
  int terminal_ = -1;
  bool ended_ = false;
  std::string shown_;
};

/// What stands in the terminal's last lines once carriage returns and erased ends of lines are done.
std::vector<std::string> screen_after(const std::string& shown) {
  std::vector<std::string> lines(1);
  std::size_t column = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (shown[i] == '\n') {
      lines.emplace_back();
      column = 0;
    } else if (shown[i] == '\r') {
      column = 0;
    } else if (shown.compare(i, 3, "\x1b[K") == 0) {
      lines.back().resize(std::min(lines.back().size(), column));
      i += 2;
    } else {
      lines.back().resize(std::max(lines.back().size(), column + 1), ' ');
      lines.back()[column++] = shown[i];
    }
  }
  return lines;
}

class Interrupt : public Cli {
 protected:
  static std::string program() { return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "prismesh").string(); }
  /// A sheet that takes long to repair: here and there a node is pulled out of it.
  std::string rough_sheet(int side) {
    std::string text = "*KEYWORD\n*NODE\n";
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const bool pulled = i % 5 == 2 && j % 5 == 2;
        text += node_card(1 + j * side + i, 5 * i + (pulled ? 2.5 : 0), 5 * j + (pulled ? 1.5 : 0), pulled ? 4 : 0);
      }
    text += "*ELEMENT_SHELL\n";
    for (int j = 0; j + 1 < side; ++j)
      for (int i = 0; i + 1 < side; ++i) {
        const int a = 1 + j * side + i;
        text += shell_card(1 + j * (side - 1) + i, 7, a, a + 1, a + side + 1, a + side);
      }
    return write("rough.k", text + "*PART\nsheet\n         7         3         2\n*END\n");
  }
};

TEST_F(Interrupt, ctrl_c_in_the_middle_of_a_repair_leaves_nothing) {
  const std::string deck = rough_sheet(60);
  const std::string text = read(deck);
  const auto before = names();
  OnTerminal edit(
      {program(), "edit", deck, "--edit", R"({"edit":"repair","scope":"all"})", "-o", path("out.k"), "--journal", path("edits.journal")});
  ASSERT_TRUE(edit.shows("repair [")) << "no bar was drawn before the repair was over:\n" << edit.shown();
  edit.press('\x03');
  EXPECT_EQ(edit.wait_for_exit(), kFailed);
  EXPECT_EQ(names(), before);
  EXPECT_EQ(read(deck), text);
  // The bar is gone from the screen, and what stands there last is the reason.
  const std::vector<std::string> screen = screen_after(edit.shown());
  ASSERT_GE(screen.size(), 2u);
  EXPECT_EQ(screen.back(), "");
  EXPECT_EQ(screen[screen.size() - 2], "--edit:1: cancelled");
  for (const std::string& line : screen) EXPECT_EQ(line.find("repair ["), std::string::npos) << line;
}

TEST_F(Interrupt, ctrl_c_in_the_middle_of_a_repair_that_is_kept_writes_what_it_reached) {
  const std::string deck = rough_sheet(60);
  OnTerminal edit({program(), "edit", deck, "--edit", R"({"edit":"repair","scope":"all"})", "-o", path("out.k"), "--keep-on-cancel"});
  ASSERT_TRUE(edit.shows("  round 1, ")) << "no words were shown before the repair was over:\n" << edit.shown();
  edit.press('\x03');
  EXPECT_EQ(edit.wait_for_exit(), kFailed);
  ASSERT_TRUE(exists("out.k"));
  EXPECT_EQ(prismesh({"check", path("out.k")}).status, kDone);
  const std::vector<std::string> screen = screen_after(edit.shown());
  EXPECT_THAT(screen, ::testing::Contains(::testing::HasSubstr("stopped in the middle of this edit; what was reached is written")));
  for (const std::string& line : screen) {
    EXPECT_EQ(line.find("repair ["), std::string::npos) << line;
    EXPECT_EQ(line.find("saving"), std::string::npos) << line;
  }
}

TEST_F(Interrupt, ctrl_c_in_the_middle_of_measuring_removes_the_temporary_folder) {
  std::filesystem::create_directories(folder / "tmp");
  OnTerminal bench({"/usr/bin/env", "TMPDIR=" + path("tmp"), program(), "bench", "--elements", "20000"});
  ASSERT_TRUE(bench.shows("measuring [")) << bench.shown();
  EXPECT_FALSE(std::filesystem::is_empty(folder / "tmp")) << "the sample stands there";
  bench.press('\x03');
  EXPECT_EQ(bench.wait_for_exit(), kFailed);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "tmp"));
  const std::vector<std::string> screen = screen_after(bench.shown());
  ASSERT_GE(screen.size(), 2u);
  EXPECT_EQ(screen[screen.size() - 2], "prismesh bench: cancelled");
}

}  // namespace
}  // namespace prismesh::cli
