// The store: results appear whole, the first one stays, and work that was left goes. Studies: what changes a variant's key.
#include "mesh/batch/store.h"

#include <chrono>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mesh/batch/read_many.h"
#include "mesh/batch/records.h"
#include "mesh/batch/study.h"
#include "mesh/batch/tabulate.h"
#include "mesh/batch/work.h"
#include "mesh/deck/sample.h"

namespace prismesh::mesh::batch {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class StoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("prismesh-store-" + std::to_string(std::random_device{}()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name, std::ios::binary) << text; }
  static std::string read(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path folder_;
};

VariantResult result(const std::string& reason) {
  VariantResult made;
  made.key = "abc";
  made.reason = reason;
  made.values = {{"height", 2.5}, {"part", "part:1"}};
  made.after.mass = 3;
  return made;
}

TEST_F(StoreTest, a_result_appears_whole_and_the_first_one_stays) {
  const Store store(folder_);
  EXPECT_FALSE(store.has("abc"));
  Result<WorkFolder> one = store.begin("abc");
  ASSERT_TRUE(one);
  std::ofstream(one->path() / "deck.k") << "first";
  EXPECT_FALSE(store.has("abc")) << "nothing is there until it is accepted";
  ASSERT_TRUE(store.note({"abc", "the disk is full", 1}));
  EXPECT_EQ(store.failure_of("abc")->reason, "the disk is full");
  const Result<bool> accepted = store.accept(std::move(*one), result("first"));
  ASSERT_TRUE(accepted && *accepted);
  EXPECT_TRUE(store.has("abc"));
  EXPECT_FALSE(store.failure_of("abc")) << "a result removes the failure";
  Result<WorkFolder> two = store.begin("abc");
  ASSERT_TRUE(two);
  std::ofstream(two->path() / "deck.k") << "second";
  const Result<bool> late = store.accept(std::move(*two), result("second"));
  ASSERT_TRUE(late);
  EXPECT_FALSE(*late);
  EXPECT_EQ(read(store.folder_of("abc") / "deck.k"), "first");
  const Result<VariantResult> kept = read_result(store.folder_of("abc") / "result.json");
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->reason, "first");
  EXPECT_EQ(kept->values[0].value, ParameterValue(2.5));
  EXPECT_EQ(kept->values[1].value, ParameterValue("part:1"));
  EXPECT_EQ(kept->after.mass, 3);
  EXPECT_FALSE(kept->before.mass);
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_ / "variants")) ++entries;
  EXPECT_EQ(entries, 1U) << "no folder of work is left";
}

TEST_F(StoreTest, of_many_at_once_one_is_accepted) {
  const Store store(folder_);
  std::vector<WorkFolder> folders;
  for (int i = 0; i < 8; ++i) {
    // of one process each: their names have the process's number
    const fs::path path = folder_ / "variants";
    fs::create_directories(path);
    if (const pid_t child = fork(); child == 0) {
      Result<WorkFolder> work = store.begin("abc");
      const bool done = work && store.accept(std::move(*work), result(std::to_string(getpid()))).value_or(false);
      _exit(done ? 1 : 0);
    }
  }
  int accepted = 0, status = 0;
  for (int i = 0; i < 8; ++i)
    if (wait(&status) > 0) accepted += WEXITSTATUS(status);
  EXPECT_EQ(accepted, 1);
  EXPECT_TRUE(store.has("abc"));
}

TEST_F(StoreTest, work_of_a_killed_process_is_removed_and_that_of_others_stays) {
  const Store store(folder_);
  const pid_t child = fork();
  if (child == 0) {
    Result<WorkFolder> work = store.begin("abc");
    _exit(work ? 0 : 1);  // as a kill does: the destructor doesn't run
  }
  int status = 1;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  const Result<WorkFolder> own = store.begin("def");
  ASSERT_TRUE(own);
  fs::create_directory(folder_ / "variants" / "work-ghi-another_machine-1");
  EXPECT_EQ(store.remove_left_work(), 1U);
  EXPECT_TRUE(fs::exists(own->path()));
  EXPECT_TRUE(fs::exists(folder_ / "variants" / "work-ghi-another_machine-1"));
}

