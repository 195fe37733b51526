#include "ipc/store/reading.h"

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/store/record_text.h"

namespace prismesh::ipc::store {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

void put_text(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string text_of(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return std::move(text).str();
}

/// A store as it lies on disk, written by hand.
class StoreReader : public ::testing::Test {
 protected:
  StoreReader() {
    std::string name = (fs::temp_directory_path() / "prismesh_store_XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    put_text(content("main"), "main");
    put_text(content("part"), "part");
    put_text(content(encode_manifest(manifest_)), encode_manifest(manifest_));
    record_ = {
        model_hash(encode_manifest(manifest_)), "Car", "ann", 1'800'000'000, 8, 2, sha256("before"), ModelFigures{4, 1, 1, 0, 0}, {}};
    put_text(store() / "models" / record_.model.hex(), encode_record(record_));
    fs::create_directories(root_ / "out");
  }
  ~StoreReader() override { fs::remove_all(root_); }

  fs::path store() const { return root_ / "store"; }
  fs::path content(const std::string& text) const { return store() / "sha256" / shard_of(sha256(text)) / sha256(text).hex(); }
  Result<void> lay_out() const { return Reader::open(store())->lay_out(manifest_, root_ / "out"); }

  fs::path root_;
  Manifest manifest_{"car/main.k", {{sha256("main"), 4, "car/main.k"}, {sha256("part"), 4, "car/parts/part.k"}}};
  ModelRecord record_;
};

TEST_F(StoreReader, finds_a_model_by_its_hash) {
  const Result<FoundModel> found = Reader::open(store())->find(record_.model);
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_EQ(found->record, record_);
  EXPECT_EQ(found->manifest, manifest_);
  EXPECT_THAT(Reader::open(store())->find(sha256("other")).error().text(), HasSubstr("holds no model"));
}

TEST_F(StoreReader, lays_the_files_out_as_includes_name_them) {
  const Result<void> done = lay_out();
  ASSERT_TRUE(done) << done.error().text();
  EXPECT_EQ(text_of(root_ / "out/car/main.k"), "main");
  EXPECT_EQ(text_of(root_ / "out/car/parts/part.k"), "part");
  EXPECT_FALSE(lay_out()) << "the folder must be empty";
}

TEST_F(StoreReader, gives_no_damaged_bytes_out) {
  put_text(content("part"), "Part");
  EXPECT_THAT(lay_out().error().text(), HasSubstr("car/parts/part.k: is damaged in the store: its bytes"));
}

TEST_F(StoreReader, notices_another_length_and_a_mark) {
  put_text(content("part"), "par");
  EXPECT_THAT(lay_out().error().text(), HasSubstr("another length"));
  put_text(store() / "damaged" / sha256("main").hex(), "");
  EXPECT_THAT(Reader::open(store())->open_file(manifest_.files[0]).error().text(), HasSubstr("is damaged in the store; send it again"));
}

TEST_F(StoreReader, notices_a_damaged_record_and_manifest) {
  std::string text = encode_record(record_);
  for (const std::size_t at : {std::size_t{0}, std::size_t{32}, text.size() / 2, text.size() - 1}) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    put_text(store() / "models" / record_.model.hex(), changed);
    EXPECT_THAT(Reader::open(store())->find(record_.model).error().text(), HasSubstr("damaged")) << at;
  }
  put_text(store() / "models" / record_.model.hex(), text);
  put_text(content(encode_manifest(manifest_)), encode_manifest(manifest_) + " ");
  EXPECT_THAT(Reader::open(store())->find(record_.model).error().text(), HasSubstr("manifest"));
}

/// A record of another model in its place would give out other files under this hash.
TEST_F(StoreReader, notices_the_record_of_another_model) {
  ModelRecord other = record_;
  other.model = sha256("other");
  put_text(store() / "models" / record_.model.hex(), encode_record(other));
  EXPECT_FALSE(Reader::open(store())->find(record_.model));
}

TEST_F(StoreReader, follows_no_links) {
  fs::remove(content("part"));
  put_text(root_ / "secret", "part");
  fs::create_symlink(root_ / "secret", content("part"));
  EXPECT_FALSE(lay_out());
  fs::remove(store() / "models" / record_.model.hex());
  put_text(root_ / "record", encode_record(record_));
  fs::create_symlink(root_ / "record", store() / "models" / record_.model.hex());
  EXPECT_FALSE(Reader::open(store())->find(record_.model));
}

TEST_F(StoreReader, lists_records_the_newest_first_without_damaged_ones) {
  ModelRecord later = record_;
  later.model = sha256("later");
  later.when_s += 60;
  put_text(store() / "models" / later.model.hex(), encode_record(later));
  put_text(store() / "models" / sha256("damaged").hex(), encode_record(later).substr(3));
  put_text(store() / "models" / sha256("under another name").hex(), encode_record(later));
  const auto all = Reader::open(store())->records(10);
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 2u);
  EXPECT_EQ((*all)[0], later);
  EXPECT_EQ((*all)[1], record_);
  EXPECT_EQ(Reader::open(store())->records(1)->size(), 1u);
}

TEST_F(StoreReader, opens_single_names_only) {
  const Result<Folder> folder = Folder::open(store());
  put_text(root_ / "secret", "secret");
  for (const char* name : {"../secret", "..", ".", "", "models/../../secret", "/etc/passwd"}) {
    EXPECT_FALSE(folder->read(name)) << name;
    EXPECT_FALSE(folder->folder(name)) << name;
  }
  fs::create_directory_symlink(root_, store() / "out");
  EXPECT_FALSE(folder->folder("out"));
  EXPECT_TRUE(folder->folder("models"));
}

TEST_F(StoreReader, writes_nothing_outside_the_folder) {
  manifest_.files[1].path = "../part.k";
  EXPECT_THAT(lay_out().error().text(), HasSubstr("the part '..'"));
  EXPECT_FALSE(fs::exists(root_ / "part.k"));
}

}  // namespace
}  // namespace prismesh::ipc::store
