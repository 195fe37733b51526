// Saving: what changes in the text, what doesn't, and which files are written.
#include <sys/stat.h>

#include <thread>

#include "mesh/deck/data/on_disk.h"
#include "mesh/deck/lsdyna/writer.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

using lsdyna::Columns;
using lsdyna::rewrite_node_card;

struct CardCase {
  const char* what;
  std::string card;
  Columns columns;
  Vec3 from, to;
  std::string wanted;
};

TEST(RewriteCard, keeps_columns_and_what_follows) {
  const CardCase cases[] = {
      {"only the field that changes",
       "       1        1.000000             2.0            3.00       7       0",
       Columns::standard,
       {1, 2, 3},
       {1.5, 2, 3},
       "       1             1.5             2.0            3.00       7       0"},
      {"all three",
       "       1             1.0             2.0             3.0",
       Columns::standard,
       {1, 2, 3},
       {-1, 0, 0.25},
       "       1            -1.0             0.0            0.25"},
      {"a field filled to its last column",
       "12345678-2.416931689E-01-3.286990896E-02 5.876007080E-01       0       0",
       Columns::standard,
       {-2.416931689E-01, -3.286990896E-02, 5.876007080E-01},
       {-2.416931689E-01, 1, 5.876007080E-01},
       "12345678-2.416931689E-01             1.0 5.876007080E-01       0       0"},
      {"a short line",
       "       1             1.0",
       Columns::standard,
       {1, 0, 0},
       {1, 0, 2},
       "       1             1.0                             2.0"},
      {"a line of the id alone", "1", Columns::standard, {0, 0, 0}, {0, 4, 0}, "1                                    4.0"},
      {"i10",
       "         1             1.0             2.0             3.0         0",
       Columns::i10,
       {1, 2, 3},
       {1, 2, 9},
       "         1             1.0             2.0             9.0         0"},
      {"wide",
       "                   1                 1.0                 2.0                 3.0                   0",
       Columns::wide,
       {1, 2, 3},
       {1, 1.0 / 3, 3},
       "                   1                 1.0  0.3333333333333333                 3.0                   0"},
      {"commas", "1,0.000000000E+00, 2.0 ,3,0,0", Columns::standard, {0, 2, 3}, {0.5, -2, 3}, "1,0.5, -2.0 ,3,0,0"},
      {"few commas", "1,5.0", Columns::standard, {5, 0, 0}, {5, 0, 2.5}, "1,5.0,,2.5"},
      {"numbers that lean left",
       "       6 -635.0          0.0             78.5           ",
       Columns::standard,
       {-635, 0, 78.5},
       {-635, 0, 80},
       "       6 -635.0          0.0             80.0           "},
      {"tabs", "       1\t  1.0\t2.0", Columns::standard, {1, 2, 0}, {1, 2, 3}, "       1          1.0   2.0                          3.0"},
  };
  for (const CardCase& c : cases) {
    const auto card = rewrite_node_card(c.card, c.columns, c.from, c.to);
    EXPECT_EQ(card.text, c.wanted) << c.what;
    EXPECT_EQ(card.by_parameter, false) << c.what;
  }
}

TEST(RewriteCard, says_what_it_rounds) {
  const auto card =
      rewrite_node_card("       1             1.0             2.0             3.0", Columns::standard, {1, 2, 3}, {-100.0 / 3, 2, 3.5});
  EXPECT_EQ(card.text, "       1-33.333333333333             2.0             3.5");
  EXPECT_EQ(card.rounded, 1);
  EXPECT_GT(card.largest_error, 0);
  EXPECT_LT(card.largest_error, 1e-12);
}

const char kDeck[] =
    "*KEYWORD\r\n"
    "$ comment\r\n"
    "*NODE\r\n"
    "       1             0.0             0.0             0.0       0       0\r\n"
    "2,10.,0.,0.,0,0\r\n"
    "       3            10.0            10.0             0.0       0       7\r\n"
    "*ELEMENT_SHELL\r\n"
    "       1       1       1       2       3\r\n"
    "*END\r\n"
    "what follows is kept";

