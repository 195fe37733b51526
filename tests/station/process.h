// Programs started by a test: their output as lines to wait for, their end, their death.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::test {

/// Max time to wait for an event: a loaded machine may be slow.
inline constexpr std::chrono::seconds kPatience{90};

/// A program that ends with the thread that started it, however the test ends.
class Process {
 public:
  /// `environment` is added to the test's own; an empty value removes a variable. Dies with the test.
  Process(std::vector<std::string> command, const std::map<std::string, std::string>& environment);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  /// The first line of standard output after the last one waited for that begins with `beginning`; empty if the program
  /// ended or the wait timed out first.
  std::string wait_for(std::string_view beginning);
  /// As above, for a line that `wanted` accepts.
  std::string wait_until(const std::function<bool(const std::string&)>& wanted);
  /// The last line so far that begins so; reads what has come, doesn't wait.
  std::string last(std::string_view beginning);
  /// Passes over all lines so far.
  void skip_lines();

  /// Waits for the end: the exit status, or 128 + the signal; -1 if the wait timed out.
  int wait_for_exit();
  void kill(int signal);
  bool running();
  const std::string& standard_error();
  pid_t pid() const { return pid_; }
  std::string all_output() const;

 private:
  bool read_some(std::chrono::milliseconds patience);  ///< whether anything came

  pid_t pid_ = -1;
  int status_ = -1;
  bool ended_ = false;
  int out_ = -1;
  int error_ = -1;
  std::string partial_;
  std::string error_text_;
  std::vector<std::string> lines_;
  std::size_t next_ = 0;
};

/// Whether a program can be found in PATH.
bool program_exists(const std::string& name);

}  // namespace prismesh::test
