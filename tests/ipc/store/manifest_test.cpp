#include "ipc/store/manifest.h"

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::ipc::store {
namespace {

using ::testing::HasSubstr;

Manifest two_files() { return {"car/main.k", {{sha256("b"), 1, "car/include/b.k"}, {sha256("a"), 1, "car/main.k"}}}; }

TEST(Sha256, is_that_of_the_standard) {
  // FIPS 180-2, appendix B.1 and B.2.
  EXPECT_EQ(sha256("abc").hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq").hex(),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, goes_on_from_a_copy) {
  Sha256 hash;
  hash.add("ab");
  const Sha256 before = hash;
  hash.add("x");
  Sha256 again = before;
  again.add("c");
  EXPECT_EQ(again.hash(), sha256("abc"));
  EXPECT_EQ(hash.hash(), sha256("abx"));
}

TEST(ContentHash, is_read_as_it_is_written) {
  EXPECT_EQ(parse_content_hash(sha256("abc").hex()), sha256("abc"));
  std::string text = sha256("abc").hex();
  EXPECT_FALSE(parse_content_hash(text.substr(1)));
  EXPECT_FALSE(parse_content_hash(text + "0"));
  text[0] = 'B';
  EXPECT_FALSE(parse_content_hash(text)) << "one hash has one text";
}

TEST(ManifestText, comes_back_as_it_was) {
  const std::string text = encode_manifest(two_files());
  const Result<Manifest> read = decode_manifest(text);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(*read, two_files());
  EXPECT_EQ(read->bytes(), 2u);
  EXPECT_EQ(model_hash(text), sha256(text));
}

TEST(ManifestText, is_refused_where_it_is_another) {
  const std::string good = encode_manifest(two_files());
  const std::string hash = sha256("a").hex();
  const std::string head = "prismesh-set 1\nmain a\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "manifest:1"},
      {"prismesh-set 2\n", "manifest:1"},
      {"prismesh-set 1\n", "manifest:2"},
      {head, "manifest:2: the main file isn't one of the files"},
      {head + hash + " 1 b\n", "the main file isn't one of the files"},
      {good.substr(0, good.size() - 1), "has no end"},
      {head + hash + " 1 a\n" + hash + " 1 a\n", "manifest:4: paths must ascend"},
      {head + hash + " 1 b\n" + hash + " 1 a\n", "paths must ascend"},
      {head + hash + " 1 a\n" + hash + " 1 a-b\n" + hash + " 1 a/c\n", "'a' is a file and a folder"},
      {head + hash + " 01 a\n", "must be a SHA-256"},
      {head + hash + " -1 a\n", "must be a SHA-256"},
      {head + hash + " 1a\n", "must be a SHA-256"},
      {head + hash + " 99999999999999999999 a\n", "must be a SHA-256"},
      {head + hash + " 9223372036854775807 a\n" + hash + " 1 b\n", "too large"},
      {head + hash + " 1 a\r\n", "control characters"},
      {head + hash + " 1 ../a\n", "the part '..'"},
  };
  for (const auto& [text, message] : cases) {
    const Result<Manifest> read = decode_manifest(text);
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error().text(), HasSubstr(message)) << text;
  }
}

TEST(ManifestText, has_limits) {
  std::string text = "prismesh-set 1\nmain 10000\n";
  for (std::size_t i = 0; i <= kMaxSetFiles; ++i) text += sha256("").hex() + " 0 " + std::to_string(10000 + i) + "\n";
  EXPECT_THAT(decode_manifest(text).error().text(), HasSubstr("more than 2000 files"));
  EXPECT_THAT(decode_manifest(std::string(kMaxManifestBytes + 1, 'a')).error().text(), HasSubstr("longer than"));
}

TEST(PathOfASet, stays_beneath_its_folder) {
  for (const char* good : {"a", "a/b.k", "..a", "a..", "Längs träger.k", "a b"}) EXPECT_EQ(path_fault(good), "") << good;
  for (const char* bad : {"", "/", "/a", "a/", "a//b", ".", "..", "./a", "a/./b", "a/..", "../a", "a/../../b", "a\\b", "a\nb", "a\x7f",
                          "a\xff", "\xc0\xaf", "\xed\xa0\x80", "\xe2\x80\xae"})
    EXPECT_NE(path_fault(bad), "") << bad;
  EXPECT_NE(path_fault(std::string_view("a\0b", 3)), "");
  EXPECT_NE(path_fault(std::string(256, 'a')), "");
  EXPECT_EQ(path_fault(std::string(255, 'a')), "");
  std::string deep = "a";
  for (std::size_t i = 1; i < kMaxSetDepth; ++i) deep += "/a";
  EXPECT_EQ(path_fault(deep), "");
  EXPECT_NE(path_fault(deep + "/a"), "");
}

/// 10,000 paths of pieces that lead out of folders: each is refused, or leads to where it seems to.
TEST(PathOfASet, never_leads_elsewhere) {
  const std::vector<std::string> pieces{"..",
                                        ".",
                                        "/",
                                        "//",
                                        "a",
                                        "..a",
                                        "b..",
                                        "\\",
                                        "%2e%2e",
                                        "\xc0\xae",
                                        "..\n",
                                        "~",
                                        "C:",
                                        " ",
                                        "...",
                                        "../",
                                        "/..",
                                        "con",
                                        "\xe2\x80\xa4\xe2\x80\xa4"};
  std::mt19937_64 random(1);
  std::size_t taken = 0;
  for (int i = 0; i < 10'000; ++i) {
    std::string path;
    for (std::size_t count = 1 + random() % 8; count > 0; --count) {
      path += pieces[random() % pieces.size()];
      if (random() % 2 == 0) path += '/';
    }
    if (!path_fault(path).empty()) continue;
    ++taken;
    const std::filesystem::path as_path(path);
    ASSERT_TRUE(as_path.is_relative()) << path;
    ASSERT_EQ(as_path.lexically_normal(), as_path) << path;
    for (const auto& part : as_path) ASSERT_NE(part, "..") << path;
  }
  EXPECT_GT(taken, 100u);
}

}  // namespace
}  // namespace prismesh::ipc::store
