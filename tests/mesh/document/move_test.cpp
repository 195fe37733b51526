#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "mesh/document/drag.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Move, constant_moves_all_by_the_same) {
  Document document = make_sheet(4, 4);
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[1,-2,3],"on":"1-25","falloff":{"profile":"constant"}})");
  EXPECT_EQ(report.nodes_moved, 25u);
  for (int i = 0; i < 25; ++i) EXPECT_EQ(document.current().model.positions[i], document.opened->model.positions[i] + Vec3(1, -2, 3));
}

TEST(Move, free_end_stretches_evenly) {
  // dragging the free edge of a strip stretches it in proportion: 0 at the rim, the whole at the edge
  Document document = make_sheet(8, 2);
  must_apply(document, R"({"edit":"select","expr":"3-9,12-18,21-27"})");
  must_apply(document, R"({"edit":"translate","by":[6,0,0],"grab":18,"falloff":{"profile":"linear"}})");
  for (int j = 0; j < 3; ++j)
    for (int i = 2; i <= 8; ++i) {
      const std::int64_t id = 1 + i + 9 * j;
      EXPECT_NEAR(place_of(document, id).x(), 5.0 * i + (i - 2.0), 1e-9) << id;
    }
}

TEST(Move, lift_goes_along_the_normal) {
  Document document = make_sheet(6, 6);
  must_apply(document, R"({"edit":"lift","distance":2,"on":"1-49","grab":25,"free_ends":false})");
  EXPECT_NEAR(std::abs(place_of(document, 25).z()), 2, 1e-12);
  EXPECT_EQ(place_of(document, 1).z(), 0);
  EXPECT_GT(std::abs(place_of(document, 24).z()), 0);
  EXPECT_LT(std::abs(place_of(document, 24).z()), 2);
}

TEST(Move, max_move_holds_back) {
  Document document = make_sheet(4, 4);
  const EditReport report =
      must_apply(document, R"({"edit":"translate","by":[3,0,4],"on":"1-25","max_move":2.5,"falloff":{"profile":"constant"}})");
  EXPECT_THAT(report.notes, Contains("25 nodes held back by max_move"));
  EXPECT_LT((place_of(document, 1) - Vec3(1.5, 0, 2)).norm(), 1e-12);
}

TEST(Move, says_what_moves_along) {
  Document document = make_document(make_assembly());
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"100,148","falloff":{"profile":"constant"}})");
  EXPECT_THAT(report.notes, Contains("1 beam moved along at shared nodes"));
  EXPECT_THAT(report.notes, Contains("1 solid moved along at shared nodes"));
}

TEST(Move, names_springs_and_others_as_elements) {
  const std::vector<test::NodeSpec> nodes{
      {1, Vec3(0, 0, 0)}, {2, Vec3(5, 0, 0)}, {3, Vec3(5, 5, 0)}, {4, Vec3(0, 5, 0)}, {5, Vec3(0, 0, 9)}};
  Document document = make_document(
      test::make_model(nodes, {{1, 1, {1, 2, 3, 4}}}, {{ElementClass::discrete, 1, 2, {1, 5}}, {ElementClass::other, 2, 2, {1, 5}}}));
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"1","falloff":{"profile":"constant"}})");
  EXPECT_THAT(report.notes, Contains("1 discrete element moved along at shared nodes"));
  EXPECT_THAT(report.notes, Contains("1 other element moved along at shared nodes"));
}

TEST(Move, says_what_it_cant_reach) {
  Document document = make_sheet(10, 2);
  // two islands of the sheet; the grab is on the first
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"1-3,12-14,9-11,20-22","grab":1})");
  EXPECT_THAT(report.notes, Contains(HasSubstr("6 nodes can't be reached from the grab")));
  EXPECT_EQ(place_of(document, 11), Vec3(50, 0, 0));
}

