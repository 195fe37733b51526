// Decks packed with gzip or zstd: opened directly, saved as they were.
#include <cstdlib>
#include <iostream>

#include "base/compression.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

const std::string kGzip("\x1f\x8b\x08\x08\x00\x00\x00\x00\x00\x03hi\x00\xcb\x48\xcd\xc9\xc9\xe7\x02\x00\x20\x30\x3a\x36\x06\x00\x00\x00",
                        29);
const std::string kZstd("\x28\xb5\x2f\xfd\x24\x06\x31\x00\x00hello\n\x53\x88\xbd\x91", 19);

std::string packed(const std::string& text, const std::string& like) {
  const std::string_view whole = text;
  return pack(std::span(&whole, 1), std::as_bytes(std::span(like))).value();
}

/// What the program itself makes of a file; nullopt: it isn't here.
std::optional<std::string> unpacked_by(const std::string& program, const fs::path& file) {
  if (std::system((program + " --version > /dev/null 2>&1").c_str()) != 0) {
    std::cout << program << " isn't here: WHAT IT READS ISN'T TESTED\n";
    return std::nullopt;
  }
  const fs::path out = file.string() + ".unpacked";
  EXPECT_EQ(std::system((program + " -dc < " + file.string() + " > " + out.string()).c_str()), 0);
  return content(out);
}

const std::string kMain = "*HEADING\nplate\n*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n*INCLUDE,INPUT=rest.inp\n*ELEMENT,TYPE=S3\n1,1,2,3\n";
const std::string kRest = "3,1.,1.,0.\n** end\n";

TEST(PackedDeck, is_opened_by_its_bytes_and_saved_as_it_was) {
  for (const auto& [like, program] : {std::pair(kGzip, "gzip"), std::pair(kZstd, "zstd")}) {
    SCOPED_TRACE(program);
    const DeckFolder folder;
    // Neither name tells that it is packed; two members, as appending makes them.
    const std::string main = packed(kMain.substr(0, 40), like) + packed(kMain.substr(40), like);
    const std::string rest = packed(kRest, like);
    folder.write("rest.inp", rest);
    const auto opened = deck::open(folder.write("deck.inp", main));
    ASSERT_OPENED(opened);
    EXPECT_EQ(opened->model.shell_count(), 1u);
    EXPECT_EQ(opened->deck->files[0].bytes.text(), kMain);

    ASSERT_TRUE(save(*opened->deck, opened->model, opened->model, folder / "same/deck.inp"));
    EXPECT_EQ(content(folder / "same/deck.inp"), main);
    EXPECT_EQ(content(folder / "same/rest.inp"), rest);

    // A changed include is packed again; the main file, unchanged, isn't.
    const auto saved = save(*opened->deck, opened->model, with_node_at(opened->model, 3, {1, 2.5, 0}), folder / "moved/deck.inp");
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(content(folder / "moved/deck.inp"), main);
    const std::string rest_anew = content(folder / "moved/rest.inp");
    EXPECT_EQ(packing_of(std::as_bytes(std::span(rest_anew))), packing_of(std::as_bytes(std::span(like))));
    if (const auto text = unpacked_by(program, folder / "moved/rest.inp")) {
      EXPECT_EQ(*text, "3,1.,2.5,0.\n** end\n");
    }
    const auto again = deck::open(folder / "moved/deck.inp");
    ASSERT_OPENED(again);
    EXPECT_EQ(position_of(again->model, 3), Vec3(1, 2.5, 0));
  }
}

TEST(PackedDeck, told_to_stop_while_it_is_packed_stays_as_it_was) {
  std::string comments;
  for (int i = 0; comments.size() < std::size_t{3} << 20; ++i) comments += "** " + std::to_string(i) + "\n";
  for (const std::string& like : {kGzip, kZstd}) {
    const DeckFolder folder;
    const std::string before = packed(kMain + comments, like);
    folder.write("rest.inp", "*NODE\n3,1.,1.,0.\n");
    const auto opened = deck::open(folder.write("deck.inp", before));
    ASSERT_OPENED(opened);
    const Model model = with_node_at(opened->model, 2, {1, 2.5, 0});
    for (std::size_t stop = 0;; ++stop) {
      std::size_t asked = 0;
      const auto saved = save(*opened->deck, opened->model, model, folder / "deck.inp", [&](double) { return asked++ < stop; });
      if (saved) break;
      EXPECT_EQ(saved.error().message, cancelled().message);
      EXPECT_TRUE(content(folder / "deck.inp") == before);
    }
    EXPECT_TRUE(content(folder / "deck.inp") != before);
  }
}

TEST(PackedDeck, is_saved_in_place_only_over_what_was_read) {
  for (const std::string& like : {kGzip, kZstd}) {
    const DeckFolder folder;
    folder.write("rest.inp", kRest);
    const fs::path path = folder.write("deck.inp", packed(kMain, like));
    const auto opened = deck::open(path);
    ASSERT_OPENED(opened);
    const Model once = with_node_at(opened->model, 2, {5, 0, 0});
    ASSERT_TRUE(save(*opened->deck, opened->model, once, path));
    const Model twice = with_node_at(opened->model, 2, {7, 0, 0});
    ASSERT_TRUE(save(*opened->deck, opened->model, twice, path)) << "its own saving isn't a change by others";
    const auto again = deck::open(path);
    ASSERT_OPENED(again);
    EXPECT_EQ(position_of(again->model, 2), Vec3(7, 0, 0));
    // Back to what was read: the very bytes.
    ASSERT_TRUE(save(*opened->deck, opened->model, opened->model, path));
    EXPECT_EQ(content(path), packed(kMain, like));
    folder.write("deck.inp", packed(kMain + "** by another\n", like));
    const auto refused = save(*opened->deck, opened->model, once, path);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("has changed on disk"), std::string::npos);
  }
}

TEST(PackedDeck, that_is_damaged_is_refused_by_name) {
  const DeckFolder folder;
  for (const std::string& like : {kGzip, kZstd}) {
    const std::string whole = packed(kMain, like);
    const fs::path path = folder.write("deck.inp", whole.substr(0, whole.size() - 9));
    const auto opened = deck::open(path);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().file, path.string());
    EXPECT_NE(opened.error().message.find("is cut off"), std::string::npos) << opened.error().message;
    // As an include it is missing, with the reason.
    folder.write("rest.inp", whole.substr(0, whole.size() - 9));
    const auto rest = deck::open(folder.write("main.inp", kMain));
    ASSERT_OPENED(rest);
    EXPECT_NE(warning(*rest->deck, "missing-include").message.find("is cut off"), std::string::npos);
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
