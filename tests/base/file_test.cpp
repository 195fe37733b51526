#include "base/file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace prismesh {
namespace {

namespace fs = std::filesystem;

class FileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "prismesh-file-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override {
    std::error_code ignored;
    fs::permissions(folder_ / "locked", fs::perms::owner_all, ignored);
    fs::remove_all(folder_, ignored);
  }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Names in the folder: nothing temporary may stay.
  std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_;
};

TEST_F(FileTest, reads_all_bytes_and_a_nul_behind) {
  std::string text;
  for (int i = 0; i < 5'000'000; ++i) text += static_cast<char>(i * 7 % 251);
  const Result<FileBytes> bytes = read_file(write("a", text));
  ASSERT_TRUE(bytes) << bytes.error().text();
  EXPECT_EQ(bytes->text(), text);
  EXPECT_EQ(bytes->text().data()[text.size()], '\0');
  EXPECT_EQ(bytes->identity(), *identify_file(folder_ / "a"));
}

TEST_F(FileTest, reads_an_empty_file) {
  const Result<FileBytes> bytes = read_file(write("a", ""));
  ASSERT_TRUE(bytes);
  EXPECT_TRUE(bytes->text().empty());
}

TEST_F(FileTest, what_was_read_stays_when_the_file_changes) {
  const fs::path path = write("a", "before");
  const Result<FileBytes> bytes = read_file(path);
  ASSERT_TRUE(bytes);
  fs::resize_file(path, 1);
  EXPECT_EQ(bytes->text(), "before");
  EXPECT_NE(bytes->identity(), *identify_file(path));
}

TEST_F(FileTest, says_why_it_cant_read) {
  const auto message = [&](const std::string& name) {
    const Result<FileBytes> bytes = read_file(folder_ / name);
    EXPECT_FALSE(bytes);
    EXPECT_EQ(bytes.error().file, (folder_ / name).string());
    return bytes.error().message;
  };
  EXPECT_EQ(message("nothing"), "can't be opened: No such file or directory");
  fs::create_directory(folder_ / "sub");
  EXPECT_EQ(message("sub"), "is a folder, not a file");
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(message("pipe"), "is not a regular file");
}

TEST_F(FileTest, replaces_files_and_makes_folders) {
  const fs::path old = write("old", "old text");
  fs::permissions(old, fs::perms(0640));
  const PendingFile files[] = {{folder_ / "new/deep/a", {"one, ", "", "two"}}, {old, {"new text"}}, {folder_ / "empty", {}}};
  const Result<void> done = replace_files(files);
  ASSERT_TRUE(done) << done.error().text();
  EXPECT_EQ(content(folder_ / "new/deep/a"), "one, two");
  EXPECT_EQ(content(old), "new text");
  EXPECT_EQ(content(folder_ / "empty"), "");
  EXPECT_EQ(fs::status(old).permissions(), fs::perms(0640));
  const mode_t mask = ::umask(0);
  ::umask(mask);
  EXPECT_EQ(fs::status(folder_ / "empty").permissions(), fs::perms(0666 & ~mask));
  EXPECT_EQ(entries(), 3u);
}

TEST_F(FileTest, writes_more_pieces_than_one_call_takes) {
  std::vector<std::string> pieces(5000);
  PendingFile file{folder_ / "a", {}};
  std::string all;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i] = std::to_string(i) + std::string(i % 97, 'x');
    file.pieces.push_back(pieces[i]);
    all += pieces[i];
  }
  ASSERT_TRUE(replace_files({&file, 1}));
  EXPECT_EQ(content(folder_ / "a"), all);
}

TEST_F(FileTest, writes_through_a_symbolic_link) {
  fs::create_directory(folder_ / "real");
  write("real/a", "old");
  fs::create_symlink("real/a", folder_ / "link");
  const PendingFile file{folder_ / "link", {"new"}};
  ASSERT_TRUE(replace_files({&file, 1}));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(content(folder_ / "real/a"), "new");
  fs::create_symlink("loop", folder_ / "loop");
  const PendingFile loop{folder_ / "loop", {"new"}};
  const Result<void> failed = replace_files({&loop, 1});
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("symbolic link"), std::string::npos);
}

