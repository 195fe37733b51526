// Watching files whose folders appear and disappear between two system calls, and with more events than the kernel queues.
#include "drivers/port/file_watch.h"

#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <utility>

#include <gtest/gtest.h>

namespace {

/// Called once, just before this thread watches its next folder.
thread_local std::function<void()> before_next_watch;

}  // namespace

/// Replaces the C library's function.
extern "C" int inotify_add_watch(int descriptor, const char* path, std::uint32_t mask) noexcept {
  if (const auto act = std::exchange(before_next_watch, nullptr)) act();
  return static_cast<int>(::syscall(SYS_inotify_add_watch, descriptor, path, mask));
}

namespace prismesh::drivers::port {
namespace {

namespace fs = std::filesystem;
using ChangedPaths = std::vector<std::size_t>;

class FileWatchTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "prismesh-file-watch-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    device_ = folder_ / "a" / "b" / "device";
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  static void make(const fs::path& file) { std::ofstream(file) << "x"; }
  fs::path folder_, device_;
};

TEST_F(FileWatchTest, finds_folders_created_just_before_the_watch_above_starts) {
  before_next_watch = [this] { fs::create_directories(device_.parent_path()); };
  FileWatch watch({device_.string()});
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{});
  make(device_);
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{0});
}

TEST_F(FileWatchTest, finds_folders_created_later) {
  FileWatch watch({device_.string()});
  fs::create_directory(folder_ / "a");
  before_next_watch = [this] { fs::create_directory(device_.parent_path()); };
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{});
  make(device_);
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{0});
}

TEST_F(FileWatchTest, waits_for_a_folder_removed_just_before_its_watch_starts) {
  FileWatch watch({device_.string()});
  fs::create_directory(folder_ / "a");
  before_next_watch = [this] { fs::remove(folder_ / "a"); };
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{});
  for (int i = 0; i < 3; ++i) watch.changed_paths();
  fs::create_directories(device_.parent_path());
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{});
  make(device_);
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{0});
}

TEST_F(FileWatchTest, reports_a_device_whose_permissions_change) {
  fs::create_directories(device_.parent_path());
  make(device_);
  FileWatch watch({device_.string()});
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{});
  make(device_.parent_path() / "other");
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{}) << "a change of another file";
  ASSERT_EQ(::chmod(device_.c_str(), 0600), 0);
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{0});
}

TEST_F(FileWatchTest, checks_all_paths_after_the_kernels_queue_overflowed) {
  std::size_t queue_length = 0;
  std::ifstream("/proc/sys/fs/inotify/max_queued_events") >> queue_length;
  if (queue_length == 0 || queue_length > 100'000) GTEST_SKIP() << "this kernel remembers " << queue_length << " events";
  fs::create_directories(device_.parent_path());
  const fs::path one = device_.parent_path() / "one", other = device_.parent_path() / "other";
  for (const fs::path& file : {one, other, device_}) make(file);
  FileWatch watch({device_.string(), (folder_ / "absent").string()});
  // The kernel merges two consecutive events of the same kind.
  for (std::size_t i = 0; i <= queue_length; ++i) ::chmod((i % 2 == 0 ? one : other).c_str(), 0600);
  ::chmod(device_.c_str(), 0600);
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{0});
  EXPECT_EQ(watch.changed_paths(), ChangedPaths{}) << "reported once";
}

}  // namespace
}  // namespace prismesh::drivers::port