TEST(Move, counts_follow) {
  Document document = make_sheet(4, 4);
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,9],"on":"13"})");
  EXPECT_EQ(report.before.fail, 0u);
  EXPECT_EQ(report.after, document.current().counts);
  EXPECT_EQ(report.after.fail, 4u);
  EXPECT_EQ(quality::count(document.current().quality), document.current().counts);
  EXPECT_TRUE(same_bytes(document.current().quality, quality::judge_model(document.current().model, judged_by(document))));
}

TEST(Move, held_nodes_refuse) {
  Model model = test::make_grid(4, 4, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  model.node_holds.set(6, kHeldByParameter);
  model.node_holds.set(7, kHeldByInclude);
  model.node_holds.set(8, kHeldByMissing);
  Document document = make_document(std::move(model));
  EXPECT_EQ(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"1-25","falloff":{"profile":"constant"}})"),
            "node 7 can't be moved: it has coordinates given by a parameter (3 such nodes in all); deselect it");
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1,"on":"9"})"), HasSubstr("also names a node that isn't defined"));
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1,"on":"8"})"), HasSubstr("used more than once"));
}

TEST(Move, refuses_what_makes_no_sense) {
  Document document = make_document(make_assembly());
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1})"), HasSubstr("nothing is selected"));
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1,"on":"100-102","grab":148})"),
              HasSubstr("the grabbed node 148 isn't among"));
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1,"on":"100-102","grab":5})"), HasSubstr("there is no node 5"));
  EXPECT_THAT(refusal(document, R"({"edit":"lift","distance":1,"on":"900"})"), HasSubstr("no shell touches the grabbed node 900"));
  EXPECT_EQ(document.generations.size(), 1u);
}

TEST(Move, grab_by_coordinates_is_the_nearest_node_acted_on) {
  Document by_id = make_sheet(6, 6);
  Document by_place = make_sheet(6, 6);
  must_apply(by_id, R"({"edit":"translate","by":[0,0,1],"on":"1-49","grab":25,"free_ends":false})");
  must_apply(by_place, R"({"edit":"translate","by":[0,0,1],"on":"1-49","grab":[15.1,14.8,3],"free_ends":false})");
  expect_same(by_id.current(), by_place.current());
  // each coordinate counts
  Document aside = make_sheet(6, 6), aside_by_place = make_sheet(6, 6);
  must_apply(aside, R"({"edit":"translate","by":[0,0,1],"on":"1-49","grab":13,"free_ends":false})");
  must_apply(aside_by_place, R"({"edit":"translate","by":[0,0,1],"on":"1-49","grab":[25.1,4.9,0.4],"free_ends":false})");
  expect_same(aside.current(), aside_by_place.current());
  // an id that is not there falls back on the place
  Document by_both = make_sheet(6, 6);
  must_apply(by_both, R"({"edit":"translate","by":[0,0,1],"on":"1-49","grab":4711,"grab_at":[15,15,0],"free_ends":false})");
  expect_same(by_id.current(), by_both.current());
}

TEST(Move, a_recipe_acts_without_selecting) {
  Document document = make_document(make_assembly());
  must_apply(document,
             R"({"edit":"translate","by":[0,0,1],"on":{"edit":"select","expr":"1","kind":"part"},"falloff":{"profile":"constant"}})");
  EXPECT_TRUE(selected_ids(document).empty());
  EXPECT_EQ(place_of(document, 104).z(), 1);
  EXPECT_EQ(place_of(document, 105).z(), 0);
}