TEST(Save, without_edits_gives_the_same_bytes) {
  const DeckFolder folder;
  const auto opened = folder.open(kDeck);
  ASSERT_OPENED(opened);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "new/out.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(content(folder / "new/out.k"), kDeck);
  EXPECT_EQ(saved->nodes_written, 0u);
  EXPECT_EQ(saved->lines_changed, 0u);
}

TEST(Save, changes_only_the_lines_of_moved_nodes) {
  const DeckFolder folder;
  const auto opened = folder.open(kDeck);
  ASSERT_OPENED(opened);
  Model model = with_node_at(opened->model, 2, {10, 0, -1.25});
  model = with_node_at(model, 3, {11, 10, 0});
  const auto saved = save(*opened->deck, opened->model, model, folder / "out/deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  std::string wanted = kDeck;
  wanted.replace(wanted.find("2,10.,0.,0.,0,0"), 15, "2,10.,0.,-1.25,0,0");
  const std::string third = "       3            10.0            10.0";
  wanted.replace(wanted.find(third), third.size(), "       3            11.0            10.0");
  EXPECT_EQ(content(folder / "out/deck.k"), wanted);
  EXPECT_EQ(saved->lines_changed, 2u);
  EXPECT_TRUE(saved->notes.empty());
  const auto again = deck::open(folder / "out/deck.k");
  ASSERT_OPENED(again);
  EXPECT_TRUE(moved_nodes(again->model, model).empty());
}

TEST(Save, notes_where_columns_cant_hold_the_precision) {
  const DeckFolder folder;
  const auto opened = folder.open(kDeck);
  ASSERT_OPENED(opened);
  Model model = with_node_at(opened->model, 2, {100.0 / 3, 0, 0});
  model = with_node_at(model, 3, {100.0 / 3, 200.0 / 3, 0});
  const auto saved = save(*opened->deck, opened->model, model, folder / "out/deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  ASSERT_EQ(saved->notes.size(), 1u);
  EXPECT_NE(saved->notes[0].find("3 numbers were rounded"), std::string::npos) << saved->notes[0];
  EXPECT_NE(saved->notes[0].find("deck.k:5 (node 2)"), std::string::npos) << saved->notes[0];
}

/// Whatever is saved reads back within what the columns hold, in every layout.
TEST(Save, reads_back_within_the_fields_precision) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*NODE\n       1             0.0             0.0             0.0\n2,0.,0.,0.\n*NODE %\n         3             0.0\n"
      "*NODE +\n                   4                 0.0                 0.0                 0.0\n");
  ASSERT_OPENED(opened);
  double scale = 1e-6;
  for (int i = 0; i < 200; ++i, scale *= 1.17) {
    Model model = opened->model;
    for (std::size_t n = 0; n < 4; ++n) model.positions.set(n, Vec3(scale / 3, -scale / 7, scale * 1.0000001));
    const auto saved = save(*opened->deck, opened->model, model, folder / "out/deck.k");
    ASSERT_TRUE(saved) << saved.error().text();
    const auto again = deck::open(folder / "out/deck.k");
    ASSERT_OPENED(again);
    for (std::size_t n = 0; n < 4; ++n)
      for (int axis = 0; axis < 3; ++axis) ASSERT_NEAR(again->model.positions[n][axis], model.positions[n][axis], scale * 1e-10);
  }
}

TEST(Save, leaves_a_coordinates_digits_where_the_field_holds_no_difference) {
  const DeckFolder folder;
  const std::string first = "*NODE\n       1       2500.0000            2.50            3.00\n";
  const auto opened = folder.open(first);
  ASSERT_OPENED(opened);
  std::size_t written = 1;
  const auto moved_to = [&](const Vec3& at) {
    const auto saved = save(*opened->deck, opened->model, with_node_at(opened->model, 1, at), folder / "out/deck.k");
    EXPECT_TRUE(saved) << saved.error().text();
    written = saved ? saved->nodes_written : 0;
    return content(folder / "out/deck.k");
  };
  EXPECT_EQ(moved_to({2500 + 1e-12, 2.5, 3}), first);
  EXPECT_EQ(written, 0u) << "its card says the same";
  EXPECT_EQ(moved_to({2500 + 1e-12, 2.75, 3}), "*NODE\n       1       2500.0000            2.75            3.00\n");
  EXPECT_EQ(written, 1u);
}

