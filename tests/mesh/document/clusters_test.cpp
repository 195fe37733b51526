// Clusters of triangles of a document: which edits made, which are in a repair's scope, and what reports count.
#include "mesh/document/clusters.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/damage.h"
#include "mesh/document/delta.h"
#include "mesh/document/restructure.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/restructuring.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kPlateSide = 10;
constexpr auto kRepairAll = R"({"edit":"repair","scope":"all"})";

std::int64_t plate_node(int i, int j) { return 1 + i + j * (kPlateSide + 1); }

/// A plate of 100 quads of 5 mm; those of columns and rows [3, last) are two triangles along the same diagonal.
std::string plate_deck(int last) {
  std::string text = "*NODE\n";
  for (int j = 0; j <= kPlateSide; ++j)
    for (int i = 0; i <= kPlateSide; ++i)
      text += std::to_string(plate_node(i, j)) + "," + std::to_string(5 * i) + ".," + std::to_string(5 * j) + ".,0.\n";
  text += "*ELEMENT_SHELL\n";
  int id = 0;
  const auto add = [&](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
    text += std::to_string(++id) + ",1," + std::to_string(a) + "," + std::to_string(b) + "," + std::to_string(c) + "," + std::to_string(d) +
            "\n";
  };
  for (int j = 0; j < kPlateSide; ++j)
    for (int i = 0; i < kPlateSide; ++i) {
      const std::int64_t a = plate_node(i, j), b = plate_node(i + 1, j), c = plate_node(i + 1, j + 1), d = plate_node(i, j + 1);
      if (i < 3 || j < 3 || i >= last || j >= last) {
        add(a, b, c, d);
        continue;
      }
      add(a, b, c, c);
      add(a, c, d, d);
    }
  return text + "*END\n";
}

std::size_t triangles_of_model(const Model& model) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    count += !model.is_removed(ShellIndex(s)) && model.shell(ShellIndex(s)).is_triangle() ? 1 : 0;
  return count;
}

std::string plate_split(int i, int j) {  // of plate_deck(0): a plate of quads alone
  return R"({"edit":"split","at":["shell:)" + std::to_string(1 + i + j * kPlateSide) + R"("]})";
}

/// Splits all quads of columns and rows [first, last).
void split_quads(Document& document, int first, int last) {
  for (int j = first; j < last; ++j)
    for (int i = first; i < last; ++i) must_apply(document, plate_split(i, j));
}

TEST(Clusters, of_the_deck_are_repaired_where_the_scope_has_them) {
  const Folder folder;
  const Document opened = open_text(folder / "a.k", plate_deck(7));
  ASSERT_EQ(opened.current().clusters->size(), 9u);
  Document document = opened;
  const EditReport nothing = must_apply(document, R"({"edit":"repair"})");
  EXPECT_THAT(nothing.notes, Contains("nothing to repair: no edit made an element fail or warn"));
  EXPECT_EQ(nothing.clusters_after, 9u);
  const EditReport report = must_apply(document, kRepairAll);
  EXPECT_EQ(report.clusters_before, 9u);
  EXPECT_EQ(report.clusters_after, 0u);
  EXPECT_EQ(report.after, (quality::Counts{100, 0, 0}));
  EXPECT_THAT(report.notes, Contains(HasSubstr("9 nodes with too many triangles in the scope: 16 merged")));
  EXPECT_EQ(triangles_of_model(document.current().model), 0u);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(document.current().clusters->size(), 9u);

  Document of_part = opened;
  must_apply(of_part, R"({"edit":"select","expr":"1"})");
  EXPECT_EQ(must_apply(of_part, R"({"edit":"repair","scope":"part"})").clusters_after, 0u);
  Document beside = opened;
  must_apply(beside, R"({"edit":"select","expr":"1"})");
  EXPECT_EQ(must_apply(beside, R"({"edit":"repair","scope":"selection"})").clusters_after, 9u) << "node 1 is at a corner of the plate";
  Document at = opened;
  must_apply(at, R"({"edit":"select","expr":")" + std::to_string(plate_node(5, 5)) + "\"}");
  EXPECT_LT(must_apply(at, R"({"edit":"repair","scope":"selection"})").clusters_after, 9u);
}

