#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/scope.h"
#include "mesh/model/topology_change.h"
#include "mesh/select/expression.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/restructuring.h"

namespace prismesh::mesh::document {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Select, modes_combine_nodes) {
  Document document = make_sheet(4, 4);
  must_apply(document, R"({"edit":"select","expr":"1-5"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 3, 4, 5));
  must_apply(document, R"({"edit":"select","expr":"7","mode":"add"})");
  must_apply(document, R"({"edit":"select","expr":"2-3","mode":"subtract"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 4, 5, 7));
  must_apply(document, R"({"edit":"select","expr":"4-10","mode":"intersect"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(4, 5, 7));
  EXPECT_EQ(document.current().selected_nodes, 3u);
  must_apply(document, R"({"edit":"select","expr":"9"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(9));
}

TEST(Select, an_element_of_any_class_names_its_part) {
  Document document = make_document(make_assembly());
  const auto chosen = [&](const std::string& expression) {
    must_apply(document, R"({"edit":"select","kind":"part","expr":")" + expression + "\"}");
    std::vector<std::int64_t> ids;
    for (std::size_t s = 0; s < document.current().model.parts->size(); ++s)
      if (const Result<select::Chosen> parts = select::evaluate(document.current().model, expression, select::EntityKind::part); parts)
        for (const PartIndex part : parts->parts)
          if (part.value == s) ids.push_back((*document.current().model.parts)[s].id);
    return ids;
  };
  EXPECT_THAT(chosen("beam:9"), ElementsAre(3));
  EXPECT_THAT(chosen("solid:1"), ElementsAre(4));
  EXPECT_THAT(chosen("shell:1,shell:8"), ElementsAre(1, 2));
}

TEST(Scopes, of_all_leave_out_what_was_removed) {
  const Folder folder;
  Document document = open_text(folder / "sheet.k", sheet_deck(4, 4));
  must_apply(document, R"({"edit":"split","at":["shell:6"]})");
  must_apply(document, R"({"edit":"merge","at":["shell:6","shell:17"]})");
  const Model& model = document.current().model;
  ASSERT_LT(live_shells(model), model.shell_count()) << "one of the triangles is gone";
  const Result<ShellSet> all = shells_in(document, Scope::all, "repair");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->size(), live_shells(model));
  for (const ShellIndex shell : *all) EXPECT_FALSE(model.is_removed(shell));
}

TEST(Select, what_names_everything_again_and_again_is_refused_where_it_is_too_much) {
  Document document = make_sheet(4, 4);
  std::string ranges = "1-25";
  for (int i = 0; i < 500'000; ++i) ranges += ",1-25";
  Select edit;
  edit.expr = ranges;
  const Result<Prepared> refused = prepare(document, edit);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().file, "expression");
  EXPECT_GT(refused.error().line, 1);
  EXPECT_THAT(refused.error().message, HasSubstr("more than 1000 times"));
}

TEST(Select, a_long_expression_stops_when_told) {
  Document document = make_sheet(4, 4);
  Select edit;
  edit.expr = "1";
  for (int i = 0; i < 100'000; ++i) edit.expr += ",2,!3";
  ASSERT_TRUE(prepare(document, edit));
  int asked = 0;
  const Result<Prepared> stopped = prepare(document, edit, [&](double) { return ++asked < 100; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "cancelled");
  EXPECT_EQ(asked, 100);
}

TEST(Select, marks_the_shells_that_are_selected_and_no_others) {
  Document document = make_document(make_assembly());
  const auto marked = [&] {
    std::vector<std::int64_t> ids;
    for (std::size_t s = 0; s < document.current().model.shell_count(); ++s)
      if ((document.current().shell_marks[s] & kSelected) != 0) ids.push_back(document.current().model.shell_ids[s]);
    return ids;
  };
  must_apply(document, R"({"edit":"select","expr":"3-5","kind":"element"})");
  EXPECT_THAT(marked(), ElementsAre(3, 4, 5));
  must_apply(document, R"({"edit":"select","expr":"5-7","kind":"element"})");
  EXPECT_THAT(marked(), ElementsAre(5, 6, 7));
  must_apply(document, R"({"edit":"select","expr":"6","kind":"element","mode":"subtract"})");
  EXPECT_THAT(marked(), ElementsAre(5, 7));
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_THAT(marked(), ElementsAre(5, 6, 7));
  must_apply(document, R"({"edit":"hide","on":"part:2"})");
  EXPECT_THAT(marked(), ElementsAre());
}

TEST(Select, elements_stay_elements_until_nodes_come) {
  Document document = make_sheet(4, 4);
  must_apply(document, R"({"edit":"select","expr":"1","kind":"element"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 6, 7));
  EXPECT_EQ(document.current().selected_shells, 1u);
  must_apply(document, R"({"edit":"select","expr":"2","kind":"element","mode":"add"})");
  EXPECT_EQ(document.current().selected_shells, 2u);
  // the border between the two stays: the shell that is left needs it
  must_apply(document, R"({"edit":"select","expr":"2","kind":"element","mode":"subtract"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 6, 7));
  must_apply(document, R"({"edit":"select","expr":"25","mode":"add"})");
  EXPECT_EQ(document.current().selection_kind, select::EntityKind::node);
  EXPECT_EQ(document.current().selected_shells, 0u);
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 6, 7, 25));
}

TEST(Select, a_part_brings_its_beams_and_solids) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"select","expr":"3","kind":"part"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(100, 900));
  must_apply(document, R"({"edit":"select","expr":"1","kind":"part","mode":"add"})");
  EXPECT_EQ(selected_ids(document).size(), 26u);
  must_apply(document, R"({"edit":"select","expr":"3","kind":"part","mode":"subtract"})");
  EXPECT_EQ(selected_ids(document).size(), 25u);  // node 100 is part 1's too
}

TEST(Select, region_stops_at_a_crease) {
  // an L: 4 columns flat, then 4 upright
  Document document = make_document(
      test::make_grid(8, 2, [](int i, int j) { return i <= 4 ? Vec3(5.0 * i, 5.0 * j, 0) : Vec3(20, 5.0 * j, 5.0 * (i - 4)); }));
  must_apply(document, R"({"edit":"select_region","at":[0,0,1]})");
  EXPECT_EQ(document.current().selected_shells, 8u);
  EXPECT_EQ(document.current().selection_kind, select::EntityKind::element);
  must_apply(document, R"({"edit":"select_region","at":9,"mode":"add"})");
  EXPECT_EQ(document.current().selected_shells, 16u);
  must_apply(document, R"({"edit":"select_region","at":1,"angle":91})");
  EXPECT_EQ(document.current().selected_shells, 16u);
  EXPECT_THAT(refusal(document, R"({"edit":"select_region","at":30})"), HasSubstr("there is no node 30; the nearest id is 27"));
}

TEST(Select, region_by_part_piece_and_free_edge) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"select_region","at":[2,2,0],"by":"part"})");
  EXPECT_EQ(document.current().selected_shells, 16u);
  must_apply(document, R"({"edit":"select_region","at":[2,2,0],"by":"part","across_welds":true})");
  EXPECT_EQ(document.current().selected_shells, 32u);
  must_apply(document, R"({"edit":"select_region","at":122,"by":"piece"})");
  EXPECT_EQ(document.current().selected_shells, 32u);
  must_apply(document, R"({"edit":"select_region","at":122,"by":"free_edge"})");
  EXPECT_EQ(document.current().selection_kind, select::EntityKind::node);
  EXPECT_EQ(selected_ids(document).size(), 24u);
  must_apply(document, R"({"edit":"hide","on":"2"})");
  must_apply(document, R"({"edit":"select_region","at":122,"by":"piece"})");
  EXPECT_EQ(document.current().selected_shells, 16u);
  EXPECT_THAT(refusal(document, R"({"edit":"select_region","at":122,"by":"free_edge","across_welds":true})"),
              HasSubstr("ends with its sheet"));
  EXPECT_THAT(refusal(document, R"({"edit":"select_region","at":118,"by":"piece"})"), HasSubstr("no shell in sight"));
  must_apply(document, R"({"edit":"hide","on":"all"})");
  EXPECT_THAT(refusal(document, R"({"edit":"select_region","at":[0,0,0]})"), HasSubstr("no shell is in sight"));
}