TEST(Move, midside_nodes_follow_their_edge) {
  Model model = test::make_grid(2, 1, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  // two 8-node shells: the middles stand behind the corners as nodes that no adjacency knows
  std::vector<test::NodeSpec> nodes;
  for (std::size_t n = 0; n < model.node_count(); ++n) nodes.push_back({model.node_ids[n], model.positions[n]});
  nodes.push_back({50, Vec3(7.5, 0, 0)});
  nodes.push_back({51, Vec3(10, 2.5, 0)});
  model = test::make_model(nodes, {{1, 1, {1, 2, 5, 4}}, {2, 1, {2, 3, 6, 5}}});
  MidsideNodes middle;
  middle.shell = ShellIndex(std::size_t{1});
  middle.node[0] = model.find_node(50);
  middle.node[1] = model.find_node(51);
  model.midside = std::make_shared<std::vector<MidsideNodes>>(std::vector<MidsideNodes>{middle});
  Document document = make_document(std::move(model));
  must_apply(
      document,
      R"({"edit":"translate","by":[4,0,0],"on":{"edit":"select","expr":"2","kind":"element"},"grab":3,"falloff":{"profile":"linear"}})");
  EXPECT_EQ(place_of(document, 2).x(), 5);
  EXPECT_EQ(place_of(document, 3).x(), 14);
  EXPECT_EQ(place_of(document, 50).x(), 9.5);
  EXPECT_EQ(place_of(document, 51).x(), 14);
  // A corner alone takes them along too.
  must_apply(document, R"({"edit":"translate","by":[0,0,3],"on":"3","falloff":{"profile":"constant"}})");
  EXPECT_EQ(place_of(document, 3).z(), 3);
  EXPECT_EQ(place_of(document, 50).z(), 1.5);
  EXPECT_EQ(place_of(document, 51).z(), 1.5);
  EXPECT_EQ(place_of(document, 2).z(), 0);
}

TEST(Move, only_touched_chunks_are_copied) {
  Document document = make_sheet(200, 200);
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"20000-20050","falloff":{"profile":"constant"}})");
  const Generation& before = *document.generations[0];
  const Generation& after = document.current();
  std::size_t own = 0;
  for (std::size_t c = 0; c < after.model.positions.chunk_count(); ++c)
    own += after.model.positions.shares_chunk(before.model.positions, c) ? 0 : 1;
  EXPECT_EQ(own, 1u);
  EXPECT_LT(after.own_bytes, std::size_t{200'000});
  EXPECT_TRUE(after.node_marks.shares_chunk(before.node_marks, 4));
}

/// A sheet that isn't flat, so that no arithmetic is trivial.
Document make_wavy(int size) {
  return make_document(test::make_grid(size, size, [](int i, int j) {
    return Vec3(5.0 * i + 0.1 * ((i * 7 + j * 3) % 5), 5.0 * j + 0.1 * ((i * 5 + j) % 7), 0.02 * ((i * 11 + j * 13) % 17));
  }));
}

const std::vector<std::string> kShapingSession{
    R"({"edit":"select_region","at":3000,"angle":60})",
    R"({"edit":"lift","distance":3.7,"normals":"each","falloff":{"profile":"gaussian","flat":0.2}})",
    R"({"edit":"select","expr":"1000-5000"})",
    R"({"edit":"translate","by":[0.3,1.7,-2.9],"max_move":2})",
    R"({"edit":"lock","on":"1"})",
    R"({"edit":"unlock"})",
    R"({"edit":"translate","by":[1,0,0],"on":"200-7000","origin":"free_edge","falloff":{"profile":"sharp","along":[0,1,0]}})",
};

TEST(Move, the_same_bytes_whatever_the_number_of_threads) {
  Document alone = make_wavy(90);
  Document together = make_wavy(90);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    for (const std::string& edit : kShapingSession) must_apply(alone, edit);
  }
  {
    const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 8);
    for (const std::string& edit : kShapingSession) must_apply(together, edit);
  }
  expect_same(alone, together);
}