TEST_F(StoreTest, work_of_one_ended_process_is_removed_alone) {
  const Store store(folder_);
  const auto leave = [&](const char* key) {
    const pid_t child = fork();
    if (child == 0) {
      Result<WorkFolder> work = store.begin(key);
      _exit(work ? 0 : 1);  // as a kill does: the destructor doesn't run
    }
    int status = 1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    return child;
  };
  const auto left = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "variants")) names.insert(entry.path().filename().string().substr(0, 8));
    return names;
  };
  const pid_t one = leave("abc");
  leave("def");
  store.remove_work("def", one);
  store.remove_work("abc", one + 1);
  EXPECT_EQ(left(), (std::set<std::string>{"work-abc", "work-def"}));
  store.remove_work("abc", one);
  EXPECT_EQ(left(), (std::set<std::string>{"work-def"}));
}

TEST(ReadMany, each_once_and_sixteen_blocks_at_the_same_time) {
  for (const std::size_t count : {0U, 1U, 63U, 64U, 65U, 5000U}) {
    std::vector<int> seen(count);
    read_many(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
    EXPECT_EQ(seen, std::vector<int>(count, 1));
  }
  // as many readers wait for each other as there may be
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t waiting = 0;
  bool all_met = true;
  read_many(16 * 64, [&](std::size_t, std::size_t) {
    std::unique_lock lock(mutex);
    ++waiting;
    changed.notify_all();
    all_met = changed.wait_for(lock, std::chrono::seconds(60), [&] { return waiting == 16; }) && all_met;
  });
  EXPECT_TRUE(all_met);
}

TEST_F(StoreTest, what_isnt_a_result_is_said) {
  write("r.json", "{\"key\": 1}");
  EXPECT_THAT(read_result(folder_ / "r.json").error().text(), HasSubstr("r.json: the result of a variant"));
  write("r.json", "{");
  EXPECT_THAT(read_result(folder_ / "r.json").error().text(), HasSubstr("isn't JSON"));
  EXPECT_FALSE(read_study(folder_ / "r.json"));
  fs::create_directories(folder_ / "failed");
  write("failed/abc.json", "[]");
  EXPECT_THAT(Store(folder_).failure_of("abc")->reason, HasSubstr("the failure of a variant"));
}

class StudyTest : public StoreTest {
 protected:
  void SetUp() override {
    StoreTest::SetUp();
    ASSERT_TRUE(deck::write_sample(folder_ / "a.k", 2000));
    write("s.jsonl", "{\"edit\": \"translate\", \"on\": \"part:1\", \"by\": [0, 0, \"${height}\"]}\n");
    write("p.toml", kPlan);
  }
  std::string key(std::size_t number = 0) const {
    const Result<Study> study = freeze(folder_ / "p.toml");
    EXPECT_TRUE(study) << study.error().text();
    return study ? *Variants(*study).key(Variants(*study).at(number)) : "";
  }
  static constexpr const char* kPlan =
      "decks = [\"a.k\"]\nscripts = [\"s.jsonl\"]\npictures = false\nrepair = \"none\"\n[parameters]\nheight = [1, 2]\n";
};

TEST_F(StudyTest, a_key_changes_with_what_goes_into_the_result_and_with_nothing_else) {
  const std::string first = key();
  EXPECT_EQ(key(), first);
  EXPECT_NE(key(1), first);
  write("p.toml", std::string("name = \"other\"\nmax_minutes = 3\n") + kPlan);
  EXPECT_EQ(key(), first);
  write("p.toml", std::string("penetrations = false\n") + kPlan);
  EXPECT_NE(key(), first);
  write("p.toml", kPlan);
  write("a.k.prismesh.toml", "target_size = 4\n");
  EXPECT_NE(key(), first);
  fs::remove(folder_ / "a.k.prismesh.toml");
  EXPECT_EQ(key(), first);
  write("a.k", "$ a comment\n" + read(folder_ / "a.k"));
  EXPECT_NE(key(), first);
}

TEST_F(StudyTest, a_study_reads_back_with_the_same_keys) {
  const Result<Study> study = freeze(folder_ / "p.toml");
  ASSERT_TRUE(study) << study.error().text();
  write("study.json", study_json(*study));
  write("p.toml", "nothing of it is read again");
  write("s.jsonl", "nor of this");
  const Result<Study> again = read_study(folder_ / "study.json");
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(*Variants(*again).key(Variants(*again).at(1)), *Variants(*study).key(Variants(*study).at(1)));
}

TEST_F(StudyTest, what_doesnt_fit_together_is_said_before_any_work) {
  const auto refused = [&] {
    const Result<Study> study = freeze(folder_ / "p.toml");
    return study ? std::string("not refused") : study.error().text();
  };
  write("p.toml", std::string(kPlan) + "pitch = [1]\n");
  EXPECT_THAT(refused(), HasSubstr("p.toml: no script names the parameter pitch: write \"${pitch}\""));
  write("p.toml", kPlan);
  write("s.jsonl", "{\"edit\": \"lift\", \"distance\": \"${height}\", \"distanze\": 1}\n");
  EXPECT_THAT(refused(), HasSubstr("s.jsonl:1: "));
  write("s.jsonl", "\n{\"edit\": \"lift\", \"distance\": \"${hight}\"}\n{\"edit\": \"lift\", \"distance\": \"${height}\"}\n");
  EXPECT_THAT(refused(), HasSubstr("s.jsonl:2: the plan has no parameter \"hight\""));
  write("s.jsonl", "{\"edit\": \"lift\", \"distance\": \"${height}\"}\n");
  write("a.k", "no deck at all\n");
  EXPECT_THAT(refused(), HasSubstr("a.k"));
  EXPECT_FALSE(freeze(folder_ / "none.toml"));
}

TEST_F(StudyTest, a_variant_is_worked_and_told_in_the_table) {
  write("s.jsonl",
        "{\"edit\": \"translate\", \"on\": \"part:1\", \"by\": [0, 0, \"${height}\"], \"free_ends\": true}\n"
        "{\"edit\": \"select\", \"expr\": \"part:${height}\"}\n");
  write("p.toml", "decks = [\"a.k\"]\nscripts = [\"s.jsonl\"]\npictures = false\nrepair = \"none\"\n[parameters]\nheight = [1, 99, 2]\n");
  const Result<Study> study = freeze(folder_ / "p.toml");
  ASSERT_TRUE(study) << study.error().text();
  const Variants variants(*study);
  const Store store(study->plan.output);
  ManualClock clock;
  for (const std::size_t number : {0U, 1U}) {
    Result<WorkFolder> work = store.begin("x");
    ASSERT_TRUE(work);
    const auto result = work_variant(*study, variants, variants.at(number), work->path(), {}, clock);
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_TRUE(*store.accept(std::move(*work), *result));
  }
  const Result<Table> table = tabulate(*study, store);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->count(RowState::done), 1U);
  EXPECT_EQ(table->count(RowState::refused), 1U);
  EXPECT_EQ(table->count(RowState::missing), 1U);
  EXPECT_THAT(table->rows[1].reason, HasSubstr("s.jsonl:2: ")) << "there is no part 99";
  EXPECT_NEAR(table->rows[0].result->max_displacement, 1, 1e-9);
  EXPECT_TRUE(table->rows[0].result->after.penetrations);
  EXPECT_THAT(table_csv(*table), HasSubstr("2,refused,a.k,s.jsonl,99,"));

  // written row by row, and yet as the library lays it out
  const std::string json = table_json(*table);
  const auto parsed = nlohmann::ordered_json::parse(json, nullptr, false);
  EXPECT_EQ(parsed.dump(1) + "\n", json);
  EXPECT_EQ(parsed["rows"].size(), 3U);
  EXPECT_EQ(parsed["rows"][1]["state"], "refused");
  const std::string empty = table_json({});
  EXPECT_EQ(nlohmann::ordered_json::parse(empty, nullptr, false).dump(1) + "\n", empty);

  // results that somebody has damaged
  const std::string first = table->rows[0].key, second = table->rows[1].key;
  fs::remove(store.folder_of(first) / "a.k");
  std::ofstream(store.folder_of(second) / "result.json") << "{";
  const Result<Table> damaged = tabulate(*study, store);
  ASSERT_TRUE(damaged) << damaged.error().text();
  EXPECT_EQ(damaged->count(RowState::failed), 2U);
  EXPECT_THAT(damaged->rows[0].reason, HasSubstr("a.k: the variant's deck is gone; the next start works it again"));
  EXPECT_THAT(damaged->rows[1].reason, HasSubstr("isn't JSON"));
  ASSERT_TRUE(store.set_aside(first));
  EXPECT_FALSE(store.has(first));
  EXPECT_TRUE(fs::exists(folder_ / "p.results/damaged" / first / "result.json"));

  // a deck that changes while the plan runs
  write("a.k", "$ a comment\n" + read(folder_ / "a.k"));
  const auto changed = work_variant(*study, variants, variants.at(2), folder_, {}, clock);
  ASSERT_FALSE(changed);
  EXPECT_THAT(changed.error().text(), HasSubstr("a.k: the deck has changed since the plan was started"));
}

}  // namespace
}  // namespace prismesh::mesh::batch
