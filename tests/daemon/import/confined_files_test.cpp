// Random names, made of what leads elsewhere: whatever is read stands in the folder.
#include "daemon/import/confined_files.h"

#include <fcntl.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/wire/descriptor.h"

namespace prismesh::importer {
namespace {

namespace fs = std::filesystem;
using mesh::deck::FileKind;

class Confined : public ::testing::Test {
 protected:
  void SetUp() override {
    root = fs::temp_directory_path() / ("prismesh-confined-" + std::to_string(std::random_device{}()));
    for (const char* made : {"up/a/b", "up2", "out"}) fs::create_directories(root / made);
    for (const char* file : {"f", "out/f", "up2/f"}) std::ofstream(root / file) << "outside";
    for (const char* file : {"up/f", "up/a/f", "up/a/b/f"}) std::ofstream(root / file) << "inside";
    fs::create_directory_symlink("../out", root / "up/s");
    fs::create_directory_symlink(root, root / "up/a/s");
    fs::create_symlink("../f", root / "up/l");
    fs::create_directory_symlink(".", root / "up/here");
    folder = ipc::Descriptor(::open((root / "up").c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  }
  void TearDown() override { fs::remove_all(root); }

  fs::path root;
  ipc::Descriptor folder;
};

TEST_F(Confined, reads_nothing_elsewhere_by_10000_names) {
  const std::vector<std::string> parts{
      "..", ".", "", "a", "b", "s", "l", "f", "here", "up", "up2", "out", "...", "/", "~", "proc", "self", "root", root.string().substr(1)};
  std::mt19937 random(20261127);
  std::size_t read = 0;
  for (int i = 0; i < 10'000; ++i) {
    const fs::path shown = i % 3 == 0 ? fs::path() : i % 3 == 1 ? root / "up" : fs::path("/shown");
    const ConfinedFiles files(folder.get(), shown);
    std::string name = random() % 8 == 0 ? "/" : "";
    for (std::size_t n = 1 + random() % 6; n > 0; --n) name += parts[random() % parts.size()] + (n > 1 ? "/" : "");
    const fs::path path = shown / name;
    const Result<FileBytes> bytes = files.read(path);
    if (!bytes) continue;
    ++read;
    EXPECT_EQ(bytes->text(), "inside") << path;
    EXPECT_EQ(files.kind_of(path), FileKind::file) << path;
  }
  EXPECT_GT(read, 50u) << "the names must lead to files often enough";
}

TEST_F(Confined, tells_what_stands_at_a_path) {
  const ConfinedFiles files(folder.get(), "/shown");
  EXPECT_EQ(files.kind_of("/shown/f"), FileKind::file);
  EXPECT_EQ(files.kind_of("/shown/a"), FileKind::folder);
  EXPECT_EQ(files.kind_of("/shown/none"), FileKind::missing);
  EXPECT_EQ(files.kind_of("/shown/../f"), FileKind::refused);
  EXPECT_EQ(files.kind_of("/shown/l"), FileKind::refused);
  EXPECT_EQ(files.kind_of("/shown/here/f"), FileKind::refused) << "a link that leads into the folder is one all the same";
  EXPECT_EQ(files.kind_of("/shown2/f"), FileKind::refused) << "a folder whose name begins in the same way";
  EXPECT_EQ(files.kind_of("/etc/passwd"), FileKind::refused);
  EXPECT_EQ(files.kind_of("a/f"), FileKind::refused);
  EXPECT_EQ(files.canonical_name("/shown/a/../f"), files.canonical_name("/shown/./f"));
  EXPECT_THAT(files.read("/shown/none").error().text(), testing::HasSubstr("/shown/none: can't be opened"));
}

}  // namespace
}  // namespace prismesh::importer
