// How a drag says that it spoils elements, against composites of the model that its edit makes.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/document/drag.h"
#include "mesh/document/judging.h"
#include "mesh/quality/composite.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

const char* const kOneNode = R"({"edit":"translate","by":[0,0,0],"on":"25","free_ends":false,"falloff":{"profile":"constant"}})";
const char* const kMove = R"({"edit":"move","by":[0,0,0],"on":"1-49","grab":25,"free_ends":false,"falloff":{"profile":"linear"}})";
const char* const kMirrored =
    R"({"edit":"translate","by":[0,0,0],"on":"24","falloff":{"profile":"constant"},"free_ends":false,"symmetry":{"point":[15,0,0],"normal":[1,0,0]}})";

Drag begun(const Document& document, const std::string& edit) { return Drag::begin(document.generations[0], edit_of(edit)).value(); }

/// The worst composite of the model once the drag's edit is applied.
float worst_after(const Document& document, const Drag& drag) {
  Document after = document;
  EXPECT_TRUE(try_apply(after, drag.edit()));
  std::vector<float> composites(drag.shells().size());
  quality::composites(after.current().model, drag.shells(), sized(*after.current().judging), composites);
  return *std::min_element(composites.begin(), composites.end());
}

TEST(Worsening, a_drag_that_hasnt_moved_spoils_nothing) {
  const Document document = make_sheet(6, 6);
  Drag drag = begun(document, kOneNode);
  EXPECT_EQ(drag.worsening().badness, 0);
  drag.step({Vec3::Zero(), 0, 0});
  EXPECT_EQ(drag.worsening().badness, 0);
}

TEST(Worsening, grows_before_a_shell_fails_and_is_full_where_it_does) {
  const Document document = make_sheet(6, 6);
  Drag drag = begun(document, kOneNode);
  double last = 0;
  bool felt_before_red = false, full = false;
  for (double by = 0; by <= 5; by += 0.05) {
    drag.step({Vec3(by, 0, 0), 0, 0});
    const Worsening worsening = drag.worsening();
    EXPECT_GE(worsening.badness, last) << by;
    EXPECT_LE(worsening.badness, 1);
    EXPECT_NEAR(worsening.badness, std::clamp((0.5 - static_cast<double>(worst_after(document, drag))) / 0.5, 0.0, 1.0), 1e-6) << by;
    EXPECT_EQ(worsening.badness >= 1, drag.counts().fail > 0) << by;
    felt_before_red |= worsening.badness > 0.5 && drag.counts().fail == 0;
    full |= worsening.badness == 1;
    last = worsening.badness;
  }
  EXPECT_TRUE(felt_before_red);
  EXPECT_TRUE(full);
}

/// Nothing is as bad a way on as the given one, of ways all around.
void expect_worst_way(const Document& document, const char* edit, const Vec3& by) {
  Drag drag = begun(document, edit);
  drag.step({by, 0, 0});
  const Worsening worsening = drag.worsening();
  ASSERT_GT(worsening.badness, 0);
  ASSERT_NEAR(worsening.direction.norm(), 1, 1e-9);
  const double step = 0.02;
  const auto after = [&](const Vec3& way) {
    Drag other = begun(document, edit);
    other.step({by + step * way, 0, 0});
    return worst_after(document, other);
  };
  const float along = after(worsening.direction);
  EXPECT_LT(along, worst_after(document, drag));
  for (int k = 0; k < 60; ++k) {
    const double angle = 2.399963 * k, z = 1 - (2 * k + 1) / 60.0, r = std::sqrt(1 - z * z);
    const Vec3 way(r * std::cos(angle), r * std::sin(angle), z);
    if (way.dot(worsening.direction) < 0.9) {
      EXPECT_GT(after(way), along) << way.transpose();
    }
  }
}

TEST(Worsening, leads_the_way_on_which_the_worst_shell_gets_worse_fastest) {
  const Document document = make_sheet(6, 6);
  expect_worst_way(document, kOneNode, {2, 0.3, 0.1});
  expect_worst_way(document, kOneNode, {-0.5, 0.2, 1.5});
  expect_worst_way(document, kMove, {0.8, 10, 1});
}

TEST(Worsening, of_a_mirrored_side_is_told_by_the_hands_way) {
  Document document = make_sheet(6, 6);
  // At the image's side there is less room.
  must_apply(document, R"({"edit":"translate","by":[-1.5,0,0],"on":"27","free_ends":false,"falloff":{"profile":"constant"}})");
  document.generations[0] = document.generations[document.cursor];
  Drag drag = begun(document, kMirrored);
  drag.step({Vec3(-1.5, 0, 0), 0, 0});
  const Worsening worsening = drag.worsening();
  ASSERT_GT(worsening.badness, 0);
  Drag on = begun(document, kMirrored);
  on.step({Vec3(Vec3(-1.5, 0, 0) + 0.2 * worsening.direction), 0, 0});
  EXPECT_GT(on.worsening().badness, worsening.badness);
}

TEST(Worsening, what_was_bad_before_and_gets_no_worse_isnt_felt) {
  Document document = make_sheet(6, 6);
  must_apply(document, R"({"edit":"translate","by":[4.5,0,0],"on":"9","free_ends":false,"falloff":{"profile":"constant"}})");
  ASSERT_GT(document.current().counts.fail, 0u);
  Drag drag = Drag::begin(document.generations[document.cursor], edit_of(R"({"edit":"translate","by":[0,0,0],"on":"1-49","free_ends":false,
      "falloff":{"profile":"constant"}})"))
                  .value();
  drag.step({Vec3(0, 0, 7), 0, 0});
  EXPECT_EQ(drag.worsening().badness, 0);
}

TEST(Worsening, other_drags_have_no_direction) {
  const Document document = make_sheet(6, 6);
  Drag drag = begun(document, R"({"edit":"lift","distance":0,"on":"25","free_ends":false,"falloff":{"profile":"constant"}})");
  drag.step({Vec3::Zero(), 4, 0});
  EXPECT_GT(drag.worsening().badness, 0);
  EXPECT_EQ(drag.worsening().direction, Vec3::Zero());
}

TEST(Worsening, defects_are_full) {
  const Document document = make_sheet(6, 6);
  Drag drag = begun(document, kOneNode);
  drag.step({Vec3(5, 0, 0), 0, 0});  // onto its neighbour
  EXPECT_EQ(drag.worsening().badness, 1);
  EXPECT_TRUE(drag.worsening().direction.allFinite());
  drag.step({Vec3(1e300, 0, 0), 0, 0});
  EXPECT_LE(drag.worsening().badness, 1);
  EXPECT_TRUE(drag.worsening().direction.allFinite());
}

}  // namespace
}  // namespace prismesh::mesh::document
