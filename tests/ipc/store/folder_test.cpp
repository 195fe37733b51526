#include "ipc/store/folder.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace prismesh::ipc::store {
namespace {

class StoreFolder : public testing::Test {
 protected:
  StoreFolder() { std::filesystem::create_directories(path_); }
  ~StoreFolder() override { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& content) const { std::ofstream(path_ / name) << content; }
  Folder folder() const { return *Folder::open(path_); }

  const std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

// The limit of the audit log is a quarter of a gigabyte, which every start of prismesh-intake took, and which a small machine doesn't have.
TEST_F(StoreFolder, content_takes_the_memory_of_the_file_and_not_of_the_limit) {
  write("small", "a few bytes");
  for (const std::size_t limit : {std::size_t{1} << 28, std::size_t{1} << 60, SIZE_MAX}) {
    const Result<std::string> text = folder().content("small", limit);
    ASSERT_TRUE(text) << limit << ": " << text.error().text();
    EXPECT_EQ(*text, "a few bytes");
    EXPECT_LT(text->capacity(), std::size_t{1} << 20);
  }
}

TEST_F(StoreFolder, content_is_whole_and_never_longer_than_the_limit) {
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 65537U, 131072U, 500000U}) {
    std::string content(size, '\0');
    for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<char>(i * 31 + i / 977);
    write("file", content);
    const Result<std::string> text = folder().content("file", size);
    ASSERT_TRUE(text) << size << ": " << text.error().text();
    EXPECT_EQ(*text, content) << size;
    if (size == 0) continue;
    const Result<std::string> refused = folder().content("file", size - 1);
    ASSERT_FALSE(refused) << size;
    EXPECT_NE(refused.error().text().find("is longer than " + std::to_string(size - 1) + " bytes"), std::string::npos);
  }
}

}  // namespace
}  // namespace prismesh::ipc::store
