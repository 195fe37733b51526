// Watching for files where folders come and go between two system calls, or more happens than the kernel remembers.
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

/// Done once, just before this thread's next folder is watched.
thread_local std::function<void()> just_before_watching;

}  // namespace

/// In place of the C library's.
extern "C" int inotify_add_watch(int descriptor, const char* path, std::uint32_t mask) noexcept {
  if (const auto act = std::exchange(just_before_watching, nullptr)) act();
  return static_cast<int>(::syscall(SYS_inotify_add_watch, descriptor, path, mask));
}

namespace prismesh::drivers::port {
namespace {

namespace fs = std::filesystem;
using FoundPaths = std::vector<std::size_t>;

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

TEST_F(FileWatchTest, folders_that_come_while_the_one_above_is_about_to_be_watched_are_found) {
  just_before_watching = [this] { fs::create_directories(device_.parent_path()); };
  FileWatch watch({device_.string()});
  EXPECT_EQ(watch.news(), FoundPaths{});
  make(device_);
  EXPECT_EQ(watch.news(), FoundPaths{0});
}

TEST_F(FileWatchTest, and_so_are_those_that_come_later) {
  FileWatch watch({device_.string()});
  fs::create_directory(folder_ / "a");
  just_before_watching = [this] { fs::create_directory(device_.parent_path()); };
  EXPECT_EQ(watch.news(), FoundPaths{});
  make(device_);
  EXPECT_EQ(watch.news(), FoundPaths{0});
}

TEST_F(FileWatchTest, a_folder_that_goes_while_it_is_about_to_be_watched_is_awaited_again) {
  FileWatch watch({device_.string()});
  fs::create_directory(folder_ / "a");
  just_before_watching = [this] { fs::remove(folder_ / "a"); };
  EXPECT_EQ(watch.news(), FoundPaths{});
  for (int i = 0; i < 3; ++i) watch.news();
  fs::create_directories(device_.parent_path());
  EXPECT_EQ(watch.news(), FoundPaths{});
  make(device_);
  EXPECT_EQ(watch.news(), FoundPaths{0});
}

TEST_F(FileWatchTest, a_device_whose_permissions_change_is_news) {
  fs::create_directories(device_.parent_path());
  make(device_);
  FileWatch watch({device_.string()});
  EXPECT_EQ(watch.news(), FoundPaths{});
  make(device_.parent_path() / "other");
  EXPECT_EQ(watch.news(), FoundPaths{}) << "a neighbour's news";
  ASSERT_EQ(::chmod(device_.c_str(), 0600), 0);
  EXPECT_EQ(watch.news(), FoundPaths{0});
}

TEST_F(FileWatchTest, what_the_kernel_could_not_remember_is_looked_at) {
  std::size_t remembered = 0;
  std::ifstream("/proc/sys/fs/inotify/max_queued_events") >> remembered;
  if (remembered == 0 || remembered > 100'000) GTEST_SKIP() << "this kernel remembers " << remembered << " events";
  fs::create_directories(device_.parent_path());
  const fs::path one = device_.parent_path() / "one", other = device_.parent_path() / "other";
  for (const fs::path& file : {one, other, device_}) make(file);
  FileWatch watch({device_.string(), (folder_ / "absent").string()});
  // Two of the same kind in a row are told as one.
  for (std::size_t i = 0; i <= remembered; ++i) ::chmod((i % 2 == 0 ? one : other).c_str(), 0600);
  ::chmod(device_.c_str(), 0600);
  EXPECT_EQ(watch.news(), FoundPaths{0});
  EXPECT_EQ(watch.news(), FoundPaths{}) << "said once";
}

}  // namespace
}  // namespace prismesh::drivers::port