TEST(Save, in_place_writes_only_the_files_that_change) {
  const DeckFolder folder;
  folder.write("a.k", "*NODE\n2,2.,0.,0.\n");
  folder.write("b.k", "*NODE\n3,3.,0.,0.\n");
  const auto opened = folder.open("*KEYWORD\n*INCLUDE\na.k\n*INCLUDE\nb.k\n*NODE\n1,1.,0.,0.\n*END\n");
  ASSERT_OPENED(opened);
  const auto before = identify_file(folder / "b.k");
  Model model = with_node_at(opened->model, 2, {2.5, 0, 0});
  auto saved = save(*opened->deck, opened->model, model, folder / "deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->files_written, std::vector<std::filesystem::path>{folder / "a.k"});
  EXPECT_EQ(content(folder / "a.k"), "*NODE\n2,2.5,0.,0.\n");
  EXPECT_EQ(*identify_file(folder / "b.k"), *before);
  // Again, after more edits and after undoing them all.
  model = with_node_at(model, 1, {7, 0, 0});
  saved = save(*opened->deck, opened->model, model, folder / "deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(content(folder / "a.k"), "*NODE\n2,2.5,0.,0.\n");
  EXPECT_NE(content(folder / "deck.k").find("1,7.0,0.,0."), std::string::npos);
  saved = save(*opened->deck, opened->model, opened->model, folder / "deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(content(folder / "a.k"), "*NODE\n2,2.,0.,0.\n");
  EXPECT_NE(content(folder / "deck.k").find("1,1.,0.,0."), std::string::npos);
}

TEST(Save, in_place_refuses_a_file_that_is_no_longer_the_one_read) {
  const DeckFolder folder;
  const auto opened = folder.open(kDeck);
  ASSERT_OPENED(opened);
  const Model model = with_node_at(opened->model, 2, {1, 2, 3});
  // The times alone don't matter.
  folder.write("deck.k", kDeck);
  EXPECT_TRUE(save(*opened->deck, opened->model, opened->model, folder / "deck.k"));
  std::string changed = kDeck;
  changed[changed.find("comment")] = 'C';
  folder.write("deck.k", changed);
  auto saved = save(*opened->deck, opened->model, model, folder / "deck.k");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().message.find("has changed on disk"), std::string::npos) << saved.error().text();
  EXPECT_EQ(content(folder / "deck.k"), changed);
  folder.write("deck.k", "short");
  EXPECT_FALSE(save(*opened->deck, opened->model, model, folder / "deck.k"));
  EXPECT_EQ(content(folder / "deck.k"), "short");
  std::filesystem::remove(folder / "deck.k");
  saved = save(*opened->deck, opened->model, model, folder / "deck.k");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().message.find("is gone"), std::string::npos);
  // Elsewhere it can be saved all the same.
  EXPECT_TRUE(save(*opened->deck, opened->model, model, folder / "other/deck.k"));
}

TEST(Save, into_another_folder_takes_all_includes_along) {
  const DeckFolder folder;
  folder.write("src/sub/a.k", "*NODE\n2,2.,0.,0.\n*INCLUDE\nb.k\n");
  folder.write("src/sub/b.k", "*NODE\n3,3.,0.,0.\n");
  folder.write("src/moved.k", "*NODE\n9,9.,0.,0.\n");
  const auto main =
      folder.write("src/deck.k", "*KEYWORD\n*INCLUDE\nsub/a.k\n*INCLUDE\nlost.k\n*INCLUDE_TRANSFORM\nmoved.k\n         5\n*END\n");
  const auto opened = deck::open(main);
  ASSERT_OPENED(opened);
  const Model model = with_node_at(opened->model, 3, {3.5, 0, 0});
  const auto saved = save(*opened->deck, opened->model, model, folder / "out/new.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->files_written.size(), 4u);
  EXPECT_EQ(saved->files_written.back(), folder / "out/new.k") << "the main file comes last";
  EXPECT_EQ(content(folder / "out/sub/b.k"), "*NODE\n3,3.5,0.,0.\n");
  EXPECT_EQ(content(folder / "src/sub/b.k"), "*NODE\n3,3.,0.,0.\n");
  EXPECT_EQ(content(folder / "out/sub/a.k"), content(folder / "src/sub/a.k"));
  EXPECT_EQ(content(folder / "out/moved.k"), content(folder / "src/moved.k"));
  const auto again = deck::open(folder / "out/new.k");
  ASSERT_OPENED(again);
  EXPECT_EQ(position_of(again->model, 3), Vec3(3.5, 0, 0));
}

TEST(Save, into_another_folder_refuses_an_include_from_outside) {
  const DeckFolder folder;
  folder.write("common.k", "*NODE\n2,2.,0.,0.\n");
  const auto main = folder.write("src/deck.k", "*INCLUDE\n../common.k\n*NODE\n1,1.,0.,0.\n");
  const auto opened = deck::open(main);
  ASSERT_OPENED(opened);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "out/deck.k");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().file.find("common.k"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  // In place it is a file like any other.
  const Model model = with_node_at(opened->model, 2, {5, 0, 0});
  const auto in_place = save(*opened->deck, opened->model, model, main);
  ASSERT_TRUE(in_place) << in_place.error().text();
  EXPECT_EQ(content(folder / "common.k"), "*NODE\n2,5.0,0.,0.\n");
}

/// A copy of the deck would still mean the old file.
TEST(Save, into_another_folder_refuses_an_include_with_an_absolute_name) {
  const DeckFolder folder;
  const auto include = folder.write("src/a.k", "*NODE\n2,2.,0.,0.\n");
  const auto main = folder.write("src/deck.k", "*INCLUDE\n" + include.string() + "\n");
  const auto opened = deck::open(main);
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.node_count(), 1u);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "out/deck.k");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().file.find("a.k"), std::string::npos);
  EXPECT_TRUE(save(*opened->deck, opened->model, opened->model, main));
}

