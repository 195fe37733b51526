#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/progress.h"
#include "ipc/store/local_files.h"
#include "ipc/store/receiving.h"

namespace prismesh::ipc::store {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class LocalFolder : public ::testing::Test {
 protected:
  LocalFolder() {
    std::string name = (fs::temp_directory_path() / "prismesh_local_XXXXXX").string();
    root_ = ::mkdtemp(name.data());
  }
  ~LocalFolder() override { fs::remove_all(root_); }

  void put(const std::string& name, const std::string& text) const { std::ofstream(root_ / name, std::ios::binary) << text; }
  static bool goes_on() { return true; }

  fs::path root_;
};

TEST_F(LocalFolder, a_file_that_is_not_the_one_that_was_read_is_no_part_of_a_model) {
  put("main.k", "before");
  const std::vector<LocalFile> files{{root_ / "main.k", "main.k", identify_file(root_ / "main.k").value()}};
  ASSERT_TRUE(hash_local(files, "main.k", goes_on));
  put("new.k", "behind");
  fs::permissions(root_ / "main.k", fs::perms::owner_all);
  EXPECT_TRUE(hash_local(files, "main.k", goes_on)) << "only its rights changed";
  fs::rename(root_ / "new.k", root_ / "main.k");  // as editors save
  EXPECT_THAT(hash_local(files, "main.k", goes_on).error().text(), HasSubstr("main.k: changed while it was read; push it again"));
  put("main.k", "longer than before");
  EXPECT_FALSE(hash_local(files, "main.k", goes_on));
  fs::remove(root_ / "main.k");
  EXPECT_FALSE(hash_local(files, "main.k", goes_on));
}

TEST_F(LocalFolder, what_can_take_no_name_is_refused_before_anything_is_fetched) {
  fs::create_directory(root_ / "empty");
  fs::create_symlink("empty", root_ / "link");
  fs::create_symlink("nothing", root_ / "dead");
  for (const char* name : {".", "..", "empty/.", "empty/..", "empty/./", "link", "link/", "dead"}) {
    const Result<Receiving> begun = Receiving::begin(root_ / name, ".fetching");
    ASSERT_FALSE(begun) << name;
    EXPECT_THAT(begun.error().text(), HasSubstr("with -o")) << name;
  }
  EXPECT_TRUE(Receiving::begin(root_ / "empty", ".fetching"));
  EXPECT_TRUE(Receiving::begin(root_ / "new/", ".fetching"));
}

}  // namespace
}  // namespace prismesh::ipc::store
