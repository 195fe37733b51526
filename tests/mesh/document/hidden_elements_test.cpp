// Elements that the model leaves out keep their nodes and edges; where a format numbers quads and triangles apart, both are shown.
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "mesh/select/expression.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/format_decks.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;

/// Pulls the right half of a sheet of 6 x 3 quads away by 45 mm, so that its rows must be divided, and repairs.
constexpr const char* kPull = R"({"edit":"translate","by":[45,0,0],"on":"node:4-7,11-14,18-21,25-28","falloff":{"profile":"constant"}})";
constexpr const char* kRepair = R"({"edit":"repair","scope":"all"})";

Document open_deck(const std::filesystem::path& path, const std::string& text) {
  put_content(path, text);
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 10.0;  // of all parts
  Result<Document> document = open(path, options);
  if (!document) ADD_FAILURE() << document.error().text();
  return std::move(*document);
}

std::size_t free_edges(const Model& model) {
  std::map<std::pair<NodeIndex, NodeIndex>, int> uses;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    const ShellNodes& shell = model.shell(ShellIndex(s));
    for (int c = 0; c < shell.corners(); ++c) {
      const NodeIndex a = shell.node[static_cast<std::size_t>(c)], b = shell.node[static_cast<std::size_t>((c + 1) % shell.corners())];
      ++uses[std::minmax(a, b)];
    }
  }
  return static_cast<std::size_t>(std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second == 1; }));
}

/// Edges of the hidden elements that shells of the model have, by ids.
std::set<std::pair<std::int64_t, std::int64_t>> hidden_edges(const deck::Deck& deck, const Model& model) {
  std::set<std::pair<std::int64_t, std::int64_t>> edges;
  for (std::size_t e = 0; e < deck.hidden.size(); ++e)
    for (const NodeIndex a : deck.hidden.nodes_of(e))
      for (const NodeIndex b : deck.hidden.nodes_of(e))
        if (a < b)
          for (const ShellIndex shell : model.adjacency->shells_of(a)) {
            const ShellNodes& nodes = model.shell(shell);
            for (int c = 0; c < nodes.corners(); ++c)
              if (std::minmax(nodes.node[static_cast<std::size_t>(c)], nodes.node[static_cast<std::size_t>((c + 1) % nodes.corners())]) ==
                  std::minmax(a, b))
                edges.insert(std::minmax(model.node_ids[a.value], model.node_ids[b.value]));
          }
  return edges;
}

/// Saves, opens what was saved and expects that the hidden elements are as they were.
void expect_hidden_kept(const Document& document, const std::filesystem::path& target) {
  const auto saved = save(document, target);
  ASSERT_TRUE(saved) << saved.error().text();
  const Result<deck::OpenedDeck> again = deck::open(target);
  ASSERT_TRUE(again) << again.error().text();
  for (const deck::Warning& warning : again->deck->warnings) EXPECT_NE(warning.kind, "undefined-node") << warning.message;
  ASSERT_EQ(again->deck->hidden.size(), document.deck->hidden.size());
  EXPECT_EQ(again->deck->hidden.nodes.size(), document.deck->hidden.nodes.size());
  EXPECT_EQ(hidden_edges(*again->deck, again->model), hidden_edges(*document.deck, document.opened->model));
}

TEST(HiddenElements, of_a_number_that_is_defined_again_keep_their_nodes_and_edges_in_every_format) {
  const Folder folder;
  for (std::size_t f = 0; f < kDeckNames.size(); ++f) {
    SCOPED_TRACE(kDeckNames[f]);
    WrittenMesh mesh = written_sheet(6, 3);
    mesh.shells.push_back({2, {10, 11, 18, 17}});  // stands on shell 9
    Document document = open_deck(folder / kDeckNames[f], deck_text(f, mesh));
    ASSERT_EQ(document.deck->hidden.size(), 1u);
    ASSERT_EQ(hidden_edges(*document.deck, document.opened->model).size(), 4u);
    must_apply(document, kPull);
    must_apply(document, kRepair);
    expect_hidden_kept(document, folder / (std::string("out_") + kDeckNames[f]));
  }
}

TEST(HiddenElements, with_an_undefined_node_keep_the_others_in_every_format) {
  const Folder folder;
  for (std::size_t f = 0; f < kDeckNames.size(); ++f) {
    SCOPED_TRACE(kDeckNames[f]);
    WrittenMesh mesh = written_sheet(6, 3);
    mesh.shells.push_back({90, {10, 11, 18, 999}});
    Document document = open_deck(folder / kDeckNames[f], deck_text(f, mesh));
    ASSERT_EQ(document.deck->hidden.size(), 1u);
    EXPECT_EQ(document.deck->hidden.nodes.size(), 3u);
    EXPECT_THAT(refusal(document, R"({"edit":"split","at":["shell:9"]})"), HasSubstr("split"));
    EXPECT_THAT(refusal(document, R"({"edit":"collapse","at":["node:10","node:11"]})"), HasSubstr("collapse"));
    EXPECT_THAT(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"node:11"})"), HasSubstr("node 11 can't be moved"));
  }
}