TEST(Select, lasso_selects_through_or_what_is_visible) {
  // a sheet of 4 x 4 shells, and a smaller one, part 2, above its middle
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i) nodes.push_back({1 + i + 5 * j, Vec3(5.0 * i, 5.0 * j, 0)});
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) shells.push_back({1 + i + 4 * j, 1, {1 + i + 5 * j, 2 + i + 5 * j, 7 + i + 5 * j, 6 + i + 5 * j}});
  for (int k = 0; k < 4; ++k) nodes.push_back({101 + k, Vec3(k == 1 || k == 2 ? 16 : 4, k > 1 ? 16 : 4, 3)});
  shells.push_back({101, 2, {101, 102, 103, 104}});
  Document document = make_document(test::make_model(nodes, shells));
  // orthographic, from above: x and y from 0..20 to -1..1, and down along z
  const std::string view = R"("view":[0.1,0,0,0, 0,0.1,0,0, 0,0,-0.1,0, -1,-1,0,1])";
  const std::string below = R"("view":[0.1,0,0,0, 0,0.1,0,0, 0,0,0.1,0, -1,-1,0,1])";
  const std::string left = R"({"edit":"select_lasso","outline":[[-2,-2],[0.1,-2],[0.1,-0.4],[-2,-0.4]],)";
  must_apply(document, left + view + "}");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 3, 6, 7, 8, 101));
  must_apply(document, left + R"("visible":true,)" + view + "}");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 3, 6, 101));
  must_apply(document, left + R"("visible":true,)" + below + "}");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 3, 6, 7, 8));
  must_apply(document, R"({"edit":"hide","on":"2"})");
  must_apply(document, left + R"("visible":true,)" + view + "}");
  EXPECT_THAT(selected_ids(document), ElementsAre(1, 2, 3, 6, 7, 8)) << "hidden parts hide nothing";
  EXPECT_THAT(refusal(document, left + R"("visible":true,"view":[0.1,0,0,0, 0,0.1,0,0, 0,0,0,0, -1,-1,0,1]})"),
              HasSubstr("the view keeps no depth"));
}

