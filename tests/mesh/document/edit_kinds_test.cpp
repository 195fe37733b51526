#include "mesh/document/edit_kinds.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::ElementsAre;

std::vector<std::string> names_of(EditGroup group) {
  std::vector<std::string> names;
  for (const EditKind& kind : edit_kinds())
    if (kind.group == group) names.emplace_back(kind.name);
  return names;
}

TEST(EditKinds, each_alternative_of_edit_has_a_kind_and_each_kind_its_own_name) {
  std::set<std::size_t> alternatives;
  for (const EditKind& kind : edit_kinds()) {
    alternatives.insert(kind.blank.index());
    EXPECT_EQ(&kind_of(kind.blank), &kind) << kind.name;
    EXPECT_EQ(find_edit_kind(kind.name), &kind);
    EXPECT_EQ(name(kind.blank), kind.name);
  }
  EXPECT_EQ(alternatives.size(), std::variant_size_v<Edit>);
  EXPECT_EQ(find_edit_kind("open"), nullptr);
}

TEST(EditKinds, groups_say_what_an_edit_changes) {
  EXPECT_THAT(names_of(EditGroup::selection),
              ElementsAre("grow", "invert", "select", "select_flange", "select_lasso", "select_region", "shrink"));
  EXPECT_THAT(names_of(EditGroup::parts),
              ElementsAre("hide", "lock", "only", "reverse", "set_criteria", "set_target_size", "show", "unlock"));
  EXPECT_THAT(names_of(EditGroup::shaping), ElementsAre("lift", "move", "rotate", "slide", "translate"));
  EXPECT_THAT(names_of(EditGroup::mending), ElementsAre("collapse", "merge", "relax", "repair", "split", "swap"));
  EXPECT_THAT(names_of(EditGroup::contact), ElementsAre("separate"));
  EXPECT_THAT(names_of(EditGroup::joining), ElementsAre("bond", "repair_welds", "weld"));
  EXPECT_THAT(names_of(EditGroup::exchange), ElementsAre("replace_part"));
  EXPECT_THAT(names_of(EditGroup::step), ElementsAre("branch", "redo", "undo"));
}

TEST(EditKinds, the_shaping_ones_have_a_displacement_that_can_be_set) {
  Displacement displacement;
  displacement.by = Vec3(1, 2, 3);
  displacement.distance = 4;
  displacement.degrees = 5;
  for (const EditKind& kind : edit_kinds()) {
    Edit edit = kind.blank;
    const bool shapes = kind.group == EditGroup::shaping;
    EXPECT_EQ(shaping_of(edit) != nullptr, shapes) << kind.name;
    set_displacement(edit, displacement);
    const Displacement got = displacement_of(edit);
    EXPECT_EQ(got.by == displacement.by || got.distance == 4 || got.degrees == 5, shapes) << kind.name;
  }
}

TEST(EditKinds, say_what_they_have_to_do_with_the_selection) {
  const auto use = [](const char* json) {
    const SelectionUse found = selection_use(edit_of(json));
    return std::string(found.reads ? "reads" : "") + (found.writes ? "writes" : "");
  };
  EXPECT_EQ(use(R"({"edit":"select","expr":"1"})"), "writes");
  EXPECT_EQ(use(R"({"edit":"select_region","at":1,"mode":"add"})"), "readswrites");
  EXPECT_EQ(use(R"({"edit":"select_flange","at":1})"), "writes");
  EXPECT_EQ(use(R"({"edit":"select_flange","at":1,"mode":"subtract"})"), "readswrites");
  EXPECT_EQ(use(R"({"edit":"invert"})"), "readswrites");
  EXPECT_EQ(use(R"({"edit":"hide"})"), "reads");
  EXPECT_EQ(use(R"({"edit":"hide","on":"1"})"), "");
  EXPECT_EQ(use(R"({"edit":"set_criteria","criteria":"strict"})"), "reads");
  EXPECT_EQ(use(R"({"edit":"set_criteria","criteria":"strict","on":"1"})"), "");
  EXPECT_EQ(use(R"({"edit":"translate","by":[1,0,0]})"), "reads");
  EXPECT_EQ(use(R"({"edit":"lift","distance":1,"on":"5"})"), "");
  EXPECT_EQ(use(R"({"edit":"relax","mode":"from","at":1})"), "reads");
  EXPECT_EQ(use(R"({"edit":"repair"})"), "");
  EXPECT_EQ(use(R"({"edit":"repair","scope":"part"})"), "reads");
  EXPECT_EQ(use(R"({"edit":"split","at":["shell:1"]})"), "");
  EXPECT_EQ(use(R"({"edit":"separate"})"), "");
  EXPECT_EQ(use(R"({"edit":"undo"})"), "");
}

}  // namespace
}  // namespace prismesh::mesh::document