TEST_F(FileTest, a_dangling_link_is_followed_into_a_folder_that_is_there) {
  fs::create_directory(folder_ / "real");
  fs::create_symlink("real/a", folder_ / "link");
  const PendingFile file{folder_ / "link", {"new"}};
  ASSERT_TRUE(replace_files({&file, 1}));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(content(folder_ / "real/a"), "new");

  fs::create_symlink("gone/deep/a", folder_ / "dangling");
  const PendingFile dangling{folder_ / "dangling", {"new"}};
  const Result<void> refused = replace_files({&dangling, 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text(), (folder_ / "dangling").string() + ": is a symbolic link to " + (folder_ / "gone/deep/a").string() +
                                        ", whose folder isn't there; nothing was written");
  EXPECT_FALSE(fs::exists(folder_ / "gone"));
}

TEST_F(FileTest, folders_made_for_files_that_cant_be_written_are_removed) {
  fs::create_directory(folder_ / "folder");
  fs::create_directories(folder_ / "there/empty");
  const PendingFile files[] = {{folder_ / "new/deep/a", {"new"}}, {folder_ / "there/empty/more/b", {"new"}}, {folder_ / "folder", {"new"}}};
  ASSERT_FALSE(replace_files(files));
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  EXPECT_TRUE(fs::is_directory(folder_ / "there/empty")) << "it was there before";
  EXPECT_FALSE(fs::exists(folder_ / "there/empty/more"));

  // Told to stop, or given up before the files are put in place.
  ASSERT_FALSE(replace_files(std::span(files).first(2), [](double) { return false; }));
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  { const Result<StagedFiles> staged = StagedFiles::write(std::span(files).first(2)); }
  EXPECT_FALSE(fs::exists(folder_ / "new"));

  // What something else has put there meanwhile stays.
  {
    const Result<StagedFiles> staged = StagedFiles::write(std::span(files).first(1));
    write("new/other", "text");
  }
  EXPECT_FALSE(fs::exists(folder_ / "new/deep"));
  EXPECT_EQ(content(folder_ / "new/other"), "text");
}

TEST_F(FileTest, each_file_is_checked_right_before_it_is_replaced) {
  const PendingFile files[] = {{write("a", "old"), {"new"}}, {write("b", "old"), {"new"}}};
  Result<StagedFiles> staged = StagedFiles::write(files);
  ASSERT_TRUE(staged);
  bool refuses = true;
  const auto check = [&](std::size_t at) -> Result<void> {
    EXPECT_EQ(staged->in_place(), at);
    EXPECT_EQ(content(folder_ / "a"), at == 0 ? "old" : "new");
    if (at == 1 && refuses) return fail("", "not this one");
    return {};
  };
  const Result<void> refused = staged->put_in_place(check);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text(),
            (folder_ / "b").string() + ": not this one; 1 of 2 files were already replaced, the last of them " + (folder_ / "a").string());
  EXPECT_EQ(content(folder_ / "b"), "old");
  refuses = false;
  EXPECT_TRUE(staged->put_in_place(check));
  EXPECT_EQ(content(folder_ / "b"), "new");
  for (const StagedFiles::File& file : staged->files()) EXPECT_EQ(file.identity, *identify_file(file.target));
}

TEST_F(FileTest, an_identity_differs_though_size_and_time_were_set_back) {
  const fs::path path = write("a", "one");
  const FileIdentity before = *identify_file(path);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));  // the kernel's clock of files ticks that slowly
  write("a", "two");
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  const timespec times[2] = {status.st_atim, {before.modified_ns / 1'000'000'000, before.modified_ns % 1'000'000'000}};
  ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
  const FileIdentity now = *identify_file(path);
  EXPECT_EQ(now.modified_ns, before.modified_ns);
  EXPECT_NE(now, before);
}

TEST_F(FileTest, nothing_changes_when_one_of_them_cant_be_written) {
  const fs::path first = write("first", "old");
  fs::create_directory(folder_ / "folder");
  const PendingFile files[] = {{first, {"new"}}, {folder_ / "folder", {"new"}}};
  const Result<void> failed = replace_files(files);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().file, (folder_ / "folder").string());
  EXPECT_NE(failed.error().message.find("is a folder"), std::string::npos);
  EXPECT_EQ(content(first), "old");
  EXPECT_EQ(entries(), 2u);
}

TEST_F(FileTest, a_short_write_says_so_and_leaves_nothing_behind) {
  const fs::path old = write("a", "old");
  // A limit on file sizes fails a write in its middle as a full disk does.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string large(5000, 'x');
  const PendingFile file{old, {large}};
  const Result<void> failed = replace_files({&file, 1});
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("can't be written"), std::string::npos) << failed.error().text();
  EXPECT_NE(failed.error().message.find("nothing was changed"), std::string::npos);
  EXPECT_EQ(content(old), "old");
  EXPECT_EQ(entries(), 1u);
}

