#include "daemon/intake/store/store.h"

#include <fstream>

#include <gmock/gmock.h>

#include "base/base64.h"
#include "tests/daemon/intake/store_rig.h"

namespace prismesh::intake {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

StoreLimits small_limits() {
  StoreLimits limits;
  limits.reserved_bytes = 0;
  limits.quota_bytes = 10'000;
  limits.file_bytes = 5000;
  limits.uploads = 4;
  limits.upload_lifetime_s = 100;
  return limits;
}

const SetFiles kCar{{"car.k", "*INCLUDE\nparts/door.k\n"}, {"parts/door.k", std::string(2000, 'd')}};

class StoreOfModels : public ::testing::Test {
 protected:
  StoreOfModels() {
    std::string name = (fs::temp_directory_path() / "prismesh_store_XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    reopen();
  }
  ~StoreOfModels() override { fs::remove_all(root_); }

  void reopen() {
    store_.reset();
    notes_.clear();
    Result<Store> opened = open_store(path(), clock_, limits_, &notes_, ++lives_);
    ASSERT_TRUE(opened) << opened.error().text();
    store_.emplace(std::move(*opened));
  }
  fs::path path() const { return root_ / "store"; }
  fs::path content(const ipc::store::ContentHash& hash) const { return path() / "sha256" / ipc::store::shard_of(hash) / hash.hex(); }
  fs::path content(const std::string& text) const { return content(ipc::store::sha256(text)); }
  void overwrite(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }
  std::size_t incoming() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path() / "incoming"), fs::directory_iterator()));
  }
  std::vector<std::string> listed(const CatalogueQuery& query = {}) {
    std::vector<std::string> names;
    const auto found = store_->list(query);
    EXPECT_TRUE(found);
    for (const CatalogueEntry& entry : *found) names.push_back(entry.record.name + (entry.damaged ? " (damaged)" : ""));
    return names;
  }
  std::uint64_t offset(const std::string& id) { return store_->uploads().status("ann", id).value().offset; }
  /// Sends one chunk; nothing: it went well.
  std::optional<Refusal> send(const std::string& id, std::uint64_t at, const std::string& text, std::optional<Checksum> checksum = {}) {
    const auto chunk = store_->uploads().begin_chunk("ann", id, at, std::move(checksum));
    if (!chunk) return chunk.error().why;
    if (const auto added = store_->uploads().add(id, *chunk, text); !added) {
      store_->uploads().give_up_chunk(id, *chunk);
      return added.error().why;
    }
    const auto ended = store_->uploads().end_chunk(id, *chunk);
    return ended ? std::nullopt : std::optional(ended.error().why);
  }
  std::string begin(const std::string& whole) {
    const auto begun = store_->begin_upload({"ann", whole.size(), "", ipc::store::sha256(whole)});
    EXPECT_TRUE(begun) << begun.error().error.text();
    return begun ? begun->id : "";
  }

  StoreLimits limits_ = small_limits();
  ManualClock clock_;
  fs::path root_;
  std::uint64_t lives_ = 0;
  std::optional<Store> store_;
  std::vector<std::string> notes_;
};

Checksum checksum_of(const std::string& text) {
  const ipc::store::ContentHash hash = ipc::store::sha256(text);
  return {ChecksumAlgorithm::sha256, std::string(hash.bytes.begin(), hash.bytes.end())};
}

TEST_F(StoreOfModels, publishes_a_set_and_finds_it_again_after_a_restart) {
  const auto record = publish(*store_, "ann", kCar, "car.k");
  ASSERT_TRUE(record) << record.error().error.text();
  EXPECT_EQ(record->name, "car.k");
  EXPECT_EQ(record->bytes, kCar.at("car.k").size() + 2000);
  EXPECT_EQ(files_of(path(), record->model), kCar);
  EXPECT_EQ(incoming(), 0u);
  reopen();
  EXPECT_THAT(notes_, IsEmpty());
  EXPECT_EQ(files_of(path(), record->model), kCar);
  EXPECT_EQ(store_->find(record->model)->record, *record);
  EXPECT_THAT(listed(), ::testing::ElementsAre("car.k"));
}

