#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::int64_t> hidden_parts(const Document& document) {
  std::vector<std::int64_t> ids;
  for (std::size_t p = 0; p < document.current().parts->size(); ++p)
    if ((*document.current().parts)[p].hidden) ids.push_back((*document.current().model.parts)[p].id);
  return ids;
}

std::size_t marked(const Document& document, NodeMark mark) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < document.current().node_marks.size(); ++n) count += (document.current().node_marks[n] & mark) != 0;
  return count;
}

TEST(Parts, hide_show_only) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"hide","on":"2,4"})");
  EXPECT_THAT(hidden_parts(document), ElementsAre(2, 4));
  EXPECT_EQ(marked(document, kHidden), 20u + 7u);  // not the 5 that part 1 shares with part 2
  must_apply(document, R"({"edit":"only","on":"2"})");
  EXPECT_THAT(hidden_parts(document), ElementsAre(1, 3, 4));
  must_apply(document, R"({"edit":"show","on":"1"})");
  EXPECT_THAT(hidden_parts(document), ElementsAre(3, 4));
  must_apply(document, R"({"edit":"show"})");  // nothing selected: all
  EXPECT_TRUE(hidden_parts(document).empty());
  EXPECT_EQ(marked(document, kHidden), 0u);
}

TEST(Parts, hiding_deselects_of_elements_the_hidden_ones_and_their_nodes_only) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"select","expr":"4-5","kind":"element"})");  // side by side, of parts 1 and 2
  ASSERT_EQ(document.current().selected_nodes, 6u);
  const EditReport report = must_apply(document, R"({"edit":"hide","on":"2"})");
  EXPECT_EQ(document.current().selected_shells, 1u);
  EXPECT_EQ(document.current().selected_nodes, 4u);
  EXPECT_EQ(document.current().selection_kind, select::EntityKind::element);
  EXPECT_THAT(report.notes, ElementsAre("2 hidden nodes deselected"));
  EXPECT_THAT(must_apply(document, R"({"edit":"hide","on":"4"})").notes, IsEmpty()) << "nothing of it was selected";
  EXPECT_THAT(must_apply(document, R"({"edit":"lock","on":"1"})").notes, IsEmpty()) << "it can still be seen";
  EXPECT_EQ(document.current().selected_shells, 1u);
}

TEST(Parts, without_on_it_is_the_selections_parts) {
  Document document = make_document(make_assembly());
  EXPECT_THAT(refusal(document, R"({"edit":"hide"})"), HasSubstr("nothing is selected"));
  must_apply(document, R"({"edit":"select","expr":"100-101,110-111"})");
  must_apply(document, R"({"edit":"hide"})");
  EXPECT_THAT(hidden_parts(document), ElementsAre(1));
  must_apply(document, R"({"edit":"show","on":"1"})");
  must_apply(document, R"({"edit":"select","expr":"900"})");  // the beam's own end
  must_apply(document, R"({"edit":"hide"})");
  EXPECT_THAT(hidden_parts(document), ElementsAre(3));
}

TEST(Parts, what_is_hidden_is_no_longer_selected) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"select","expr":"103-106"})");
  const EditReport report = must_apply(document, R"({"edit":"hide","on":"2"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(103, 104));
  EXPECT_THAT(report.notes, ElementsAre("2 hidden nodes deselected"));
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_THAT(selected_ids(document), ElementsAre(103, 104, 105, 106));
}

TEST(Parts, a_row_of_nodes_thinner_than_a_shell_stands_for_the_parts_it_touches) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"select","expr":"100-103"})");
  must_apply(document, R"({"edit":"hide"})");
  EXPECT_THAT(hidden_parts(document), ElementsAre(1));
}

TEST(Parts, what_is_selected_though_it_is_hidden_stays_so_while_others_are_shown) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"hide","on":"2,4"})");
  must_apply(document, R"({"edit":"select","expr":"106-107"})");
  EXPECT_THAT(must_apply(document, R"({"edit":"show","on":"4"})").notes, IsEmpty());
  EXPECT_THAT(selected_ids(document), ElementsAre(106, 107));
}

TEST(Parts, inverting_elements_leaves_hidden_ones_out) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"select","expr":"1","kind":"element"})");
  must_apply(document, R"({"edit":"hide","on":"2"})");
  must_apply(document, R"({"edit":"invert"})");
  EXPECT_EQ(document.current().selected_shells, 15u);
}

TEST(Parts, locked_nodes_refuse_to_move) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"lock","on":"2"})");
  EXPECT_EQ(marked(document, kLocked), 25u);
  EXPECT_EQ(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"103-106","falloff":{"profile":"constant"}})"),
            "node 104 would move but belongs to the locked part 2 (3 such nodes in all); unlock the part or deselect its nodes");
  EXPECT_EQ(document.generations.size(), 2u);
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"100-103","falloff":{"profile":"constant"}})");
  must_apply(document, R"({"edit":"unlock","on":"2"})");
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"103-106","falloff":{"profile":"constant"}})");
}

TEST(Parts, a_locked_beam_or_solid_holds_the_nodes_it_shares) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"lock","on":"3,4"})");
  EXPECT_EQ(marked(document, kLocked), 10u);
  EXPECT_THAT(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"100"})"),
              HasSubstr("node 100 would move but belongs to the locked part 3"));
  EXPECT_THAT(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"148"})"), HasSubstr("the locked part 4"));
}

TEST(Parts, undo_brings_back_states_and_marks) {
  Document document = make_document(make_assembly());
  const std::shared_ptr<const Generation> first = document.generations[0];
  must_apply(document, R"({"edit":"lock","on":"1"})");
  must_apply(document, R"({"edit":"only","on":"1"})");
  must_apply(document, R"({"edit":"undo"})");
  must_apply(document, R"({"edit":"undo"})");
  expect_same(document.current(), *first);
}

TEST(Parts, an_edit_that_changes_no_part_says_so) {
  Document document = make_document(make_assembly());
  EXPECT_THAT(must_apply(document, R"({"edit":"show","on":"1"})").notes, ElementsAre("no part changed"));
  EXPECT_THAT(refusal(document, R"({"edit":"hide","on":"77"})"), testing::StartsWith("expression:1: "));
}

}  // namespace
}  // namespace prismesh::mesh::document
