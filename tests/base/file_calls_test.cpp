// Files on disks whose calls are interrupted, partial or failing: every call of reading and writing whole files.
#include <fcntl.h>
#include <malloc.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/file.h"

namespace {

/// What the disk does with one kind of call.
struct Told {
  std::atomic<int> until{-1};        ///< so many calls go well, the next doesn't; -1: all go well
  std::atomic<int> error{0};         ///< 0: it does nothing and says so
  std::atomic<std::size_t> part{0};  ///< bytes of one call at most; 0: all
  std::atomic<int> calls{0};

  bool refuses() {
    ++calls;
    if (until < 0 || until-- > 0) return false;
    errno = error;
    return true;
  }
  int result() const { return error == 0 ? 0 : -1; }
  std::size_t size(std::size_t wanted) const { return part == 0 ? wanted : std::min<std::size_t>(wanted, part); }
};

struct Disk {
  Told read, write, sync, sync_folder, sync_all, close, owner, open_folder;
  std::function<void()> on_read, on_make_folder;
};
Disk& the_disk() {
  static auto* const kDisk = new Disk;  // outlives whatever still closes files at the end
  return *kDisk;
}

bool is_folder(int fd) {
  struct stat status {};
  return ::fstat(fd, &status) == 0 && S_ISDIR(status.st_mode);
}

}  // namespace

// These replace the C library's functions of the same name.
extern "C" {
ssize_t pread(int fd, void* data, size_t size, off_t offset) {
  Disk& disk = the_disk();
  if (const auto once = std::exchange(disk.on_read, {})) once();
  if (disk.read.refuses()) return disk.read.result();
  return ::syscall(SYS_pread64, fd, data, disk.read.size(size), offset);
}
ssize_t pread64(int fd, void* data, size_t size, off64_t offset) { return pread(fd, data, size, offset); }
ssize_t writev(int fd, const iovec* pieces, int count) {
  Told& told = the_disk().write;
  if (told.refuses()) return told.result();
  if (told.part == 0) return ::syscall(SYS_writev, fd, pieces, count);
  // A part of the first two, so that calls end in the middle of a piece and between pieces.
  std::vector<iovec> some(pieces, pieces + std::min(count, 2));
  std::size_t left = told.part;
  for (iovec& piece : some) left -= piece.iov_len = std::min(piece.iov_len, left);
  return ::syscall(SYS_writev, fd, some.data(), some.size());
}
int fsync(int fd) {
  Told& told = is_folder(fd) ? the_disk().sync_folder : the_disk().sync;
  return told.refuses() ? told.result() : 0;  // really flushing would only cost time: no test here cuts the power
}
int syncfs(int) noexcept {
  Told& told = the_disk().sync_all;
  return told.refuses() ? told.result() : 0;
}
int close(int fd) {
  struct stat status {};
  Told& told = the_disk().close;
  const bool refuses = ::fstat(fd, &status) == 0 && S_ISREG(status.st_mode) && told.refuses();
  const int kept = errno;
  const auto done = static_cast<int>(::syscall(SYS_close, fd));
  if (!refuses) return done;
  errno = kept;
  return told.result();
}
int fchown(int fd, uid_t owner, gid_t group) noexcept {
  Told& told = the_disk().owner;
  return told.refuses() ? told.result() : static_cast<int>(::syscall(SYS_fchown, fd, owner, group));
}
int mkdir(const char* path, mode_t mode) noexcept {
  if (const auto once = std::exchange(the_disk().on_make_folder, {})) once();
  return static_cast<int>(::syscall(SYS_mkdirat, AT_FDCWD, path, mode));
}
int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const auto mode = static_cast<mode_t>(va_arg(more, unsigned));
  va_end(more);
  Told& told = the_disk().open_folder;
  if ((flags & O_DIRECTORY) != 0 && told.refuses()) return told.result();
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
}

