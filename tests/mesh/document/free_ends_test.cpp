// Free endings through a document: what scripts and the kiosk get, and what they are told. The lines that tell of a pull.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mesh/document/drag.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/pull_lines.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A strip 200 long and 100 wide, of elements of 10. Its node at x, y has the id 1 + x / 10 + 21 y / 10.
Document make_strip() {
  return make_document(test::make_grid(20, 10, [](int i, int j) { return Vec3(10 * i, 10 * j, 0); }));
}

/// The nodes from x = 50 on.
constexpr const char* kFrom50 =
    R"("on":{"edit":"select","expr":"6-21,27-42,48-63,69-84,90-105,111-126,132-147,153-168,174-189,195-210,216-231"})";

std::string lift_by_10(int grab, const std::string& more = {}) {
  return std::string(R"({"edit":"lift","distance":10,"grab":)") + std::to_string(grab) + "," + kFrom50 + more + "}";
}

double height(const Document& document, int x, int y) { return std::abs(place_of(document, 1 + x / 10 + 21 * (y / 10)).z()); }

constexpr int kMiddle = 1 + 12 + 21 * 5;  ///< at x = 120, y = 50

TEST(FreeEnds, follow_a_lift_whole_and_the_report_tells) {
  Document document = make_strip();
  const EditReport report = must_apply(document, lift_by_10(kMiddle));
  for (int y = 0; y <= 100; y += 10) {
    for (int x = 120; x <= 200; x += 10) EXPECT_NEAR(height(document, x, y), 10, 1e-12);
    EXPECT_LT(height(document, 110, y), 10);
    EXPECT_EQ(height(document, 50, y), 0);
  }
  EXPECT_THAT(report.notes,
              Contains("98 nodes of a free ending moved by the whole displacement; \"free_ends\": \"weighted\" weights them by "
                       "distance"));
  Document weighted = make_strip();
  const EditReport before = must_apply(weighted, lift_by_10(kMiddle, R"(,"free_ends":"weighted")"));
  EXPECT_NEAR(height(weighted, 200, 50), 7.5, 0.5);
  EXPECT_LT(height(weighted, 200, 0), height(weighted, 200, 50));
  EXPECT_THAT(before.notes, Not(Contains(HasSubstr("free ending"))));
  Document held = make_strip();
  must_apply(held, lift_by_10(kMiddle, R"(,"free_ends":false)"));
  EXPECT_EQ(height(held, 200, 50), 0);
}

TEST(FreeEnds, say_when_they_change_nothing_by_saying_nothing) {
  Document document = make_strip();
  const EditReport report = must_apply(document, lift_by_10(1 + 20 + 21 * 5));  // the free end
  EXPECT_THAT(report.notes, Not(Contains(HasSubstr("free end"))));
  for (int x = 50; x <= 200; x += 10) EXPECT_NEAR(height(document, x, 0), height(document, x, 50), 1e-12);
}

TEST(FreeEnds, turn_rigidly_beyond_the_axis) {
  for (const int grab : {kMiddle, 1 + 20 + 21 * 5, 1 + 12 + 21 * 0}) {
    Document document = make_strip();
    must_apply(document,
               R"({"edit":"rotate","point":[120,0,0],"axis":[0,1,0],"degrees":-30,"grab":)" + std::to_string(grab) + "," + kFrom50 + "}");
    EXPECT_NEAR(height(document, 200, 50), 40, 1e-9);
    EXPECT_NEAR(height(document, 140, 0), 10, 1e-9) << "nothing bends between the axis and the end";
    EXPECT_EQ(height(document, 50, 50), 0);
  }
}

TEST(FreeEnds, of_a_drag_are_those_of_its_edit) {
  for (const char* text :
       {R"({"edit":"lift","distance":0,"grab":118,)", R"({"edit":"rotate","point":[120,0,0],"axis":[0,1,0],"degrees":0,"grab":118,)",
        R"({"edit":"translate","by":[0,0,0],"grab":13,"origin":"free_edge",)"}) {
    Document document = make_strip();
    Result<Drag> drag = Drag::begin(document.generations[0], edit_of(std::string(text) + kFrom50 + "}"));
    ASSERT_TRUE(drag) << drag.error().text();
    drag->step({Vec3(1, 2, 3), 4, 5});
    ASSERT_TRUE(try_apply(document, drag->edit()));
    for (std::size_t i = 0; i < drag->nodes().size(); ++i)
      EXPECT_EQ(document.current().model.position(drag->nodes()[i]), drag->positions()[i]);
  }
}

TEST(FreeEnds, as_origin_are_those_beyond_the_grab_or_those_asked_for) {
  const std::string origin = R"(,"origin":"free_edge","falloff":{"profile":"linear"})";
  const int grab = 1 + 12 + 21 * 8;  // at y = 80: the side y = 100 is nearest
  Document document = make_strip();
  const EditReport report = must_apply(document, lift_by_10(grab, origin));
  EXPECT_NEAR(height(document, 200, 0), 10, 1e-12);
  EXPECT_NEAR(height(document, 100, 100), 10.0 / 3, 1e-12);
  EXPECT_THAT(report.notes, Contains(HasSubstr("\"origin_at\" chooses another")));
  for (const char* at : {"223", "[90, 104, 1]", "181"}) {  // on the side, beside it, nearest to it
    Document side = make_strip();
    const EditReport asked = must_apply(side, lift_by_10(grab, origin + R"(,"origin_at":)" + at));
    EXPECT_NEAR(height(side, 100, 100), 10, 1e-12) << at;
    EXPECT_THAT(asked.notes, Not(Contains(HasSubstr("origin_at")))) << at;
  }
  Document nearest = make_strip();
  must_apply(nearest, lift_by_10(grab, origin + R"(,"free_ends":"weighted")"));
  EXPECT_NEAR(height(nearest, 100, 100), 10, 1e-12);
  EXPECT_EQ(refusal(document, lift_by_10(grab, R"(,"origin_at":223)")),
            "lift: origin_at names a free edge: it needs \"origin\": \"free_edge\"");
  EXPECT_EQ(refusal(document, lift_by_10(grab, origin + R"(,"origin_at":1)")), "origin_at: the node 1 isn't among the nodes to be moved");
  EXPECT_THAT(refusal(document, lift_by_10(grab, origin + R"(,"origin_at":4711)")), HasSubstr("origin_at: "));
  Edit broken = edit_of(lift_by_10(grab, origin));
  shaping_of(broken)->origin_at = std::array<double, 3>{0, std::numeric_limits<double>::infinity(), 0};
  const Result<EditReport> refused = try_apply(document, broken);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "lift: origin_at must be of finite numbers");
}

