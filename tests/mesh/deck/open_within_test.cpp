// Decks whose files come from memory: limits, and reading a deck twice.
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/deck/open.h"

namespace prismesh::mesh::deck {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class FilesInMemory : public FileAccess {
 public:
  explicit FilesInMemory(std::map<std::string, std::string> files) : files_(std::move(files)) {}
  FileKind kind_of(const std::filesystem::path& path) const override {
    return files_.contains(path.string()) ? FileKind::file : FileKind::missing;
  }
  std::string canonical_name(const std::filesystem::path& path) const override { return path.string(); }
  Result<FileBytes> read(const std::filesystem::path& path) const override {
    ++reads;
    const auto found = files_.find(path.string());
    if (found == files_.end()) return fail(path.string(), "isn't in memory");
    return FileBytes::copy_of(found->second, {});
  }
  bool is_confined() const override { return true; }

  mutable int reads = 0;

 private:
  std::map<std::string, std::string> files_;
};

const std::string kTwoNodes =
    "*NODE\n       1             0.0             0.0             0.0\n       2             1.0             0.0             0.0\n";

TEST(OpenWithin, reads_all_files_by_the_access_it_is_given) {
  const FilesInMemory files({{"main.k", "*KEYWORD\n*INCLUDE\na.k\n*INCLUDE\nnone.k\n*END\n"}, {"a.k", kTwoNodes}});
  const auto opened = open_within(files, {}, "main.k");
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(opened->model.node_count(), 2u);
  EXPECT_EQ(files.reads, 2);
  EXPECT_EQ(opened->deck->missing_files, std::vector<std::string>{"none.k"});
  EXPECT_EQ(open_within(files, {}, "other.k").error().text(), "other.k: isn't in memory");
}

TEST(OpenWithin, allows_what_just_fits) {
  const std::string main = "*KEYWORD\n*INCLUDE\na.k\n*END\n";
  const FilesInMemory files({{"main.k", main}, {"a.k", kTwoNodes}});
  const ReadingLimits fits{2, main.size() + kTwoNodes.size(), 2, 0};
  EXPECT_TRUE(open_within(files, fits, "main.k"));
  const auto refused = [&](ReadingLimits limits) {
    const auto opened = open_within(files, limits, "main.k");
    EXPECT_EQ(opened ? ErrorKind::failure : opened.error().kind, ErrorKind::over_limit);
    return opened ? "nothing" : opened.error().text();
  };
  EXPECT_THAT(refused({1, fits.text_bytes, 2, 0}), AllOf(HasSubstr("a.k: "), HasSubstr("the 1 that are read")));
  EXPECT_THAT(refused({2, fits.text_bytes - 1, 2, 0}), AllOf(HasSubstr("a.k: "), HasSubstr(std::to_string(fits.text_bytes - 1))));
  EXPECT_THAT(refused({2, fits.text_bytes, 1, 0}), AllOf(HasSubstr("a.k: "), HasSubstr("the 1 nodes")));
}

/// An encrypted block is found only while pieces are read; then the deck is read a second time.
TEST(OpenWithin, counts_a_deck_that_is_read_twice_once) {
  const std::string main =
      "*KEYWORD\n*INCLUDE\na.k\n*NODE\n" + std::string("-----BEGIN PGP MESSAGE-----\nabc\n-----END PGP MESSAGE-----\n*END\n");
  const FilesInMemory files({{"main.k", main}, {"a.k", kTwoNodes}});
  const auto opened = open_within(files, {2, main.size() + kTwoNodes.size(), 2, 0}, "main.k");
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(opened->model.node_count(), 2u);
  EXPECT_EQ(files.reads, 3) << "the include twice";
}

}  // namespace
}  // namespace prismesh::mesh::deck
