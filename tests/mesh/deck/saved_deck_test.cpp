// The deck after a save in place, made from what is known, against reading the written files.
#include <cstdlib>
#include <iostream>

#include <nlohmann/json.hpp>

#include "mesh/deck/data/on_disk.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "mesh/deck/staged_save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

/// Some free nodes elsewhere, by what their fields may not hold.
Model some_moved(const Model& model, std::size_t about) {
  Model moved = model;
  const std::size_t step = std::max<std::size_t>(1, model.node_count() / about);
  for (std::size_t n = 0; n < model.node_count(); n += step)
    if (model.node_holds[n] == 0) moved.positions.set(n, model.positions[n] * 1.01 + Vec3(0, 1.0 / 3, -1e-3));
  return moved;
}

void expect_same_positions(const Model& a, const Model& b) {
  ASSERT_EQ(a.node_count(), b.node_count());
  EXPECT_TRUE(moved_nodes(a, b).empty());
}

/// Returns whether the quick way was open.
bool expect_what_reading_gives(const OpenedDeck& before, const Model& moved) {
  const fs::path path = before.deck->files[0].path;
  const Result<StagedSave> staged = StagedSave::write(*before.deck, before.model, moved, path);
  if (!staged) {
    ADD_FAILURE() << staged.error().text();
    return false;
  }
  const std::optional<OpenedDeck> known = staged->with_moved_nodes(before.model, moved);
  if (!known) return false;
  const Result<OpenedDeck> read = staged->open();
  if (!read) {
    ADD_FAILURE() << read.error().text();
    return false;
  }
  const Deck &a = *known->deck, &b = *read->deck;
  EXPECT_EQ(a.content, b.content);
  EXPECT_EQ(a.node_runs, b.node_runs);
  EXPECT_EQ(a.node_line, b.node_line);
  EXPECT_EQ(a.shell_runs, b.shell_runs);
  EXPECT_EQ(a.shell_line, b.shell_line);
  EXPECT_EQ(a.warnings.size(), b.warnings.size());
  EXPECT_EQ(a.references->all().size(), b.references->all().size());
  EXPECT_EQ(a.files.size(), b.files.size());
  for (std::size_t f = 0; f < std::min(a.files.size(), b.files.size()); ++f) {
    EXPECT_TRUE(a.files[f].bytes.text() == b.files[f].bytes.text()) << a.files[f].path;
    EXPECT_EQ(a.files[f].path, b.files[f].path);
    EXPECT_EQ(a.on_disk->files[f].content, b.on_disk->files[f].content);
    EXPECT_TRUE(a.on_disk->files[f].as_read);
  }
  for (std::size_t f = 0; f < a.frames.size(); ++f) EXPECT_EQ(a.frames[f].is_basic(), b.frames[f].is_basic());
  expect_same_positions(known->model, read->model);
  EXPECT_EQ(known->model.shell_count(), read->model.shell_count());
  return true;
}

constexpr const char* kFirstFile =
    "*KEYWORD\n*NODE\n"
    "       1             0.0             0.0             0.0\n"
    "       2             1.0             0.0             0.0\n"
    "       3             2.0             0.0             0.0\n"
    "*INCLUDE\nrest.k\n*END\n";
constexpr const char* kSecondFile =
    "*NODE\n"
    "       4             0.0             1.0             0.0\n"
    "       5             1.0             1.0             0.0\n"
    "*ELEMENT_SHELL\n"
    "       1       1       1       2       5       4\n";

TEST(SavedDeck, is_known_without_reading_where_only_nodes_moved) {
  const DeckFolder folder;
  folder.write("rest.k", kSecondFile);
  const auto opened = folder.open(kFirstFile);
  ASSERT_OPENED(opened);
  EXPECT_TRUE(expect_what_reading_gives(*opened, some_moved(opened->model, 2)));
  EXPECT_TRUE(expect_what_reading_gives(*opened, some_moved(opened->model, 5)));
  EXPECT_TRUE(expect_what_reading_gives(*opened, opened->model)) << "nothing is written";
}

TEST(SavedDeck, is_the_base_of_the_next_save_without_being_read) {
  const DeckFolder folder;
  folder.write("rest.k", kSecondFile);
  const auto opened = folder.open(kFirstFile);
  ASSERT_OPENED(opened);
  const Model moved = some_moved(opened->model, 5);
  Result<StagedSave> staged = StagedSave::write(*opened->deck, opened->model, moved, folder / "deck.k");
  ASSERT_TRUE(staged) << staged.error().text();
  const std::optional<OpenedDeck> known = staged->with_moved_nodes(opened->model, moved);
  ASSERT_TRUE(known);
  ASSERT_TRUE(staged->put_in_place());
  staged->tell_in_place(*known->deck);
  for (std::size_t f = 0; f < 2; ++f) {
    const Result<FileIdentity> now = identify_file(known->deck->files[f].path);
    ASSERT_TRUE(now);
    EXPECT_EQ(known->deck->on_disk->files[f].identity, *now);
  }
  // A save of the base changes nothing; one of a moved node changes its line.
  const auto same = save(*known->deck, known->model, known->model, folder / "deck.k");
  ASSERT_TRUE(same) << same.error().text();
  EXPECT_EQ(same->lines_changed, 0u);
  EXPECT_TRUE(expect_what_reading_gives(*known, some_moved(known->model, 2)));
}

TEST(SavedDeck, is_read_where_cards_get_longer_or_nodes_come) {
  const DeckFolder folder;
  const auto free = folder.open("*KEYWORD\n*NODE\n1,0.0,0.0,0.0\n2,1.0,0.0,0.0\n*END\n");
  ASSERT_OPENED(free);
  EXPECT_FALSE(expect_what_reading_gives(*free, some_moved(free->model, 2)));
}

/// Every node and shell of every real deck of up to 20 MB. Skips aloud without them.
TEST(SavedDeck, of_real_decks_is_what_reading_gives) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (!models) {
    std::cout << "PRISMESH_MODELS doesn't point to the real decks: THE TEST ON THEM IS SKIPPED\n";
    GTEST_SKIP();
  }
  std::ifstream in(fs::path(models) / "counts.json");
  const nlohmann::json counts = nlohmann::json::parse(in);
  int known = 0, read = 0;
  for (const auto& [id, wanted] : counts.items()) {
    if (id == "nastran95_d08012a") continue;
    SCOPED_TRACE(id);
    const fs::path main = fs::path(models) / wanted["main"].get<std::string>();
    if (fs::file_size(main) > 20'000'000) continue;
    const auto original = deck::open(main);
    ASSERT_OPENED(original);
    if (original->model.node_count() == 0) continue;
    const DeckFolder folder;
    const fs::path copy = folder / main.filename().string();
    ASSERT_TRUE(save(*original->deck, original->model, original->model, copy));
    const auto opened = deck::open(copy);
    ASSERT_OPENED(opened);
    (expect_what_reading_gives(*opened, some_moved(opened->model, 50)) ? known : read) += 1;
  }
  std::cout << known << " decks were known, " << read << " have to be read again\n";
  EXPECT_GE(known, 30);
}

}  // namespace
}  // namespace prismesh::mesh::deck
