// What a process can't do any more once it is locked in: each is tried in a process of its own.
#include "daemon/import/sandbox.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/wire/descriptor.h"

namespace prismesh::importer {
namespace {

namespace fs = std::filesystem;

constexpr SandboxLimits kSandboxLimits{std::uint64_t{2} << 30, 20};

class Sandbox : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("prismesh-sandbox-" + std::to_string(std::random_device{}()));
    fs::create_directories(folder / "upload");
    std::ofstream(folder / "outside.k") << "outside";
    std::ofstream(folder / "upload" / "deck.k") << "inside";
    fs::create_symlink("../outside.k", folder / "upload" / "link.k");
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  }
  void TearDown() override {
    ::close(ends[0]);
    ::close(ends[1]);
    fs::remove_all(folder);
  }

  /// What `attempt` returns in a process that is locked in: 0, or an errno. 255: it couldn't be locked in; 256 and a signal: it was ended.
  int locked_in(const std::function<int()>& attempt, const SandboxLimits& limits = kSandboxLimits) {
    const pid_t child = ::fork();
    if (child == 0) {
      upload = ::open((folder / "upload").c_str(), O_PATH | O_DIRECTORY);
      memory = ::memfd_create("deck", MFD_ALLOW_SEALING);
      if (::ftruncate(memory, 1 << 20) != 0) ::_exit(255);
      const auto unguarded = lock_in({upload, ends[1], memory}, limits);
      ::_exit(unguarded && unguarded->empty() ? attempt() : 255);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 256 + WTERMSIG(status);
  }

  /// The errno of a call that returned this; 0: it succeeded.
  static int code(long result) { return result < 0 ? errno : 0; }
  static long open_at(int at, const char* path, std::uint64_t flags, std::uint64_t resolve = 0) {
    open_how how{};
    how.flags = flags;
    how.resolve = resolve;
    return ::syscall(SYS_openat2, at, path, &how, sizeof how);
  }

  fs::path folder;
  int ends[2] = {-1, -1};
  int upload = -1;
  int memory = -1;
};

TEST_F(Sandbox, lets_files_of_the_folder_be_read) {
  EXPECT_EQ(locked_in([&] {
              char text[6] = {};
              const long file = open_at(upload, "deck.k", O_RDONLY);
              return file >= 0 && ::read(static_cast<int>(file), text, 6) == 6 && std::memcmp(text, "inside", 6) == 0 ? 0 : 1;
            }),
            0);
}

TEST_F(Sandbox, opens_nothing_elsewhere_whatever_the_call) {
  const std::string outside = (folder / "outside.k").string();
  EXPECT_EQ(locked_in([&] { return code(::open("/etc/passwd", O_RDONLY)); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::syscall(SYS_openat, upload, "deck.k", O_RDONLY)); }), EPERM);
  // Even one that doesn't ask for a path beneath the folder.
  EXPECT_EQ(locked_in([&] { return code(open_at(AT_FDCWD, "/etc/passwd", O_RDONLY)); }), EACCES);
  EXPECT_EQ(locked_in([&] { return code(open_at(AT_FDCWD, outside.c_str(), O_RDONLY)); }), EACCES);
  EXPECT_EQ(locked_in([&] { return code(open_at(upload, "../outside.k", O_RDONLY)); }), EACCES);
  EXPECT_EQ(locked_in([&] { return code(open_at(upload, "link.k", O_RDONLY)); }), EACCES);
  EXPECT_EQ(locked_in([&] { return code(open_at(AT_FDCWD, "/proc/self/environ", O_RDONLY)); }), EACCES);
  EXPECT_EQ(locked_in([&] { return code(open_at(upload, ".", O_RDONLY | O_DIRECTORY)); }), EACCES) << "folders aren't listed";
}

TEST_F(Sandbox, writes_no_file) {
  for (const std::uint64_t flags : {O_WRONLY, O_RDWR, O_WRONLY | O_TRUNC, O_RDONLY | O_TRUNC})
    EXPECT_EQ(locked_in([&] { return code(open_at(upload, "deck.k", flags)); }), EACCES) << flags;
  EXPECT_EQ(locked_in([&] {
              open_how how{};
              how.flags = O_WRONLY | O_CREAT;
              how.mode = 0600;
              return code(::syscall(SYS_openat2, upload, "new.k", &how, sizeof how));
            }),
            EACCES);
  EXPECT_EQ(locked_in([&] { return code(::unlinkat(upload, "deck.k", 0)); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::renameat(upload, "deck.k", upload, "other.k")); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::fchmodat(upload, "deck.k", 0777, 0)); }), EPERM);
  // By the filter; where sanitizers need the call, by the limit of written bytes.
  EXPECT_THAT(locked_in([&] { return code(::write(memory, "x", 1)); }), testing::AnyOf(EPERM, EFBIG));
  EXPECT_EQ(locked_in([&] { return code(::ftruncate(memory, 2 << 20)); }), EFBIG) << "memory can't grow";
  std::ifstream in(folder / "upload" / "deck.k");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "inside");
  EXPECT_FALSE(fs::exists(folder / "upload" / "new.k"));
}

