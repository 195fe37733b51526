#include "base/child_process.h"

#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sched.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"

namespace prismesh {

namespace {

/// Restricts this thread, and so the programs that it starts, to some processors, for as long as it lives.
class OnCores {
 public:
  explicit OnCores(const std::vector<std::size_t>& cores) : is_set_(!cores.empty()) {
    if (!is_set_) return;
    is_set_ = sched_getaffinity(0, sizeof before_, &before_) == 0;
    cpu_set_t wanted;
    CPU_ZERO(&wanted);
    for (const std::size_t core : cores) CPU_SET(core, &wanted);
    is_set_ = is_set_ && sched_setaffinity(0, sizeof wanted, &wanted) == 0;
  }
  ~OnCores() {
    if (is_set_) sched_setaffinity(0, sizeof before_, &before_);
  }
  OnCores(const OnCores&) = delete;
  OnCores& operator=(const OnCores&) = delete;

 private:
  bool is_set_;
  cpu_set_t before_{};
};

}  // namespace

Result<std::filesystem::path> own_program() {
  std::error_code error;
  std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return fail("/proc/self/exe", "can't be read: " + error.message());
  return own;
}

Result<std::filesystem::path> program_beside(const std::string& name, const std::string& what, const std::string& package) {
  const Result<std::filesystem::path> own = own_program();
  std::filesystem::path program = own ? own->parent_path() / name : std::filesystem::path(name);
  if (!own || ::access(program.c_str(), X_OK) != 0)
    return fail(program.string(), name + ", " + what + ", isn't beside this program; the package " + package + " has it");
  return program;
}

std::vector<std::size_t> own_cores() {
  std::vector<std::size_t> cores;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0)
    for (std::size_t core = 0; core < CPU_SETSIZE; ++core)
      if (CPU_ISSET(core, &set)) cores.push_back(core);
  if (cores.empty()) cores.push_back(0);
  return cores;
}

Result<pid_t> start_program(const std::vector<std::string>& arguments, const std::filesystem::path& out, const std::filesystem::path& err,
                            const std::vector<std::size_t>& cores) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kNew = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), kNew, 0644);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), kNew, 0644);
  pid_t child = 0;
  int error = 0;
  {
    const OnCores on(cores);
    error = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  }
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return fail(arguments.front(), std::string("can't be started: ") + std::strerror(error));
  return child;
}

std::optional<std::string> failure_words(int status) {
  if (WIFSIGNALED(status)) return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0) return "ended with status " + std::to_string(WEXITSTATUS(status));
  return std::nullopt;
}

std::string last_line(const std::filesystem::path& file) {
  const Result<FileBytes> bytes = read_file(file);
  if (!bytes) return "";
  std::string_view text = bytes->text();
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  return std::string(text.substr(text.rfind('\n') + 1));
}

}  // namespace prismesh
