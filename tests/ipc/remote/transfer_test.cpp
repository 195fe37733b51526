// Sending models to a station and fetching them back, over lines that are cut.
#include "ipc/store/reading.h"
#include "tests/ipc/remote/remote_rig.h"

namespace prismesh::ipc::remote {
namespace {

const FileTexts& car() {
  static const FileTexts kCar{{"car/main.k", "*INCLUDE\n../shared/door.k\n"},
                              {"car/same.k", "twice"},
                              {"car/again.k", "twice"},
                              {"car/empty.k", ""},
                              {"shared/door.k", "door"}};
  return kCar;
}

TEST_F(Remote, a_model_comes_back_as_it_was_sent) {
  const Result<Pushed> pushed = push(book(), station(), write(car()), "car/main.k", push_options());
  ASSERT_TRUE(pushed) << pushed.error().text();
  EXPECT_FALSE(pushed->was_there);
  EXPECT_EQ(pushed->model.record.files, 5u);
  EXPECT_EQ(pushed->model.record.name, "main.k");
  const Result<Pulled> pulled = pull(station(), "main.k", pull_options("back"));
  ASSERT_TRUE(pulled) << pulled.error().text();
  EXPECT_EQ(pulled->main, folder() / "back/car/main.k");
  EXPECT_EQ(texts_in(folder() / "back"), car());
  EXPECT_FALSE(fs::exists(folder() / "back.pulling"));
  const Result<Pushed> again = push(book(), station(), write(car()), "car/main.k", push_options());
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->was_there);
  EXPECT_EQ(again->sent_bytes, 0u);
  EXPECT_EQ(texts_in(folder() / "book"), FileTexts()) << "no upload is noted any more";
}

TEST_F(Remote, a_line_that_is_cut_sends_no_more_than_a_chunk_twice_each_time) {
  const FileTexts texts{{"a.k", noise(2'000'000, 1)}, {"b.k", noise(1'000'003, 2)}};
  std::mt19937_64 random(3);
  CuttingLine line(rig_.intake->port(), [&] { return 8'000 + random() % 400'000; });
  const Result<Pushed> pushed = push(book(), station(line.port()), write(texts), "a.k", push_options());
  ASSERT_TRUE(pushed) << pushed.error().text();
  EXPECT_GT(line.cuts(), 10u);
  EXPECT_LE(pushed->sent_bytes, 3'000'003 + line.cuts() * kChunk);
  EXPECT_LE(line.to_server(), 3'000'003 * 1.1 + static_cast<double>(line.cuts()) * (kChunk + 8'000)) << "on the line itself";
  const std::uint64_t cuts = line.cuts();
  const Result<Pulled> pulled = pull(station(line.port()), pushed->model.record.model.hex(), pull_options("back"));
  ASSERT_TRUE(pulled) << pulled.error().text();
  EXPECT_GT(line.cuts(), cuts + 5);
  EXPECT_EQ(pulled->received_bytes, 3'000'003u) << "no byte is fetched twice";
  EXPECT_EQ(texts_in(folder() / "back"), texts);
}

TEST_F(Remote, a_line_that_never_carries_a_whole_chunk_gets_smaller_ones) {
  const FileTexts texts{{"a.k", noise(2'000'000, 8)}};
  std::mt19937_64 random(9);
  CuttingLine line(rig_.intake->port(), [&] { return 150'000 + random() % 200'000; });
  PushOptions options = push_options();
  options.chunk_bytes = std::size_t{1} << 20;
  const Result<Pushed> pushed = push(book(), station(line.port()), write(texts), "a.k", options);
  ASSERT_TRUE(pushed) << pushed.error().text();
  EXPECT_GT(line.cuts(), 5u);
  EXPECT_LT(line.cuts(), 100u);
}

TEST_F(Remote, another_call_goes_on_where_the_last_one_stopped) {
  const FileTexts texts{{"a.k", noise(1'000'000, 4)}};
  const std::vector<LocalFile> files = write(texts);
  PushOptions once = push_options();
  once.remote.patience = std::chrono::milliseconds(0);
  std::uint64_t cut = 600'000;
  CuttingLine line(rig_.intake->port(), [&] { return std::exchange(cut, kNeverCut); });
  EXPECT_THAT(push(book(), station(line.port()), files, "a.k", once).error().text(), HasSubstr("cut"));
  const Result<Pushed> pushed = push(book(), station(line.port()), files, "a.k", once);
  ASSERT_TRUE(pushed) << pushed.error().text();
  EXPECT_FALSE(pushed->was_there);
  EXPECT_LE(pushed->sent_bytes, 1'000'000 - 600'000 + 2 * kChunk);

  PullOptions once_back = pull_options("back");
  once_back.remote.patience = std::chrono::milliseconds(0);
  std::uint64_t cut_back = 600'000;
  CuttingLine line_back(
      rig_.intake->port(), [&] { return std::exchange(cut_back, kNeverCut); }, true);
  EXPECT_FALSE(pull(station(line_back.port()), "a.k", once_back));
  EXPECT_FALSE(fs::exists(folder() / "back")) << "a model appears whole or not at all";
  const store::ContentHash hash = store::sha256(texts.at("a.k"));
  const std::uint64_t kept = fs::file_size(folder() / "back.pulling/sha256" / store::shard_of(hash) / hash.hex());
  EXPECT_GT(kept, 400'000u);
  const Result<Pulled> pulled = pull(station(line_back.port()), "a.k", once_back);
  ASSERT_TRUE(pulled) << pulled.error().text();
  EXPECT_EQ(pulled->received_bytes, 1'000'000 - kept);
  EXPECT_EQ(texts_in(folder() / "back"), texts);
}

TEST_F(Remote, what_was_changed_in_the_meantime_is_fetched_anew) {
  const FileTexts texts{{"a.k", noise(300'000, 5)}};
  const Result<Pushed> pushed = push(book(), station(), write(texts), "a.k", push_options());
  ASSERT_TRUE(pushed) << pushed.error().text();
  const store::ContentHash hash = store::sha256(texts.at("a.k"));
  const fs::path begun = folder() / "back.pulling/sha256" / store::shard_of(hash);
  fs::create_directories(begun);
  fs::permissions(folder() / "back.pulling", fs::perms::owner_all);
  std::ofstream(begun / hash.hex()) << "other bytes";
  const Result<Pulled> pulled = pull(station(), "a.k", pull_options("back"));
  ASSERT_TRUE(pulled) << pulled.error().text();
  EXPECT_EQ(texts_in(folder() / "back"), texts);
}

TEST_F(Remote, a_file_that_changes_while_it_is_sent_is_not_published) {
  const std::vector<LocalFile> files = write({{"a.k", noise(300'000, 6)}});
  PushOptions options = push_options();
  bool is_changed = false;
  options.progress = [&](double fraction) {
    if (fraction > 0.5 && !std::exchange(is_changed, true)) {
      std::fstream file(files[0].disk, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(299'000) << "changed";
    }
    return true;
  };
  EXPECT_THAT(push(book(), station(), files, "a.k", options).error().text(),
              AllOf(HasSubstr("a.k"), HasSubstr("changed while it was sent")));
  const Result<Pushed> pushed = push(book(), station(), files, "a.k", push_options());
  EXPECT_TRUE(pushed) << pushed.error().text();
}

TEST_F(Remote, work_that_is_stopped_says_so_and_leaves_nothing_half) {
  const std::vector<LocalFile> files = write({{"a.k", noise(500'000, 7)}});
  PushOptions options = push_options();
  options.progress = [](double fraction) { return fraction < 0.5; };
  const Result<Pushed> stopped = push(book(), station(), files, "a.k", options);
  ASSERT_FALSE(stopped);
  EXPECT_TRUE(is_cancelled(stopped.error())) << stopped.error().text();
  ASSERT_TRUE(push(book(), station(), files, "a.k", push_options()));
  PullOptions back = pull_options("back");
  back.progress = [](double fraction) { return fraction < 0.5; };
  const Result<Pulled> half = pull(station(), "a.k", back);
  ASSERT_FALSE(half);
  EXPECT_FALSE(fs::exists(folder() / "back"));
}

TEST_F(Remote, a_model_is_named_by_its_name_or_its_hash) {
  ASSERT_TRUE(push(book(), station(), write({{"a.k", "one"}}), "a.k", push_options()));
  const Result<Pushed> second = push(book(), station(), write({{"a.k", "two"}}), "a.k", push_options());
  ASSERT_TRUE(second);
  EXPECT_THAT(pull(station(), "a.k", pull_options("x")).error().text(), HasSubstr("has several models 'a.k'"));
  EXPECT_THAT(pull(station(), "b.k", pull_options("x")).error().text(), HasSubstr("has no model 'b.k'"));
  EXPECT_THAT(pull(station(), second->model.record.model.hex().substr(0, 5), pull_options("x")).error().text(), HasSubstr("has no model"));
  ASSERT_TRUE(pull(station(), second->model.record.model.hex().substr(0, 6), pull_options("x")));
  EXPECT_EQ(texts_in(folder() / "x").at("a.k"), "two");
  EXPECT_THAT(pull(station(), second->model.record.model.hex(), pull_options("x")).error().text(), HasSubstr("is there already"));
}

}  // namespace
}  // namespace prismesh::ipc::remote