TEST(Clusters, of_the_deck_are_damage_where_edits_touched_them) {
  const Folder folder;
  Document document = open_text(folder / "a.k", plate_deck(7));
  must_apply(document, R"({"edit":"translate","by":[0.1,0,0],"on":")" + std::to_string(plate_node(5, 5)) + "\"}");
  EXPECT_THAT(damaged_shells(document), IsEmpty());
  for (const std::uint8_t worse : made_worse(*document.opened, document.current())) EXPECT_EQ(worse, 0) << "the deck had them";
  const ClustersInScope found = clusters_in(document, Scope::damaged, {});
  EXPECT_EQ(found.nodes.size(), 7u) << "the moved node, and those at its six triangles";
  EXPECT_EQ(must_apply(document, R"({"edit":"repair"})").clusters_after, 0u);
}

TEST(Clusters, that_edits_made_are_damage_and_are_told) {
  const Folder folder;
  Document document = open_text(folder / "a.k", plate_deck(0));
  ASSERT_EQ(document.current().clusters->size(), 0u);
  split_quads(document, 4, 6);
  const Generation& now = document.current();
  ASSERT_EQ(now.clusters->size(), 1u);
  EXPECT_EQ(now.model.node_ids[now.clusters->front().node.value], plate_node(5, 5));
  EXPECT_EQ(made_worse(*document.opened, now), std::vector<std::uint8_t>{1});
  EXPECT_EQ(clusters_in(document, Scope::damaged, {}).nodes.size(), 1u);
  EXPECT_THAT(clusters_in(document, Scope::failed, {}).nodes, IsEmpty());
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  EXPECT_EQ(report.clusters_before, 1u);
  EXPECT_EQ(report.clusters_after, 0u);
  EXPECT_EQ(report.after.fail, 0u);
}

TEST(Clusters, of_what_is_locked_stay_and_are_named) {
  const Folder folder;
  Document document = open_text(folder / "a.k", plate_deck(5));
  ASSERT_EQ(document.current().clusters->size(), 1u);
  must_apply(document, R"({"edit":"lock","on":"all"})");
  const EditReport report = must_apply(document, kRepairAll);
  EXPECT_EQ(report.clusters_after, 1u);
  EXPECT_EQ(report.elements_removed, 0u);
  EXPECT_THAT(report.notes, Contains("1 node with too many triangles stays"));
  EXPECT_THAT(report.notes,
              Contains(HasSubstr("node:" + std::to_string(plate_node(4, 4)) + ": 6 triangles; its triangles have to stay as they are")));
}

TEST(Clusters, of_a_mesh_of_triangles_are_left_alone) {
  const Folder folder;
  Document document = open_text(folder / "b.k", [] {
    std::string all = plate_deck(0);
    const std::size_t shells = all.find("*ELEMENT_SHELL\n") + 15;
    std::string made = all.substr(0, shells);
    int id = 0;
    for (int j = 0; j < kPlateSide; ++j)
      for (int i = 0; i < kPlateSide; ++i)
        for (const auto& [b, c] :
             {std::pair(plate_node(i + 1, j), plate_node(i + 1, j + 1)), {plate_node(i + 1, j + 1), plate_node(i, j + 1)}})
          made += std::to_string(++id) + ",1," + std::to_string(plate_node(i, j)) + "," + std::to_string(b) + "," + std::to_string(c) +
                  "," + std::to_string(c) + "\n";
    return made + "*END\n";
  }());
  EXPECT_TRUE(document.current().clusters->empty());
  EXPECT_EQ(must_apply(document, kRepairAll).elements_removed, 0u);
}

TEST(Clusters, come_back_with_the_journal) {
  const Folder folder;
  Document document = open_text(folder / "a.k", plate_deck(7));
  const Generation before = document.current();
  must_apply(document, kRepairAll);
  Generation again = before;
  const auto delta = encode_delta(before, document.current());
  const Result<NodeSet> moved = apply_delta(delta, again);
  ASSERT_TRUE(moved);
  settle_growth(before, *moved, again);
  EXPECT_EQ(*again.clusters, *document.current().clusters);
  EXPECT_EQ(before.clusters->size(), 9u);
}

}  // namespace
}  // namespace prismesh::mesh::document