TEST(Save, beside_the_old_deck_leaves_its_includes_alone) {
  const DeckFolder folder;
  folder.write("a.k", "*NODE\n2,2.,0.,0.\n");
  const auto opened = folder.open("*INCLUDE\na.k\n*NODE\n1,1.,0.,0.\n");
  ASSERT_OPENED(opened);
  const auto main_only = save(*opened->deck, opened->model, with_node_at(opened->model, 1, {4, 0, 0}), folder / "copy.k");
  ASSERT_TRUE(main_only) << main_only.error().text();
  EXPECT_EQ(main_only->files_written.size(), 1u);
  const auto shared = save(*opened->deck, opened->model, with_node_at(opened->model, 2, {4, 0, 0}), folder / "copy.k");
  ASSERT_FALSE(shared);
  EXPECT_NE(shared.error().file.find("a.k"), std::string::npos);
  EXPECT_EQ(content(folder / "a.k"), "*NODE\n2,2.,0.,0.\n");
  EXPECT_FALSE(save(*opened->deck, opened->model, opened->model, folder / "a.k")) << "the main file over its own include";
}

TEST(Save, beside_the_old_deck_includes_from_outside_stay_where_they_are) {
  const DeckFolder folder;
  folder.write("common.k", "*NODE\n2,2.,0.,0.\n");
  const auto absolute = folder.write("abs.k", "*NODE\n3,3.,0.,0.\n");
  const auto main = folder.write("src/deck.k", "*INCLUDE\n../common.k\n" + absolute.string() + "\n*NODE\n1,1.,0.,0.\n");
  const auto opened = deck::open(main);
  ASSERT_OPENED(opened);
  const auto saved = save(*opened->deck, opened->model, with_node_at(opened->model, 1, {4, 0, 0}), folder / "src/copy.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->files_written, std::vector<std::filesystem::path>{folder / "src/copy.k"});
  const auto copy = deck::open(folder / "src/copy.k");
  ASSERT_OPENED(copy);
  EXPECT_EQ(copy->model.node_count(), 3u);
  for (const std::int64_t shared : {2, 3}) {
    const auto refused = save(*opened->deck, opened->model, with_node_at(opened->model, shared, {4, 0, 0}), folder / "src/copy2.k");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("would share it"), std::string::npos) << refused.error().text();
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "src/copy2.k"));
}

