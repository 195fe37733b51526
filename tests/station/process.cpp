#include "tests/station/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace prismesh::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Between fork and exec: other threads of the test may hold the allocator's lock, so nothing is allocated here but for an
/// environment of the program's own.
[[noreturn]] void become(const std::vector<char*>& arguments, const std::map<std::string, std::string>& environment, int out, int error) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // A test that was started with nohup would hand on that a closing terminal is ignored.
  std::signal(SIGHUP, SIG_DFL);
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(error, STDERR_FILENO);
  for (const auto& [name, value] : environment) {
    if (value.empty())
      ::unsetenv(name.c_str());
    else
      ::setenv(name.c_str(), value.c_str(), 1);
  }
  ::execvp(arguments[0], arguments.data());
  ::_exit(127);
}

}  // namespace

Process::Process(std::vector<std::string> command, const std::map<std::string, std::string>& environment) {
  std::array<int, 2> out{}, error{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(error.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("no process");
  if (pid_ == 0) become(arguments, environment, out[1], error[1]);
  ::close(out[1]);
  ::close(error[1]);
  out_ = out[0];
  error_ = error[0];
  ::fcntl(out_, F_SETFL, O_NONBLOCK);
  ::fcntl(error_, F_SETFL, O_NONBLOCK);
}

Process::~Process() {
  if (running()) {
    kill(SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (out_ >= 0) ::close(out_);
  if (error_ >= 0) ::close(error_);
}

bool Process::read_some(std::chrono::milliseconds patience) {
  std::array<pollfd, 2> watched{{{out_, POLLIN, 0}, {error_, POLLIN, 0}}};
  if (::poll(watched.data(), watched.size(), static_cast<int>(patience.count())) <= 0) return false;
  bool any = false;
  std::array<char, 4096> buffer;
  for (const auto& [fd, events, seen] : watched) {
    if (fd < 0 || seen == 0) continue;
    const ssize_t count = ::read(fd, buffer.data(), buffer.size());
    any = any || count > 0;
    if (count > 0) {
      (fd == out_ ? partial_ : error_text_).append(buffer.data(), static_cast<std::size_t>(count));
    } else if (count == 0) {
      ::close(fd);
      (fd == out_ ? out_ : error_) = -1;
    }
  }
  for (std::size_t end; (end = partial_.find('\n')) != std::string::npos; partial_.erase(0, end + 1))
    lines_.push_back(partial_.substr(0, end));
  return any;
}

std::string Process::wait_until(const std::function<bool(const std::string&)>& wanted) {
  const Clock::time_point until = Clock::now() + kPatience;
  for (;;) {
    while (next_ < lines_.size())
      if (const std::string& line = lines_[next_++]; wanted(line)) return line;
    if (Clock::now() > until) return {};
    if (out_ < 0) return {};
    read_some(std::chrono::milliseconds(200));
  }
}

std::string Process::wait_for(std::string_view beginning) {
  return wait_until([&](const std::string& line) { return line.starts_with(beginning); });
}

std::string Process::last(std::string_view beginning) {
  while (read_some(std::chrono::milliseconds(0))) {
  }
  const auto found = std::find_if(lines_.rbegin(), lines_.rend(), [&](const std::string& line) { return line.starts_with(beginning); });
  return found == lines_.rend() ? std::string() : *found;
}

void Process::skip_lines() {
  last("");
  next_ = lines_.size();
}

bool Process::running() {
  if (ended_) return false;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return true;
  ended_ = true;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return false;
}

int Process::wait_for_exit() {
  const Clock::time_point until = Clock::now() + kPatience;
  while (running() && Clock::now() < until) {
    if (out_ >= 0 || error_ >= 0)
      read_some(std::chrono::milliseconds(50));
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return status_;
}

void Process::kill(int signal) {
  if (!ended_) ::kill(pid_, signal);
}

const std::string& Process::standard_error() {
  read_some(std::chrono::milliseconds(0));
  return error_text_;
}

std::string Process::all_output() const {
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  return text + error_text_;
}

bool program_exists(const std::string& name) {
  std::stringstream path(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');)
    if (::access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace prismesh::test
