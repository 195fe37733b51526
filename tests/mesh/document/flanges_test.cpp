// select_flange selects the shells of flanges, and so do recipes.
#include "mesh/document/flanges.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/journal.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Three sheets of `size`, 60 wide and 100 long along x, of parts 1, 2 and 3: the second laps the first by 20 and the third the second;
/// their z are 0, 1.5 and 3. Node ids start at 1000 a part and shell ids at 100, row by row along x.
Model three_lapped(double size = 5, double thickness = 1.5) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const int columns = static_cast<int>(100 / size), rows = static_cast<int>(60 / size);
  for (int sheet = 0; sheet < 3; ++sheet) {
    const std::int64_t first = 1000 * (sheet + 1);
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i)
        nodes.push_back({first + i + (columns + 1) * j, Vec3(size * i, 40.0 * sheet + size * j, 1.5 * sheet)});
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const std::int64_t corner = first + i + (columns + 1) * j;
        shells.push_back({first + i + columns * j, sheet + 1, {corner, corner + 1, corner + columns + 2, corner + columns + 1}});
      }
  }
  return test::with_thickness(test::make_model(nodes, shells), thickness);
}

/// The y of the selected nodes: of the first flange 40 to 60, of the second 80 to 100.
std::set<double> selected_y(const Document& document) {
  std::set<double> y;
  for (const std::int64_t id : selected_ids(document)) y.insert(place_of(document, id).y());
  return y;
}
using Ys = std::set<double>;
const Ys kFirst{40, 45, 50, 55, 60}, kSecond{80, 85, 90, 95, 100};

TEST(SelectFlange, at_a_node_or_a_point_of_any_of_its_sheets) {
  Document document = make_document(three_lapped());
  const std::int64_t on_first = 1000 + 3 + 21 * 10, on_second = 2000 + 3 + 21 * 2;  // both at y = 50
  for (const std::string& at :
       {std::to_string(on_first), std::to_string(on_second), std::string("[15, 50, 0.1]"), std::string("[15,49,1.4]")}) {
    must_apply(document, R"({"edit":"select_flange","at":)" + at + "}");
    EXPECT_EQ(selected_y(document), kFirst) << at;
    EXPECT_EQ(document.current().selected_nodes, 2u * 5 * 21) << "of both sheets";
    EXPECT_EQ(document.current().selected_shells, 2u * 4 * 20);
  }
  must_apply(document, R"({"edit":"select_flange","at":[50,90,3]})");
  EXPECT_EQ(selected_y(document), kSecond);
  must_apply(document, R"({"edit":"select_flange","at":[50,50,0],"mode":"add"})");
  EXPECT_EQ(selected_y(document).size(), 10u);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(selected_y(document), kSecond);
}

TEST(SelectFlange, all_between_parts) {
  Document document = make_document(three_lapped());
  must_apply(document, R"({"edit":"select_flange","between":"1,2"})");
  EXPECT_EQ(selected_y(document), kFirst);
  must_apply(document, R"({"edit":"select_flange","between":"part:2-3"})");
  EXPECT_EQ(selected_y(document), kSecond);
  must_apply(document, R"({"edit":"select_flange","between":"all"})");
  EXPECT_EQ(selected_y(document).size(), 10u);
}

TEST(SelectFlange, as_far_as_it_is_told) {
  Document document = make_document(three_lapped(5, 0));
  EXPECT_EQ(
      refusal(document, R"({"edit":"select_flange","at":[50,50,0]})"),
      "select_flange: there is no flange at (50, 50, 0), nor anywhere else in sight; 3 parts have no thickness, so that \"gap\" must say "
      "how far apart sheets may be");
  EXPECT_THAT(refusal(document, R"({"edit":"select_flange","between":"1,2"})"), HasSubstr("; part:1 has no thickness, so that \"gap\""));
  must_apply(document, R"({"edit":"select_flange","at":[50,50,0],"gap":1.6,"max_width":20.5})");
  EXPECT_EQ(selected_y(document), kFirst);
  EXPECT_THAT(refusal(document, R"({"edit":"select_flange","at":[50,50,0],"gap":1.6,"max_width":19})"), HasSubstr("there is no flange"));
}

TEST(SelectFlange, is_refused_where_there_is_none) {
  Document document = make_document(three_lapped());
  EXPECT_EQ(refusal(document, R"({"edit":"select_flange"})"),
            "select_flange needs either \"at\", a place on the flange, or \"between\", the parts whose flanges it selects");
  EXPECT_THAT(refusal(document, R"({"edit":"select_flange","at":1000,"between":"1,2"})"), HasSubstr("; both are given"));
  EXPECT_EQ(refusal(document, R"({"edit":"select_flange","at":1003})"),
            "select_flange: there is no flange at node 1003; the nearest is 40 away, of part:1 and part:2");
  EXPECT_EQ(refusal(document, R"({"edit":"select_flange","at":999})"), "select_flange: there is no node 999; the nearest id is 1000");
  EXPECT_EQ(refusal(document, R"({"edit":"select_flange","between":"1,3"})"),
            "select_flange: no flange in sight has two sheets of \"1,3\"");
  EXPECT_THAT(refusal(document, R"({"edit":"select_flange","between":"7"})"), HasSubstr("part 7"));
  must_apply(document, R"({"edit":"hide","on":"2"})");
  EXPECT_THAT(refusal(document, R"({"edit":"select_flange","at":[50,50,0]})"), HasSubstr("nor anywhere else in sight"));
  EXPECT_THAT(refusal(document, R"({"edit":"select_flange","at":2003})"), HasSubstr("no shell is in sight at node 2003"));
  EXPECT_THAT(selected_ids(document), IsEmpty());
}

TEST(SelectFlange, is_a_recipe_that_finds_the_same_flange_on_a_variant) {
  const std::string lift =
      R"({"edit":"translate","by":[0,0,2],"on":{"edit":"select_flange","at":[50,50,0]},"falloff":{"profile":"constant"}})";
  for (const double size : {5.0, 4.0}) {
    Document document = make_document(three_lapped(size));
    JournalIntents intents;
    intents.edits = {edit_of(R"({"edit":"select_flange","at":[50,90,3]})"), edit_of(lift)};
    const std::vector<ReplayStep> steps = replay(document, intents);
    for (const ReplayStep& step : steps) EXPECT_TRUE(step.applied) << step.message;
    Ys moved;
    for (const NodeIndex node : moved_nodes(document.opened->model, document.current().model))
      moved.insert(document.opened->model.position(node).y());
    ASSERT_FALSE(moved.empty()) << size;
    EXPECT_EQ(*moved.begin(), 40) << size;
    EXPECT_EQ(*moved.rbegin(), 60) << size;
    EXPECT_EQ(*selected_y(document).begin(), 80) << "the recipe leaves the selection as it is";
  }
}

TEST(Flanges, of_chosen_shells_and_stopped_when_told) {
  const Document document = make_document(three_lapped());
  EXPECT_EQ(find_flanges(document.current(), {})->all.size(), 2u);
  EXPECT_EQ(find_flanges(document.current(), {"part:3"})->all.size(), 1u);
  EXPECT_TRUE(find_flanges(document.current(), {"shell:1000"})->all.empty());
  EXPECT_FALSE(find_flanges(document.current(), {"shell:1"}));
  const auto stopped = find_flanges(document.current(), {}, [](double) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::cancelled);
}

}  // namespace
}  // namespace prismesh::mesh::document