TEST(Save, refuses_nodes_that_must_not_move) {
  const DeckFolder folder;
  const auto opened = folder.open("*PARAMETER\nRa,1.0\n*NODE\n1,&a,0.,0.\n2,2.,0.,0.\n");
  ASSERT_OPENED(opened);
  const auto held = save(*opened->deck, opened->model, with_node_at(opened->model, 1, {4, 0, 0}), folder / "out/deck.k");
  ASSERT_FALSE(held);
  EXPECT_EQ(held.error().line, 4);
  EXPECT_NE(held.error().message.find("node 1"), std::string::npos);
  const auto no_number = save(*opened->deck, opened->model, with_node_at(opened->model, 2, {4, 0, std::numeric_limits<double>::infinity()}),
                              folder / "out/deck.k");
  ASSERT_FALSE(no_number);
  EXPECT_EQ(no_number.error().line, 5);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

/// At each of the times it asks; then all the way, so that stopping has broken nothing.
TEST(Save, told_to_stop_it_leaves_the_deck_as_it_was) {
  const DeckFolder folder;
  const std::string include = "*NODE\n2,2.,0.,0.\n";
  const std::string text = "*INCLUDE\na.k\n*NODE\n1,1.,0.,0.\n$" + std::string(std::size_t{17} << 20, 'x') + "\n";
  folder.write("a.k", include);
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  const Model model = with_node_at(with_node_at(opened->model, 1, {1.5, 0, 0}), 2, {2.5, 0, 0});
  const auto entries = [&] { return std::distance(std::filesystem::directory_iterator(folder.path()), {}); };
  std::size_t stop = 0;
  for (bool done = false; !done; ++stop) {
    std::size_t asked = 0;
    double last = 0;
    const auto saved = save(*opened->deck, opened->model, model, folder / "deck.k", [&](double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
      return asked++ < stop;
    });
    done = saved.has_value();
    EXPECT_EQ(entries(), 2);
    if (done) break;
    EXPECT_EQ(saved.error().message, cancelled().message);
    EXPECT_EQ(content(folder / "deck.k"), text);
    EXPECT_EQ(content(folder / "a.k"), include);
  }
  EXPECT_GE(stop, 4u) << "8 MB at a time";
  EXPECT_EQ(content(folder / "a.k"), "*NODE\n2,2.5,0.,0.\n");
  std::string wanted = text;
  EXPECT_TRUE(content(folder / "deck.k") == wanted.replace(wanted.find("1,1.,"), 5, "1,1.5,"));
}

TEST(Save, while_a_deck_is_saved_nobody_else_saves_it) {
  const DeckFolder folder;
  const auto opened = folder.open("*NODE\n1,1.,0.,0.\n");
  ASSERT_OPENED(opened);
  int asked = 0, free = 0;
  const auto saved = save(*opened->deck, opened->model, with_node_at(opened->model, 1, {4, 0, 0}), folder / "deck.k", [&](double) {
    ++asked;
    std::thread([&] {
      if (!opened->deck->on_disk->mutex.try_lock()) return;
      ++free;
      opened->deck->on_disk->mutex.unlock();
    }).join();
    return true;
  });
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_GT(asked, 0);
  EXPECT_EQ(free, 0);
  EXPECT_TRUE(opened->deck->on_disk->mutex.try_lock()) << "afterwards the next one may";
  opened->deck->on_disk->mutex.unlock();
}

TEST(Save, a_symbolic_link_stays_one) {
  const DeckFolder folder;
  folder.write("real/deck.k", kDeck);
  std::filesystem::create_symlink("real/deck.k", folder / "link.k");
  const auto opened = deck::open(folder / "link.k");
  ASSERT_OPENED(opened);
  ASSERT_TRUE(save(*opened->deck, opened->model, with_node_at(opened->model, 2, {5, 0, 0}), folder / "link.k"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.k"));
  EXPECT_NE(content(folder / "real/deck.k").find("2,5.0,0.,0.,0,0"), std::string::npos);
}

}  // namespace
}  // namespace prismesh::mesh::deck