TEST_F(Sandbox, reaches_no_network_and_no_process) {
  EXPECT_EQ(locked_in([&] { return code(::socket(AF_INET, SOCK_STREAM, 0)); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::socket(AF_UNIX, SOCK_STREAM, 0)); }), EPERM);
  EXPECT_EQ(locked_in([&] {
              int pair[2];
              return code(::socketpair(AF_UNIX, SOCK_STREAM, 0, pair));
            }),
            EPERM);
  EXPECT_EQ(locked_in([&] { return code(::kill(::getppid(), 0)); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::syscall(SYS_tgkill, 1, 1, 0)); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr)); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::fork()); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::vfork()); }), EPERM);
  EXPECT_EQ(locked_in([&] {
              char* const none[] = {nullptr};
              return code(::execve("/bin/true", none, none));
            }),
            EPERM);
  EXPECT_EQ(locked_in([&] { return code(::syscall(SYS_bpf, 0, nullptr, 0)); }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::syscall(SYS_io_uring_setup, 1, nullptr)); }), EPERM);
}

TEST_F(Sandbox, makes_no_memory_executable) {
  const auto map = [](int protection) { return ::mmap(nullptr, 4096, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0); };
  EXPECT_EQ(locked_in([&] { return map(PROT_READ | PROT_WRITE | PROT_EXEC) == MAP_FAILED ? errno : 0; }), EPERM);
  EXPECT_EQ(locked_in([&] { return code(::mprotect(map(PROT_READ | PROT_WRITE), 4096, PROT_READ | PROT_EXEC)); }), EPERM);
}

TEST_F(Sandbox, maps_no_file_but_the_memory) {
  const auto map = [](int file) { return ::mmap(nullptr, 1, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0); };
  EXPECT_EQ(locked_in([&] { return map(memory) == MAP_FAILED ? errno : 0; }), 0);
  EXPECT_EQ(locked_in([&] { return map(static_cast<int>(open_at(upload, "deck.k", O_RDONLY))) == MAP_FAILED ? errno : 0; }), EPERM);
}

TEST_F(Sandbox, keeps_no_other_descriptor) {
  const int secret = ::open((folder / "outside.k").c_str(), O_RDONLY);
  EXPECT_EQ(locked_in([&] {
              char byte = 0;
              return code(::read(secret, &byte, 1));
            }),
            EBADF);
  ::close(secret);
}

TEST_F(Sandbox, lets_threads_work_and_the_answer_be_sent) {
  EXPECT_EQ(locked_in([&] {
              int sum = 0;
              std::thread([&] { sum = 7; }).join();
              msghdr message{};
              char text[] = "answer";
              iovec part{text, sizeof text};
              message.msg_iov = &part;
              message.msg_iovlen = 1;
              const bool sent = ::sendmsg(ends[1], &message, 0) == sizeof text;
              const bool sealed = ::ftruncate(memory, 4096) == 0 && ::fcntl(memory, F_ADD_SEALS, F_SEAL_WRITE) == 0;
              return sum == 7 && sent && sealed ? 0 : 1;
            }),
            0);
}

TEST_F(Sandbox, ends_who_takes_too_much_processor_time) {
  EXPECT_EQ(locked_in(
                [] {
                  for (volatile bool ever = true; ever;) {
                  }
                  return 0;
                },
                {std::uint64_t{2} << 30, 1}),
            256 + SIGXCPU);
}

#if !defined(PRISMESH_ADDRESS_SANITIZER)
TEST_F(Sandbox, gives_no_more_memory_than_the_limit) {
  EXPECT_EQ(locked_in([] {
              return ::mmap(nullptr, std::size_t{3} << 30, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0) ==
                             MAP_FAILED
                         ? errno
                         : 0;
            }),
            ENOMEM);
}
#endif

}  // namespace
}  // namespace prismesh::importer