TEST(Select, grow_shrink_invert) {
  Document document = make_sheet(4, 4);
  EXPECT_THAT(refusal(document, R"({"edit":"grow"})"), HasSubstr("nothing is selected"));
  must_apply(document, R"({"edit":"select","expr":"13"})");
  must_apply(document, R"({"edit":"grow"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(7, 8, 9, 12, 13, 14, 17, 18, 19));
  must_apply(document, R"({"edit":"shrink"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(13));
  must_apply(document, R"({"edit":"grow","rings":9})");
  EXPECT_EQ(selected_ids(document).size(), 25u);
  must_apply(document, R"({"edit":"invert"})");
  EXPECT_THAT(selected_ids(document), IsEmpty());
  must_apply(document, R"({"edit":"select","expr":"6","kind":"element"})");
  must_apply(document, R"({"edit":"invert"})");
  EXPECT_EQ(document.current().selected_shells, 15u);
  EXPECT_EQ(selected_ids(document).size(), 25u);  // its corners all belong to others too
  must_apply(document, R"({"edit":"invert"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(7, 8, 12, 13));
}

TEST(Select, says_when_nothing_is_selected_now) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{R"({"edit":"select","expr":"1-5"})"}, R"({"edit":"select","expr":"1-9","mode":"subtract"})"},
      {{R"({"edit":"select","expr":"1-5"})"}, R"({"edit":"select","expr":"6-9","mode":"intersect"})"},
      {{R"({"edit":"select","expr":"13"})"}, R"({"edit":"shrink"})"},
      {{R"({"edit":"select","expr":"6","kind":"element"})"}, R"({"edit":"shrink"})"},
      {{R"({"edit":"select","expr":"all"})"}, R"({"edit":"invert"})"},
      {{R"({"edit":"select","expr":"1","kind":"part"})"}, R"({"edit":"invert"})"},
  };
  for (const auto& [first, last] : cases) {
    Document document = make_sheet(4, 4);
    for (const std::string& edit : first) EXPECT_THAT(must_apply(document, edit).notes, IsEmpty()) << edit;
    EXPECT_THAT(must_apply(document, last).notes, ElementsAre("nothing is selected now")) << last;
    EXPECT_EQ(document.current().selected_nodes, 0u);
    EXPECT_EQ(document.current().selected_shells, 0u);
  }
}