/// Stopped at each of the times it is asked, the last of which is right before the first rename.
TEST_F(FileTest, told_to_stop_it_leaves_nothing_behind) {
  const fs::path first = write("first", "old");
  const fs::path second = write("second", "old");
  const std::string large(std::size_t{20} << 20, 'x');
  const PendingFile files[] = {{first, {"head", large}}, {second, {large, "tail"}}, {folder_ / "third", {"small"}}};
  std::vector<double> told;
  ASSERT_TRUE(replace_files(files, [&](double fraction) {
    told.push_back(fraction);
    return true;
  }));
  EXPECT_EQ(told.size(), 8u) << "after 8, 16 and 20 MB of the first and second, after the third, and when all is flushed";
  EXPECT_NEAR(told.front(), 0.2, 0.01);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
  EXPECT_EQ(content(first), "head" + large);
  EXPECT_EQ(content(second), large + "tail");
  fs::remove(folder_ / "third");
  write("first", "old");
  write("second", "old");
  for (std::size_t stop = 0; stop < told.size(); ++stop) {
    std::size_t asked = 0;
    const Result<void> stopped = replace_files(files, [&](double) { return asked++ < stop; });
    ASSERT_FALSE(stopped);
    EXPECT_TRUE(is_cancelled(stopped.error()));
    EXPECT_EQ(asked, stop + 1);
    EXPECT_EQ(content(first), "old");
    EXPECT_EQ(content(second), "old");
    EXPECT_EQ(entries(), 2u);
  }
}

/// /dev/full can't be renamed over, but a tiny file system could be full: where one is at hand, use it.
TEST_F(FileTest, a_full_disk_says_so) {
  const fs::path small = folder_ / "small";
  fs::create_directory(small);
  const std::string mount = "mount -t tmpfs -o size=64k tmpfs '" + small.string() + "' 2>/dev/null";
  if (std::system(mount.c_str()) != 0) GTEST_SKIP() << "can't mount a small file system here";
  const std::string large(1 << 20, 'x');
  const PendingFile file{small / "a", {large}};
  const Result<void> failed = replace_files({&file, 1});
  const bool empty = fs::is_empty(small);
  EXPECT_EQ(std::system(("umount '" + small.string() + "'").c_str()), 0);
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("the disk is full"), std::string::npos) << failed.error().text();
  EXPECT_TRUE(empty);
}

TEST_F(FileTest, a_file_marked_read_only_is_left_alone_by_root_too) {
  const fs::path target = write("readonly", "old");
  fs::permissions(target, fs::perms(0444));
  const PendingFile over_file{target, {"new"}};
  const Result<void> failed = replace_files({&over_file, 1});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "is read-only; nothing was changed");
  EXPECT_EQ(content(target), "old");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(FileTest, read_only_targets_and_folders_are_refused) {
  const fs::path others = write("others", "old");
  fs::permissions(others, ::geteuid() == 0 ? fs::perms(0644) : fs::perms(0444));
  if (::geteuid() == 0) {
    // Root may write anything; the refusals are for everybody else.
    ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
    ASSERT_EQ(::seteuid(65534), 0);
  }
  fs::create_directory(folder_ / "locked");
  write("locked/a", "old");
  fs::permissions(folder_ / "locked", fs::perms(0555));
  const fs::path target = write("readonly", "old");
  fs::permissions(target, fs::perms(0444));
  const PendingFile in_folder{folder_ / "locked/a", {"new"}};
  const PendingFile over_file{target, {"new"}};
  const Result<void> folder_failed = replace_files({&in_folder, 1});
  const Result<void> file_failed = replace_files({&over_file, 1});
  const PendingFile over_others{others, {"new"}};
  const Result<void> others_failed = replace_files({&over_others, 1});
  ASSERT_EQ(::seteuid(::getuid()), 0);
  ASSERT_FALSE(folder_failed);
  EXPECT_NE(folder_failed.error().message.find("is read-only"), std::string::npos) << folder_failed.error().text();
  ASSERT_FALSE(file_failed);
  EXPECT_EQ(file_failed.error().message, "is read-only; nothing was changed");
  EXPECT_EQ(content(target), "old");
  ASSERT_FALSE(others_failed);
  EXPECT_EQ(others_failed.error().message, "is read-only; nothing was changed");
  EXPECT_EQ(content(others), "old");
}

}  // namespace
}  // namespace prismesh