TEST_F(StoreOfModels, publishes_nothing_that_was_not_uploaded_whole_by_its_owner) {
  ASSERT_TRUE(upload(*store_, "ann", kCar.at("car.k")));
  ASSERT_TRUE(upload(*store_, "bob", kCar.at("parts/door.k")));
  const auto refused = store_->publish(publication_of("ann", kCar, "car.k"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().why, Refusal::unfinished);
  EXPECT_EQ(refused.error().error.file, "parts/door.k");
  EXPECT_THAT(listed(), IsEmpty());
}

TEST_F(StoreOfModels, uses_stored_files_for_those_who_may_read_them) {
  ASSERT_TRUE(publish(*store_, "ann", kCar, "car.k"));
  SetFiles other = kCar;
  other["car.k"] = "another main file\n";
  ASSERT_TRUE(upload(*store_, "bob", other.at("car.k")));
  Publication publication = publication_of("bob", other, "car.k");
  EXPECT_EQ(store_->publish(publication).error().why, Refusal::unfinished);
  publication.may_use_stored = true;
  const auto record = store_->publish(publication);
  ASSERT_TRUE(record) << record.error().error.text();
  EXPECT_EQ(files_of(path(), record->model), other);
}

TEST_F(StoreOfModels, gives_the_same_answer_to_a_publication_that_is_sent_again) {
  const auto first = publish(*store_, "ann", kCar, "car.k");
  const auto again = store_->publish(publication_of("ann", kCar, "car.k"));
  ASSERT_TRUE(again) << again.error().error.text();
  EXPECT_EQ(*again, *first);
  EXPECT_EQ(store_->publish(publication_of("bob", kCar, "car.k")).error().why, Refusal::unfinished) << "that tells bob nothing";
}

TEST_F(StoreOfModels, refuses_manifests_and_names_that_are_not_sound) {
  Publication publication = publication_of("ann", kCar, "car.k");
  publication.manifest += "x";
  EXPECT_EQ(store_->publish(publication).error().why, Refusal::malformed);
  publication = publication_of("ann", kCar, "car.k");
  publication.name = "a\nb";
  EXPECT_EQ(store_->publish(publication).error().why, Refusal::malformed);
}

TEST_F(StoreOfModels, goes_on_with_an_upload_after_a_restart) {
  const std::string text(3000, 'x');
  const std::string id = begin(text);
  EXPECT_EQ(send(id, 0, text.substr(0, 1000)), std::nullopt);
  reopen();
  EXPECT_EQ(offset(id), 1000u);
  EXPECT_EQ(send(id, 999, text.substr(999)), Refusal::wrong_offset);
  EXPECT_EQ(send(id, 1000, text.substr(1000)), std::nullopt);
  reopen();
  ASSERT_TRUE(store_->publish(publication_of("ann", {{"a.k", text}}, "a.k")));
}

TEST_F(StoreOfModels, discards_a_chunk_with_a_wrong_checksum) {
  const std::string text = std::string(1000, 'a') + std::string(1000, 'b');
  const std::string id = begin(text);
  EXPECT_EQ(send(id, 0, text.substr(0, 1000), checksum_of(text.substr(0, 1000))), std::nullopt);
  EXPECT_EQ(send(id, 1000, std::string(1000, 'c'), checksum_of(text.substr(1000))), Refusal::wrong_checksum);
  EXPECT_EQ(offset(id), 1000u);
  EXPECT_EQ(fs::file_size(path() / "incoming" / id), 1000u);
  EXPECT_EQ(send(id, 1000, text.substr(1000), checksum_of(text.substr(1000))), std::nullopt);
  EXPECT_TRUE(store_->publish(publication_of("ann", {{"a.k", text}}, "a.k")));
}

TEST_F(StoreOfModels, counts_nothing_of_a_chunk_with_a_checksum_before_its_end) {
  const std::string text(2000, 'a');
  const std::string id = begin(text);
  const auto chunk = store_->uploads().begin_chunk("ann", id, 0, checksum_of(text));
  ASSERT_TRUE(store_->uploads().add(id, *chunk, text.substr(0, 1500)));
  EXPECT_EQ(offset(id), 0u);
  reopen();  // as after a kill in the middle
  EXPECT_EQ(offset(id), 0u);
  EXPECT_EQ(send(id, 0, text, checksum_of(text)), std::nullopt);
}

TEST_F(StoreOfModels, keeps_what_came_without_a_checksum_when_its_sender_is_gone) {
  const std::string id = begin(std::string(2000, 'a'));
  const auto chunk = store_->uploads().begin_chunk("ann", id, 0, std::nullopt);
  ASSERT_TRUE(store_->uploads().add(id, *chunk, std::string(700, 'a')));
  store_->uploads().give_up_chunk(id, *chunk);
  EXPECT_EQ(offset(id), 700u);
}

TEST_F(StoreOfModels, lets_a_later_request_take_an_upload_over) {
  const std::string id = begin(std::string(2000, 'a'));
  const auto first = store_->uploads().begin_chunk("ann", id, 0, std::nullopt);
  ASSERT_TRUE(store_->uploads().add(id, *first, std::string(500, 'a')));
  const auto second = store_->uploads().begin_chunk("ann", id, 500, std::nullopt);
  ASSERT_TRUE(second);
  EXPECT_EQ(store_->uploads().add(id, *first, "a").error().why, Refusal::taken_over);
  EXPECT_TRUE(store_->uploads().add(id, *second, std::string(1500, 'a')));
}

TEST_F(StoreOfModels, discards_a_file_with_a_wrong_hash) {
  const std::string id = begin("right");
  EXPECT_EQ(send(id, 0, "wrong"), Refusal::wrong_content);
  EXPECT_EQ(store_->uploads().status("ann", id).error().why, Refusal::missing);
  EXPECT_EQ(incoming(), 0u);
}

TEST_F(StoreOfModels, takes_no_more_bytes_than_were_announced) {
  const std::string id = begin("four");
  EXPECT_EQ(send(id, 0, "four and more"), Refusal::too_large);
  EXPECT_EQ(offset(id), 0u);
}

TEST_F(StoreOfModels, shows_an_upload_to_its_owner_only) {
  const std::string id = begin("four");
  EXPECT_EQ(store_->uploads().status("bob", id).error().why, Refusal::missing);
  EXPECT_EQ(store_->uploads().begin_chunk("bob", id, 0, std::nullopt).error().why, Refusal::missing);
  EXPECT_EQ(store_->uploads().terminate("bob", id).error().why, Refusal::missing);
  EXPECT_TRUE(store_->uploads().terminate("ann", id));
  EXPECT_EQ(incoming(), 0u);
}

TEST_F(StoreOfModels, removes_uploads_that_are_left) {
  const std::string old = begin("old file");
  clock_.advance_ns(60'000'000'000);
  const std::string young = begin("young file");
  EXPECT_EQ(store_->uploads().expire(), 0u);
  clock_.advance_ns(40'000'000'000);
  EXPECT_EQ(store_->uploads().expire(), 1u);
  EXPECT_FALSE(store_->uploads().status("ann", old));
  EXPECT_TRUE(store_->uploads().status("ann", young));
}

TEST_F(StoreOfModels, has_limits_for_a_file_a_token_and_the_disk) {
  const auto refused = [&](std::uint64_t length) { return store_->begin_upload({"ann", length, "", {}}).error().why; };
  EXPECT_EQ(refused(5001), Refusal::too_large);
  ASSERT_TRUE(store_->begin_upload({"ann", 5000, "", {}}));
  ASSERT_TRUE(publish(*store_, "ann", {{"a.k", std::string(4000, 'a')}}, "a.k"));
  EXPECT_EQ(refused(1001), Refusal::over_quota);
  EXPECT_TRUE(store_->begin_upload({"bob", 1001, "", {}}));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(store_->begin_upload({"ann", 1, "", {}}));
  EXPECT_EQ(refused(1), Refusal::over_quota) << "four uploads at once";
  limits_.reserved_bytes = std::uint64_t{1} << 60;
  reopen();
  EXPECT_EQ(refused(1), Refusal::no_space);
}

TEST_F(StoreOfModels, counts_stored_files_against_the_quota_of_whoever_uses_them) {
  const SetFiles big{{"a.k", std::string(5000, 'a')}, {"b.k", std::string(4000, 'b')}};
  ASSERT_TRUE(publish(*store_, "ann", big, "a.k"));
  ASSERT_TRUE(publish(*store_, "bob", {{"c.k", std::string(3000, 'c')}}, "c.k"));
  Publication publication = publication_of("bob", big, "a.k");
  publication.manifest = ipc::store::encode_manifest(manifest_of(big, "b.k"));
  publication.may_use_stored = true;
  EXPECT_EQ(store_->publish(publication).error().why, Refusal::over_quota);
}

TEST_F(StoreOfModels, finds_rot_and_gives_it_out_no_more_until_it_is_sent_again) {
  const auto record = publish(*store_, "ann", kCar, "car.k");
  const std::string door = kCar.at("parts/door.k");
  std::string rotten = door;
  rotten[1234] ^= 1;
  overwrite(content(door), rotten);
  std::vector<std::string> found;
  for (bool done = false; !done;)
    if (const auto rot = store_->scrub_next(done).value()) found.push_back(*rot);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0], HasSubstr(ipc::store::sha256(door).hex()));
  EXPECT_THAT(listed(), ::testing::ElementsAre("car.k (damaged)"));
  EXPECT_THAT(files_of(path(), record->model).begin()->second, HasSubstr("damaged"));
  reopen();
  EXPECT_THAT(listed(), ::testing::ElementsAre("car.k (damaged)")) << "a restart forgets no damage";
  ASSERT_TRUE(publish(*store_, "ann", kCar, "car.k"));
  EXPECT_THAT(listed(), ::testing::ElementsAre("car.k"));
  EXPECT_EQ(files_of(path(), record->model), kCar);
}

TEST_F(StoreOfModels, makes_a_lost_or_damaged_catalogue_anew) {
  ASSERT_TRUE(publish(*store_, "ann", kCar, "car.k"));
  store_.reset();
  fs::remove(path() / "catalogue.sqlite");
  reopen();
  EXPECT_THAT(listed(), ::testing::ElementsAre("car.k"));
  store_.reset();
  overwrite(path() / "catalogue.sqlite", std::string(8192, 'x'));
  reopen();
  EXPECT_THAT(notes_, ::testing::ElementsAre(HasSubstr("made anew")));
  EXPECT_THAT(listed(), ::testing::ElementsAre("car.k"));
}

TEST_F(StoreOfModels, removes_a_model_and_what_no_other_has) {
  const auto car = publish(*store_, "ann", kCar, "car.k");
  SetFiles other = kCar;
  other["car.k"] = "another\n";
  const auto second = publish(*store_, "ann", other, "car.k");
  ASSERT_TRUE(second);
  ASSERT_TRUE(store_->remove(car->model));
  EXPECT_EQ(store_->remove(car->model).error().why, Refusal::missing);
  EXPECT_FALSE(fs::exists(content(kCar.at("car.k"))));
  EXPECT_FALSE(fs::exists(content(car->model)));
  EXPECT_EQ(files_of(path(), second->model), other);
  EXPECT_EQ(store_->list({})->size(), 1u);
}

TEST_F(StoreOfModels, removes_nothing_while_a_record_cannot_be_read) {
  const auto record = publish(*store_, "ann", kCar, "car.k");
  overwrite(path() / "models" / record->model.hex(), "rot");
  reopen();
  EXPECT_EQ(notes_.size(), 1u);
  EXPECT_TRUE(fs::exists(content(kCar.at("car.k"))));
  EXPECT_EQ(store_->find(record->model).error().why, Refusal::damaged);
  ASSERT_TRUE(publish(*store_, "ann", kCar, "car.k")) << "it is sent again";
  EXPECT_EQ(files_of(path(), record->model), kCar);
}

TEST_F(StoreOfModels, says_what_a_reader_found) {
  const auto record = publish(*store_, "ann", kCar, "car.k");
  const ipc::store::ModelFigures figures{100, 90, 3, 2, 1};
  ASSERT_TRUE(store_->describe(record->model, figures, "a picture"));
  ASSERT_TRUE(store_->describe(record->model, figures, "another picture"));
  reopen();
  const auto found = store_->find(record->model);
  EXPECT_EQ(found->record.figures, figures);
  EXPECT_EQ(found->record.thumbnail, ipc::store::sha256("another picture"));
  EXPECT_FALSE(fs::exists(content("a picture")));
  EXPECT_TRUE(fs::exists(content("another picture")));
}

TEST_F(StoreOfModels, finds_models_by_name_and_lineage) {
  const auto first = publish(*store_, "ann", {{"100%.k", "a"}}, "100%.k");
  ASSERT_TRUE(upload(*store_, "ann", "b"));
  Publication edited = publication_of("ann", {{"edited.k", "b"}}, "edited.k");
  edited.derived_from = first->model;
  edited.when_s += 10;
  ASSERT_TRUE(store_->publish(edited));
  EXPECT_THAT(listed(), ::testing::ElementsAre("edited.k", "100%.k"));
  EXPECT_THAT(listed({"0%", {}, 0, 100}), ::testing::ElementsAre("100%.k"));
  EXPECT_THAT(listed({"0_", {}, 0, 100}), IsEmpty());
  EXPECT_THAT(listed({"", first->model, 0, 100}), ::testing::ElementsAre("edited.k"));
  EXPECT_THAT(listed({"", {}, 1, 1}), ::testing::ElementsAre("100%.k"));
  EXPECT_THAT(listed({"'; DROP TABLE models; --", {}, 0, 100}), IsEmpty());
}

TEST_F(StoreOfModels, is_one_process_s_at_a_time) {
  EXPECT_THAT(open_store(path(), clock_, limits_).error().text(), HasSubstr("another process"));
}

TEST(ChunkChecksum, is_read_from_its_header) {
  const std::string digest(32, 'd');
  const std::string text = base64_encode(std::as_bytes(std::span(digest.data(), digest.size())));
  EXPECT_EQ(parse_checksum("sha256 " + text), (Checksum{ChecksumAlgorithm::sha256, digest}));
  for (const std::string& bad : {std::string(), std::string("sha256"), "sha256 " + text.substr(4), "md5 " + text, "sha1 " + text,
                                 "sha256  " + text, "SHA256 " + text})
    EXPECT_FALSE(parse_checksum(bad)) << bad;
  ChunkDigest sha1(ChecksumAlgorithm::sha1);
  sha1.add("ab");
  sha1.add("c");
  const std::string is = sha1.digest();
  EXPECT_EQ(base64_encode(std::as_bytes(std::span(is.data(), is.size()))), "qZk+NkcGgWq6PiVxeFDCbJzQ2J0=");
}

}  // namespace
}  // namespace prismesh::intake