TEST(FreeEnds, follow_on_both_sides_of_a_plane_of_symmetry) {
  Document document = make_strip();
  must_apply(document, lift_by_10(1 + 12 + 21 * 2, R"(,"symmetry":{"point":[0,50,0],"normal":[0,1,0]})"));
  for (int y = 0; y <= 100; y += 10) {
    for (int x = 120; x <= 200; x += 10) EXPECT_NEAR(height(document, x, y), 10, 1e-12);
    EXPECT_EQ(height(document, 90, y), height(document, 90, 100 - y));
  }
}

TEST(FreeEnds, leave_a_grabbed_side_and_tell) {
  Document document = make_strip();
  const EditReport report = must_apply(document, lift_by_10(13));  // x = 120 on the side y = 0
  for (int y = 0; y <= 100; y += 10) EXPECT_NEAR(height(document, 160, y), 10, 1e-12);
  EXPECT_LT(height(document, 60, 0), 1);
  EXPECT_THAT(report.notes, Contains(HasSubstr("the free edge at node:13 begins at the rim")));
}

TEST(FreeEnds, are_told_before_the_pull) {
  Document document = make_strip();
  const auto edges = [&](const std::string& text) {
    const auto found = find_pull_lines(document.current(), edit_of(text));
    EXPECT_TRUE(found) << found.error().text();
    std::size_t at_end = 0;
    for (const auto& edge : found->followed)
      at_end += document.current().model.position(edge[0]).x() == 200 && document.current().model.position(edge[1]).x() == 200 ? 1 : 0;
    return std::pair(found->followed.size(), at_end);
  };
  EXPECT_EQ(edges(lift_by_10(kMiddle)), std::pair(std::size_t{26}, std::size_t{10})) << "both sides from 120 on, and the end";
  EXPECT_EQ(edges(lift_by_10(kMiddle, R"(,"free_ends":"weighted")")), std::pair(std::size_t{0}, std::size_t{0}));
  EXPECT_EQ(edges(lift_by_10(kMiddle, R"(,"origin":"free_edge")")), std::pair(std::size_t{10}, std::size_t{10}));
  const auto refused = find_pull_lines(document.current(), edit_of(R"({"edit":"undo"})"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("moves no nodes"));
}

TEST(PullLines, the_line_halfway_lies_where_the_weight_is_a_half) {
  Document document = make_strip();
  const auto ask = [&](const std::string& falloff) {
    return find_pull_lines(document.current(), edit_of(lift_by_10(kMiddle, R"(,"falloff":)" + falloff)));
  };
  // Along x only, the strip from 50 on rises from x = 50 to the grab at 120: half at 85 with a profile that is symmetric.
  const auto linear = ask(R"({"profile":"linear","along":[1,0,0]})");
  ASSERT_TRUE(linear) << linear.error().text();
  ASSERT_EQ(linear->halfway.size(), 10u) << "a piece for each shell across the strip";
  for (const auto& piece : linear->halfway)
    for (const Vec3& end : piece) EXPECT_NEAR(end.x(), 85, 1e-9);
  // A flat top of 40 % of the way: the weight falls from 1 at 92, so it is a half at 71.
  const auto flat = ask(R"({"profile":"linear","along":[1,0,0],"flat":0.4})");
  ASSERT_TRUE(flat) << flat.error().text();
  ASSERT_EQ(flat->halfway.size(), 10u);
  for (const auto& piece : flat->halfway)
    for (const Vec3& end : piece) EXPECT_NEAR(end.x(), 71, 1e-9);
}

TEST(PullLines, the_line_halfway_is_closed_round_a_bump) {
  Document document = make_strip();
  const auto lines = find_pull_lines(document.current(), edit_of(lift_by_10(kMiddle, R"(,"free_ends":false)")));
  ASSERT_TRUE(lines) << lines.error().text();
  ASSERT_FALSE(lines->halfway.empty());
  std::vector<Vec3> ends;
  for (const auto& piece : lines->halfway) ends.insert(ends.end(), piece.begin(), piece.end());
  for (const Vec3& end : ends)
    EXPECT_EQ(std::ranges::count_if(ends, [&](const Vec3& other) { return (other - end).norm() < 1e-9; }), 2) << "each end is met once";
}

TEST(FreeEnds, are_written_as_they_are_read) {
  const auto written = [](const std::string& value) {
    return edit_to_json(edit_of(R"({"edit":"lift","distance":1,"free_ends":)" + value + "}"))["free_ends"].dump();
  };
  EXPECT_EQ(written("true"), "true");
  EXPECT_EQ(written("\"rigid\""), "true");
  EXPECT_EQ(written("false"), "false");
  EXPECT_EQ(written("\"held\""), "false");
  EXPECT_EQ(written("\"weighted\""), "\"weighted\"");
}

}  // namespace
}  // namespace prismesh::mesh::document
