// Searches after edits: each state is searched with what was kept of the one before, and from nothing. Both must say the same.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/deck/sample.h"
#include "mesh/document/contacts.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

/// All that is known of the contacts, with every digit.
std::string in_full(const Contacts& contacts) {
  std::ostringstream out;
  out << std::hexfloat;
  const auto point = [&](const Vec3& at) { out << at.x() << ' ' << at.y() << ' ' << at.z() << ' '; };
  for (const ContactRegion& region : contacts.regions) {
    out << region.kind << ' ' << region.a << ' ' << region.b << ' ' << region.length << ' ' << region.max_depth.value_or(-1) << ' '
        << region.mean_depth << ' ' << region.area << ' ' << region.worst_a << ' ' << region.worst_b << ' ' << region.joined << ' '
        << region.contact << ' ' << region.thickness_from << ' ';
    point(region.at);
    for (const auto* shells : {&region.shells_a, &region.shells_b})
      for (const ShellIndex shell : *shells) out << shell.value << ' ';
    for (const contact::CurveSegment& segment : region.curve) point(segment.from), point(segment.to);
    for (const ContactVector& vector : region.vectors) out << vector.node.value << ' ' << vector.depth << ' ', point(vector.to);
    out << '\n';
  }
  return out.str();
}

std::string searched(const Document& document, ContactSearch& search) {
  return in_full(find_contacts(document.current(), search, {}).value());
}

/// Pulls at several places, repairs, undoes and does again. Returns how often the contacts were others than before.
std::size_t expect_kept_searches_to_be_right(Document& document) {
  ContactSearch kept;
  std::size_t searches = 0, different = 0;
  std::string last = searched(document, kept);
  const auto look = [&] {
    ContactSearch from_nothing;
    const std::string now = searched(document, kept);
    EXPECT_TRUE(now == searched(document, from_nothing)) << document.current().made_by;
    ++searches;
    different += now != last ? 1 : 0;
    last = now;
  };
  const double size = document.settings.target_size;
  for (int place = 1; place <= 4; ++place) {
    const Model& model = document.current().model;
    ShellIndex shell(model.shell_count() * static_cast<std::size_t>(place) / 5);
    while (model.is_removed(shell)) shell = ShellIndex(std::size_t{shell.value} + 1);
    Translate pull;
    pull.by = Vec3(0.2, place % 2 == 0 ? 1.5 : -1.5, place % 3 == 0 ? 2 : -1) * size;
    pull.shaping.on = TargetNodes(SelectRegion{.at = NodeReference(model.node_ids[model.shell(shell).node[0].value])});
    pull.shaping.max_move = 1.5 * size;
    if (!try_apply(document, Edit(pull))) continue;  // held by the deck
    look();
    if (place == 2 && try_apply(document, edit_of(R"({"edit":"repair"})"))) look();
    must_apply(document, R"({"edit":"undo"})");
    look();
    must_apply(document, R"({"edit":"redo"})");
    look();
  }
  EXPECT_GT(searches, 2u);
  return different;
}

TEST(ContactSearch, after_edits_of_the_sample_is_that_from_nothing) {
  const Folder folder;
  ASSERT_TRUE(deck::write_sample(folder / "sample.k", 2000));
  Result<Document> document = open(folder / "sample.k", {});
  ASSERT_TRUE(document) << document.error().text();
  EXPECT_GT(expect_kept_searches_to_be_right(*document), 0u);
}

TEST(ContactSearch, after_edits_of_a_real_deck_is_that_from_nothing) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(models))
    if (entry.path().extension() == ".k") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::size_t decks = 0, different = 0;
  for (const std::filesystem::path& path : paths) {
    if (decks == 3) break;
    Result<Document> document = open(path, {});
    if (!document || document->current().model.shell_count() < 1000 || document->current().model.shell_count() > 15'000) continue;
    SCOPED_TRACE(path.string());
    ++decks;
    different += expect_kept_searches_to_be_right(*document);
  }
  if (decks == 0) GTEST_SKIP() << "no LS-DYNA deck of 1,000 to 15,000 shells";
  EXPECT_TRUE(decks == 0 || different > 0);
}

}  // namespace
}  // namespace prismesh::mesh::document
