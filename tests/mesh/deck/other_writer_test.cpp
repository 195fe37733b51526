// A deck that another program writes while it is open or being saved: nothing of the other's is overwritten.
#include <fcntl.h>
#include <sys/stat.h>

#include <functional>
#include <thread>
#include <utility>

#include "mesh/deck/save.h"
#include "mesh/deck/staged_save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

/// A deck of two files, with a node in each.
class OtherWriter : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("a.k", kInclude);
    opened_ = folder_.open(kMain);
    ASSERT_OPENED(opened_);
    moved_ = with_node_at(with_node_at(opened_->model, 1, {1.5, 0, 0}), 2, {2.5, 0, 0});
  }
  /// Saves; when everything is written and nothing is in place, `meanwhile` runs.
  Result<SaveReport> save_with(const fs::path& target, const std::function<void()>& meanwhile) const {
    bool done = false;
    return save(*opened_->deck, opened_->model, moved_, target, [&](double fraction) {
      if (fraction >= 1 && !std::exchange(done, true)) meanwhile();
      return true;
    });
  }
  std::vector<std::string> hidden_files() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path()))
      if (std::string name = entry.path().filename().string(); name.starts_with(".")) names.push_back(std::move(name));
    return names;
  }

  static constexpr const char* kMain = "*KEYWORD\n*INCLUDE\na.k\n*NODE\n1,1.,0.,0.\n*END\n";
  static constexpr const char* kInclude = "*NODE\n2,2.,0.,0.\n";
  DeckFolder folder_;
  Result<OpenedDeck> opened_ = fail("", "not opened");
  Model moved_;
};

TEST_F(OtherWriter, is_noticed_during_a_save_in_place) {
  for (const char* file : {"deck.k", "a.k"}) {
    SetUp();
    const std::string others = content(folder_ / file) + "$ of another program\n";
    const auto saved = save_with(folder_ / "deck.k", [&] { folder_.write(file, others); });
    ASSERT_FALSE(saved) << file;
    EXPECT_NE(saved.error().message.find("has changed on disk"), std::string::npos) << saved.error().text();
    EXPECT_EQ(content(folder_ / file), others);
    EXPECT_EQ(content(folder_ / (file == std::string("a.k") ? "deck.k" : "a.k")), file == std::string("a.k") ? kMain : kInclude);
    EXPECT_TRUE(hidden_files().empty());
  }
}

TEST_F(OtherWriter, is_noticed_during_a_save_over_another_deck) {
  for (const char* file : {"deck.k", "a.k"})
    for (const bool is_there : {true, false}) {
      fs::remove_all(folder_ / "out");
      folder_.write("out/other", "");
      if (is_there)
        for (const char* each : {"out/deck.k", "out/a.k"}) folder_.write(each, "$ before\n");
      const std::string target = std::string("out/") + file;
      const auto saved = save_with(folder_ / "out/deck.k", [&] { folder_.write(target, "$ of another program\n"); });
      ASSERT_FALSE(saved) << file;
      EXPECT_NE(saved.error().message.find("another program"), std::string::npos) << saved.error().text();
      EXPECT_EQ(content(folder_ / target), "$ of another program\n");
      EXPECT_EQ(content(folder_ / (file == std::string("a.k") ? "out/deck.k" : "out/a.k")), is_there ? "$ before\n" : "");
      EXPECT_TRUE(hidden_files().empty());
    }
}

TEST_F(OtherWriter, that_only_touches_a_file_is_no_reason_to_refuse) {
  const auto saved = save_with(folder_ / "deck.k", [&] { folder_.write("a.k", kInclude); });
  EXPECT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(content(folder_ / "a.k"), "*NODE\n2,2.5,0.,0.\n");
}

TEST_F(OtherWriter, is_noticed_between_two_files) {
  Result<StagedSave> staged = StagedSave::write(*opened_->deck, opened_->model, moved_, folder_ / "deck.k");
  ASSERT_TRUE(staged) << staged.error().text();
  const fs::path temporary = staged->places()[1].temporary;
  fs::rename(temporary, folder_ / "away");
  ASSERT_FALSE(staged->put_in_place());
  ASSERT_TRUE(staged->has_begun());
  fs::rename(folder_ / "away", temporary);
  folder_.write("deck.k", "$ of another program\n");
  const Result<void> placed = staged->put_in_place();
  ASSERT_FALSE(placed);
  EXPECT_NE(placed.error().message.find("another program"), std::string::npos) << placed.error().text();
  EXPECT_EQ(content(folder_ / "deck.k"), "$ of another program\n");
  EXPECT_TRUE(staged->take_back());
  EXPECT_EQ(content(folder_ / "a.k"), kInclude);
  EXPECT_TRUE(hidden_files().size() <= 1u) << "the record of the save";
}

TEST_F(OtherWriter, that_keeps_size_and_time_is_noticed) {
  struct stat status {};
  ASSERT_EQ(::stat((folder_ / "a.k").c_str(), &status), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));  // the kernel's clock of files ticks that slowly
  const std::string others = "*NODE\n2,8.,0.,0.\n";
  folder_.write("a.k", others);
  const timespec times[2] = {status.st_atim, status.st_mtim};
  ASSERT_EQ(::utimensat(AT_FDCWD, (folder_ / "a.k").c_str(), times, 0), 0);
  const auto saved = save(*opened_->deck, opened_->model, moved_, folder_ / "deck.k");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().message.find("has changed on disk"), std::string::npos) << saved.error().text();
  EXPECT_EQ(content(folder_ / "a.k"), others);
}

TEST_F(OtherWriter, is_not_seen_in_our_own_saves) {
  for (int i = 0; i < 3; ++i) {
    moved_ = with_node_at(moved_, 2, {3.0 + i, 0, 0});
    const auto saved = save(*opened_->deck, opened_->model, moved_, folder_ / "deck.k");
    ASSERT_TRUE(saved) << saved.error().text();
  }
  EXPECT_EQ(content(folder_ / "a.k"), "*NODE\n2,5.0,0.,0.\n");
}

}  // namespace
}  // namespace prismesh::mesh::deck