namespace prismesh {
namespace {

namespace fs = std::filesystem;

class FileCalls : public ::testing::Test {
 protected:
  FileCalls() {
    std::string name = (fs::temp_directory_path() / "prismesh-calls-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    for (Told* told : all()) told->calls = 0;
  }
  ~FileCalls() override {
    for (Told* told : all()) {
      told->until = -1;
      told->part = 0;
    }
    disk_.on_read = disk_.on_make_folder = {};
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  std::vector<Told*> all() {
    return {&disk_.read, &disk_.write, &disk_.sync, &disk_.sync_folder, &disk_.sync_all, &disk_.close, &disk_.owner, &disk_.open_folder};
  }
  static void refuse(Told& told, int error, int after = 0) {
    told.error = error;
    told.until = after;
  }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  /// Replaces "a", which held "old"; it has to fail with these words, and everything is as it was.
  void expect_refused(const std::string& words) {
    write("a", "old");
    const PendingFile file{folder_ / "a", {"new"}};
    const Result<void> refused = replace_files({&file, 1});
    for (Told* told : all()) told->until = -1;
    ASSERT_FALSE(refused) << words;
    EXPECT_NE(refused.error().message.find(words), std::string::npos) << refused.error().message;
    EXPECT_EQ(content(folder_ / "a"), "old") << words;
    EXPECT_EQ(names(), std::vector<std::string>{"a"}) << words;
  }

  Disk& disk_ = the_disk();
  fs::path folder_;
};

std::string counting(std::size_t size) {
  std::string text;
  while (text.size() < size) text += std::to_string(text.size()) + " ";
  return text;
}

TEST_F(FileCalls, what_is_read_in_parts_and_interrupted_is_whole) {
  const std::string text = counting(10'000);
  const fs::path path = write("a", text);
  disk_.read.part = 777;
  for (int call = 0; call < 13; ++call) {
    refuse(disk_.read, EINTR, call);
    const Result<FileBytes> bytes = read_file(path);
    ASSERT_TRUE(bytes) << bytes.error().text();
    EXPECT_EQ(bytes->text(), text);
  }
}

TEST_F(FileCalls, a_read_that_fails_or_ends_early_is_said) {
  const fs::path path = write("a", counting(10'000));
  disk_.read.part = 777;
  for (int call = 0; call < 13; ++call) {
    refuse(disk_.read, EIO, call);
    const Result<FileBytes> failed = read_file(path);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "can't be read: Input/output error");
    refuse(disk_.read, 0, call);
    const Result<FileBytes> ended = read_file(path);
    ASSERT_FALSE(ended);
    EXPECT_EQ(ended.error().message, "changed while it was being read; open it again");
  }
}

TEST_F(FileCalls, a_file_that_changes_while_it_is_read_is_said) {
  const fs::path path = write("a", "before");
  const std::function<void()> changes[] = {
      [&] { fs::resize_file(path, 3); },
      [&] { write("a", "before and after"); },
      [&] {  // as long, at another time
        const timespec times[2] = {{1, 0}, {1, 0}};
        ::utimensat(AT_FDCWD, path.c_str(), times, 0);
      },
  };
  for (const std::function<void()>& change : changes) {
    write("a", "before");
    disk_.on_read = change;
    const Result<FileBytes> bytes = read_file(path);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().message, "changed while it was being read; open it again");
  }
}

TEST_F(FileCalls, a_nul_follows_what_is_read) {
  const fs::path path = write("a", "text");
  ::mallopt(M_PERTURB, 0x5a);  // memory isn't zero by chance
  const Result<FileBytes> bytes = read_file(path);
  ::mallopt(M_PERTURB, 0);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->text().data()[4], '\0');
}

TEST_F(FileCalls, an_identity_is_that_of_the_file_system) {
  const fs::path path = write("a", "text");
  const timespec times[2] = {{1, 2}, {1'700'000'003, 4}};
  ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  const FileIdentity identity = identify_file(path).value();
  EXPECT_EQ(identity.device, status.st_dev);
  EXPECT_EQ(identity.inode, status.st_ino);
  EXPECT_EQ(identity.size, 4u);
  EXPECT_EQ(identity.modified_ns, 1'700'000'003'000'000'004);
}

TEST_F(FileCalls, what_is_written_in_parts_and_interrupted_is_whole) {
  const std::string text = counting(5'000);
  std::vector<std::string_view> pieces;
  for (std::size_t at = 0; at < text.size(); at += 333) pieces.push_back(std::string_view(text).substr(at, 333));
  disk_.write.part = 500;
  for (int call = 0; call < 8; ++call) {
    refuse(disk_.write, EINTR, call);
    const PendingFile file{folder_ / "a", pieces};
    const Result<void> done = replace_files({&file, 1});
    ASSERT_TRUE(done) << done.error().text();
    EXPECT_EQ(content(folder_ / "a"), text);
  }
}

TEST_F(FileCalls, every_call_that_fails_is_said_and_leaves_the_old_file) {
  const std::pair<int, std::string> errors[] = {{ENOSPC, "the disk is full (No space left on device)"},
                                                {EDQUOT, "the disk is full (Disk quota exceeded)"},
                                                {EIO, "can't be written: Input/output error"}};
  for (const auto& [error, words] : errors)
    for (Told* told : {&disk_.write, &disk_.sync, &disk_.close}) {
      refuse(*told, error);
      expect_refused(words + "; nothing was changed");
    }
  refuse(disk_.write, 0);
  expect_refused("can't be written: Input/output error");
  refuse(disk_.sync_folder, EIO);
  expect_refused("can't be flushed to disk: Input/output error");
  refuse(disk_.open_folder, EMFILE);
  expect_refused("can't be flushed to disk: Too many open files");
}

TEST_F(FileCalls, a_folder_is_flushed_before_the_first_file_is_replaced_and_after_the_last) {
  fs::create_directory(folder_ / "sub");
  const PendingFile files[] = {{folder_ / "a", {"1"}}, {folder_ / "sub/b", {"2"}}, {folder_ / "c", {"3"}}};
  Result<StagedFiles> staged = StagedFiles::write(files);
  ASSERT_TRUE(staged);
  EXPECT_EQ(disk_.sync_folder.calls, 2);
  for (int call = 0; call < 2; ++call) {
    refuse(disk_.sync_folder, EIO, call);
    const Result<void> failed = staged->put_in_place();
    ASSERT_FALSE(failed);
    EXPECT_NE(failed.error().message.find("can't be flushed to disk"), std::string::npos);
    EXPECT_EQ(staged->in_place(), 3u);
  }
  disk_.sync_folder.calls = 0;
  EXPECT_TRUE(staged->put_in_place());
  EXPECT_EQ(disk_.sync_folder.calls, 2);
  EXPECT_EQ(content(folder_ / "sub/b"), "2");
}

TEST_F(FileCalls, a_folder_that_may_not_be_read_is_flushed_with_its_file_system) {
  const fs::path file = write("a", "");
  refuse(disk_.open_folder, EACCES);
  EXPECT_TRUE(flush_folder(folder_, file));
  EXPECT_EQ(disk_.sync_all.calls, 1);
  EXPECT_EQ(disk_.sync_folder.calls, 0);
  refuse(disk_.open_folder, EACCES);
  EXPECT_FALSE(flush_folder(folder_)) << "no file to flush through";
  refuse(disk_.open_folder, EACCES);
  EXPECT_FALSE(flush_folder(folder_, folder_ / "none"));
  refuse(disk_.open_folder, EACCES);
  refuse(disk_.sync_all, EIO);
  EXPECT_FALSE(flush_folder(folder_, file));
  refuse(disk_.open_folder, ENFILE);
  EXPECT_FALSE(flush_folder(folder_, file)) << "that is another trouble";
  EXPECT_EQ(disk_.sync_all.calls, 2);
}

TEST_F(FileCalls, a_file_system_that_cant_flush_folders_is_taken) {
  refuse(disk_.sync_folder, EINVAL);
  EXPECT_TRUE(flush_folder(folder_));
  EXPECT_EQ(disk_.sync_folder.calls, 1);
}

TEST_F(FileCalls, what_is_put_in_place_is_what_was_written) {
  const PendingFile file{folder_ / "a", {"new"}};
  Result<StagedFiles> staged = StagedFiles::write({&file, 1});
  ASSERT_TRUE(staged);
  ASSERT_TRUE(staged->put_in_place());
  EXPECT_EQ(staged->files().front().identity, identify_file(folder_ / "a").value());
}

TEST_F(FileCalls, owner_and_group_stay) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED ALOUD: giving files away needs root";
  const fs::path path = write("a", "old");
  const PendingFile file{path, {"new"}};
  struct stat status {};
  ASSERT_EQ(::chown(path.c_str(), 65533, 65534), 0);
  ASSERT_TRUE(replace_files({&file, 1}));
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 65533u);
  EXPECT_EQ(status.st_gid, 65534u);
  refuse(disk_.owner, EPERM);  // as for anybody but root
  ASSERT_TRUE(replace_files({&file, 1}));
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 0u);
  EXPECT_EQ(status.st_gid, 65534u);
}

TEST_F(FileCalls, what_is_no_regular_file_is_not_replaced) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  const PendingFile file{folder_ / "pipe", {"new"}};
  const Result<void> refused = replace_files({&file, 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "is not a regular file; it isn't replaced");
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
}

TEST_F(FileCalls, links_are_followed_as_far_as_the_kernel_does) {
  write("0", "old");
  for (int link = 1; link <= 41; ++link)  // by their names and by whole paths
    fs::create_symlink(link % 2 == 0 ? fs::path(std::to_string(link - 1)) : folder_ / std::to_string(link - 1),
                       folder_ / std::to_string(link));
  for (const int links : {40, 41}) {
    const fs::path path = folder_ / std::to_string(links);
    const std::string text = "through " + std::to_string(links);
    const PendingFile file{path, {text}};
    const Result<void> done = replace_files({&file, 1});
    EXPECT_EQ(done.has_value(), std::ifstream(path).is_open()) << links;
    EXPECT_EQ(content(folder_ / "0"), "through 40");
    EXPECT_TRUE(fs::is_symlink(path));
  }
}

TEST_F(FileCalls, a_bare_name_is_in_the_working_folder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  const PendingFile file{"a", {"new"}};
  const Result<void> done = replace_files({&file, 1});
  fs::current_path(before);
  ASSERT_TRUE(done) << done.error().text();
  EXPECT_EQ(content(folder_ / "a"), "new");
  EXPECT_EQ(disk_.sync_folder.calls, 2);
}

TEST_F(FileCalls, folders_are_made_and_flushed_into_those_above) {
  ASSERT_TRUE(make_folders(folder_ / "a/b/"));
  EXPECT_TRUE(fs::is_directory(folder_ / "a/b"));
  EXPECT_EQ(disk_.sync_folder.calls, 2);
  refuse(disk_.sync_folder, EIO);
  EXPECT_FALSE(make_folders(folder_ / "a/c"));
  disk_.on_make_folder = [&] { fs::create_directory(folder_ / "a/d"); };
  EXPECT_TRUE(make_folders(folder_ / "a/d")) << "something else made it at the same time";
  EXPECT_TRUE(make_folders(""));
  const auto message = [](const Result<void>& made) { return made ? "made" : made.error().text(); };
  write("file", "");
  fs::create_symlink("nowhere", folder_ / "link");
  EXPECT_EQ(message(make_folders(folder_ / "file/sub")), (folder_ / "file").string() + ": Not a directory");
  EXPECT_EQ(message(make_folders(folder_ / "link")), (folder_ / "link").string() + ": Not a directory");
  EXPECT_EQ(message(make_folders("/proc/none")), "/proc/none: No such file or directory");
  const PendingFile file{folder_ / "file/sub/a", {"new"}};
  const Result<void> refused = replace_files({&file, 1});
  EXPECT_EQ(message(refused),
            (folder_ / "file/sub/a").string() + ": its folder can't be made: " + (folder_ / "file").string() + ": Not a directory");
}

}  // namespace
}  // namespace prismesh