TEST(Drag, shows_bit_for_bit_what_the_edit_will_do) {
  for (const char* text : {R"({"edit":"translate","by":[0,0,0],"on":"1000-5000","max_move":20})",
                           R"({"edit":"lift","distance":0,"on":"1000-5000","grab":[200,190,3],"falloff":{"profile":"root"}})",
                           R"({"edit":"lift","distance":0,"on":"1-8281","normals":"each","free_ends":false})"}) {
    Document document = make_wavy(90);
    Result<Drag> drag = Drag::begin(document.generations[document.cursor], edit_of(text));
    ASSERT_TRUE(drag) << drag.error().text();
    EXPECT_EQ(drag->counts(), document.current().counts);
    for (const double size : {50.5, -72.25, 31.1}) {
      drag->step({Vec3(0.1 * size, -size, 0.7 * size), size, size});
      Document after = document;
      const Result<EditReport> report = try_apply(after, parse_edit(edit_to_json(drag->edit()).dump()).value());
      ASSERT_TRUE(report) << report.error().text();
      const Generation& generation = after.current();
      for (std::size_t i = 0; i < drag->nodes().size(); ++i)
        ASSERT_EQ(std::memcmp(&drag->positions()[i], &generation.model.position(drag->nodes()[i]), sizeof(Vec3)), 0);
      for (std::size_t i = 0; i < drag->shells().size(); ++i) ASSERT_EQ(drag->states()[i], generation.quality[drag->shells()[i].value]);
      EXPECT_EQ(drag->counts(), generation.counts);
      EXPECT_NE(drag->counts(), document.current().counts);
      for (const NodeIndex moved : moved_nodes(document.current().model, generation.model))
        ASSERT_TRUE(std::binary_search(drag->nodes().begin(), drag->nodes().end(), moved));
    }
  }
}

TEST(Drag, judges_a_triangle_whose_third_corner_stays_as_a_triangle) {
  // nearly equilateral: fine as a triangle, but its angle of 180 degrees would fail in a quad
  const Model model = test::make_shells({{0, 0, 0}, {5, 0, 0}, {2.5, 4.5, 0}}, {{0, 1, 2, 2}});
  Document document = make_document(model);
  Result<Drag> drag = Drag::begin(document.generations[0], edit_of(R"({"edit":"translate","by":[0,0,0],"on":"1-2"})"));
  ASSERT_TRUE(drag) << drag.error().text();
  drag->step({Vec3(0, -0.1, 0), 0, 0});
  ASSERT_EQ(drag->states().size(), 1u);
  EXPECT_EQ(drag->states()[0].grade(), quality::Grade::ok);
  EXPECT_EQ(drag->counts().ok, 1u);
}

TEST(Drag, nothing_is_kept) {
  Document document = make_sheet(6, 6);
  const std::shared_ptr<const Generation> before = document.generations[0];
  Result<Drag> drag = Drag::begin(before, edit_of(R"({"edit":"lift","distance":9,"on":"1-49","grab":25,"free_ends":false})"));
  ASSERT_TRUE(drag);
  EXPECT_EQ(std::abs(drag->normal().z()), 1);
  EXPECT_EQ(document.current().model.node_ids[drag->grab().value], 25);
  drag->step({Vec3::Zero(), 4, 0});
  EXPECT_EQ(document.current().model.positions[24].z(), 0);
  drag->step({Vec3::Zero(), 0, 0});
  EXPECT_EQ(drag->positions()[0], before->model.position(drag->nodes()[0]));
}

TEST(Drag, refuses_as_the_edit_does) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"lock","on":"1"})");
  const auto refuse = [&](const char* text) {
    const Result<Drag> drag = Drag::begin(document.generations[1], edit_of(text));
    return drag ? "" : drag.error().text();
  };
  EXPECT_THAT(refuse(R"({"edit":"translate","by":[0,0,1],"on":"100"})"), HasSubstr("locked part 1"));
  EXPECT_THAT(refuse(R"({"edit":"lift","distance":1})"), HasSubstr("nothing is selected"));
  EXPECT_THAT(refuse(R"({"edit":"undo"})"), HasSubstr("only shaping edits can be dragged"));
}

}  // namespace
}  // namespace prismesh::mesh::document