TEST(Select, a_closed_sheet_has_no_free_edge_and_an_empty_deck_no_place) {
  std::vector<test::NodeSpec> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({1 + i, Vec3(5.0 * (i & 1), 5.0 * (i >> 1 & 1), 5.0 * (i >> 2))});
  Document box = make_document(test::make_model(corners, {{1, 1, {1, 3, 4, 2}},
                                                          {2, 1, {5, 6, 8, 7}},
                                                          {3, 1, {1, 2, 6, 5}},
                                                          {4, 1, {3, 7, 8, 4}},
                                                          {5, 1, {1, 5, 7, 3}},
                                                          {6, 1, {2, 4, 8, 6}}}));
  EXPECT_EQ(refusal(box, R"({"edit":"select_region","at":8,"by":"free_edge"})"), "the sheet at shell 2 has no free edge in sight");
  EXPECT_EQ(box.generations.size(), 1u);
  Document empty = make_document(test::make_model({}, {}));
  EXPECT_EQ(refusal(empty, R"({"edit":"select_region","at":1})"), "the model has no nodes");
  EXPECT_EQ(refusal(empty, R"({"edit":"select_region","at":[0,0,0]})"), "no shell is in sight, so there is no region");
}

TEST(Select, a_recipe_that_finds_nothing_is_refused_as_the_selection_is) {
  Document document = make_sheet(4, 4);
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1,"on":{"edit":"select_region","at":99}})"),
              HasSubstr("there is no node 99; the nearest id is 25"));
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1,"on":{"edit":"select","expr":"99"}})"), HasSubstr("no node 99"));
  must_apply(document, R"({"edit":"hide","on":"all"})");
  EXPECT_EQ(refusal(document, R"({"edit":"lift","distance":1,"on":{"edit":"select_region","at":[0,0,0]}})"),
            "no shell is in sight, so there is no region");
}

TEST(Select, hidden_parts_are_left_alone_unless_named) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"hide","on":"2,4"})");
  must_apply(document, R"({"edit":"select_region","at":100})");
  EXPECT_EQ(document.current().selected_shells, 16u);
  must_apply(document, R"({"edit":"grow","rings":3})");
  EXPECT_EQ(document.current().selected_shells, 16u);
  must_apply(document, R"({"edit":"select","expr":"100"})");
  must_apply(document, R"({"edit":"grow","rings":9})");
  EXPECT_EQ(selected_ids(document).size(), 25u);
  must_apply(document, R"({"edit":"select","expr":"118"})");  // by id, on purpose
  EXPECT_THAT(selected_ids(document), ElementsAre(118));
  EXPECT_THAT(refusal(document, R"({"edit":"select_region","at":118})"), HasSubstr("no shell in sight"));
}

TEST(Select, a_bad_expression_names_its_column) {
  Document document = make_sheet(2, 2);
  EXPECT_THAT(refusal(document, R"({"edit":"select","expr":"1,99"})"), testing::StartsWith("expression:3: "));
  EXPECT_EQ(document.generations.size(), 1u);
}

TEST(Select, shares_every_chunk_it_does_not_touch) {
  Document document = make_sheet(200, 200);
  const auto untouched = document.current().model.positions.chunk_owner(0);
  must_apply(document, R"({"edit":"select","expr":"1-10"})");
  const Generation& before = *document.generations[0];
  const Generation& after = document.current();
  EXPECT_EQ(after.model.positions.chunk_owner(0), untouched);
  std::size_t own = 0;
  for (std::size_t c = 0; c < after.node_marks.chunk_count(); ++c) own += after.node_marks.shares_chunk(before.node_marks, c) ? 0 : 1;
  EXPECT_EQ(own, 1u);
  EXPECT_TRUE(after.quality.shares_chunk(before.quality, 0));
  // selecting what is selected already changes no chunk at all
  must_apply(document, R"({"edit":"select","expr":"1-10"})");
  EXPECT_TRUE(document.current().node_marks.shares_chunk(after.node_marks, 0));
}

}  // namespace
}  // namespace prismesh::mesh::document