TEST(HiddenElements, nodes_with_two_cards_stay_where_they_are) {
  const Folder folder;
  for (std::size_t f = 0; f < kDeckNames.size(); ++f) {
    SCOPED_TRACE(kDeckNames[f]);
    WrittenMesh mesh = written_sheet(6, 3);
    mesh.nodes.push_back(mesh.nodes[10]);
    Document document = open_deck(folder / kDeckNames[f], deck_text(f, mesh));
    EXPECT_THAT(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"node:11"})"), HasSubstr("has two cards"));
    EXPECT_EQ(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"node:12"})"), "");
    must_apply(document, R"({"edit":"collapse","at":["node:11","node:12"]})");
    EXPECT_FALSE(document.current().model.find_node(12).valid());
    EXPECT_EQ(place_of(document, 11), Vec3(30, 10, 0));
  }
}

// --- quads and triangles numbered apart ---

/// A sheet of 6 x 3 cells; the last row's are two triangles each, numbered from 1 again.
WrittenMesh quads_and_triangles() {
  WrittenMesh mesh = written_sheet(6, 3);
  const std::vector<WrittenShell> quads(mesh.shells.begin() + 12, mesh.shells.end());
  mesh.shells.resize(12);
  int id = 0;
  for (const WrittenShell& quad : quads) {
    mesh.shells.push_back({++id, {quad.nodes[0], quad.nodes[1], quad.nodes[2]}});
    mesh.shells.push_back({++id, {quad.nodes[0], quad.nodes[2], quad.nodes[3]}});
  }
  mesh.shells.push_back({100, {mesh.shells.back().nodes[0], mesh.shells.back().nodes[1], 7}});  // has no quad of its number
  return mesh;
}

TEST(NumberedApart, quads_and_triangles_of_one_number_are_both_shown) {
  const Folder folder;
  const Document document = open_deck(folder / kDeckNames[2], deck_text(2, quads_and_triangles(),
                                                                        "/GRSHEL/SHEL/7\nquads\n         1         2\n"
                                                                        "/GRSH3N/SH3N/8\ntriangles\n         3       100\n"));
  const Model& model = document.opened->model;
  EXPECT_EQ(model.shell_count(), 25u);
  EXPECT_EQ(document.deck->hidden.size(), 0u);
  EXPECT_EQ(document.deck->shared_shell_ids.size(), 12u);
  ASSERT_NE(model.second_shells, nullptr);
  EXPECT_EQ(model.second_shells->size(), 12u);
  const auto chosen = [&](const std::string& expression) {
    const auto found = select::evaluate(model, expression, select::EntityKind::element, document.current().relations->names);
    if (!found) ADD_FAILURE() << expression << ": " << found.error().text();
    std::string out;
    if (!found) return out;
    for (const ShellIndex shell : found->shells)
      out += (model.shell(shell).is_triangle() ? " t" : " q") + std::to_string(model.shell_ids[shell.value]);
    return out;
  };
  EXPECT_EQ(chosen("shell:3"), " q3 t3");
  EXPECT_EQ(chosen("3"), " q3 t3");
  EXPECT_EQ(chosen("quad:3"), " q3");
  EXPECT_EQ(chosen("tri:3"), " t3");
  EXPECT_EQ(chosen("shell:2-6:2"), " q2 q4 q6 t2 t4 t6");
  EXPECT_EQ(chosen("tri:11-100"), " t11 t12 t100");
  EXPECT_EQ(chosen("shell:1-4,!quad:2-3"), " q1 q4 t1 t2 t3 t4");
  EXPECT_EQ(chosen("shell_set:7"), " q1 q2") << "a group of quads";
  EXPECT_EQ(chosen("shell_set:8"), " t3 t100") << "a group of triangles";
}

TEST(NumberedApart, edits_by_hand_name_one_and_leave_shared_numbers_alone) {
  const Folder folder;
  Document document = open_deck(folder / kDeckNames[2], deck_text(2, quads_and_triangles()));
  EXPECT_THAT(refusal(document, R"({"edit":"split","at":["shell:3"]})"), HasSubstr("\"quad:3\" and \"tri:3\" name one of them"));
  EXPECT_THAT(refusal(document, R"({"edit":"split","at":["tri:3"]})"), HasSubstr("two shells have this number"));
  EXPECT_THAT(refusal(document, R"({"edit":"split","at":["tri:90"]})"), HasSubstr("there is no tri 90"));
  EXPECT_EQ(refusal(document, R"({"edit":"lift","distance":3,"on":"tri:3"})"), "");
}

TEST(NumberedApart, a_pull_and_a_repair_open_no_edge_and_save_what_they_show) {
  const Folder folder;
  WrittenMesh mesh = quads_and_triangles();
  mesh.shells.pop_back();
  Document document = open_deck(folder / kDeckNames[2], deck_text(2, mesh));
  const std::size_t before = free_edges(document.opened->model);
  must_apply(document, kPull);
  must_apply(document, kRepair);
  const Model& model = document.current().model;
  EXPECT_LE(free_edges(model), before + 2 * 4) << "rows that are divided end at two free edges";
  const std::filesystem::path out = folder / "out_0000.rad";
  ASSERT_TRUE(save(document, out));
  const Result<deck::OpenedDeck> again = deck::open(out);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->model.shell_count(), live_shells(model));
  EXPECT_EQ(again->model.node_count(), live_nodes(model));
  EXPECT_EQ(free_edges(again->model), free_edges(model));
  for (const deck::Warning& warning : again->deck->warnings) EXPECT_NE(warning.kind, "undefined-node") << warning.message;
}

}  // namespace
}  // namespace prismesh::mesh::document
