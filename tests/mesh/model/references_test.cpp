// The reverse index: what names an id, whatever the order and overlap of the ranges.
#include "mesh/model/references.h"

#include <gtest/gtest.h>

namespace prismesh::mesh {
namespace {

Reference range(Referred referred, std::int64_t first, std::int64_t last, std::int64_t step = 1) {
  return {referred, ReferenceRole::range, first, last, step, 0, 0};
}

TEST(References, find_what_names_an_id_among_nested_ranges) {
  References references;
  references.add(Referrer{});
  references.add(range(Referred::node, 1, 1000));
  references.add(range(Referred::node, 10, 20));
  references.add(range(Referred::node, 30, 40, 5));
  references.finish();
  EXPECT_EQ(references.naming(Referred::node, 15).size(), 2u);
  EXPECT_EQ(references.naming(Referred::node, 35).size(), 2u);
  EXPECT_EQ(references.naming(Referred::node, 36).size(), 1u);
  EXPECT_EQ(references.naming(Referred::node, 1001).size(), 0u);
  EXPECT_EQ(references.naming(Referred::shell, 15).size(), 0u);
}

TEST(References, to_any_element_count_for_each_class_but_not_for_parts_and_sets) {
  References references;
  references.add(Referrer{});
  references.add(range(Referred::any_element, 5, 5));
  references.finish();
  for (const Referred referred : {Referred::shell, Referred::beam, Referred::sph, Referred::other, Referred::any_element})
    EXPECT_TRUE(references.named(referred, 5)) << name(referred);
  for (const Referred referred : {Referred::node, Referred::part, Referred::shell_set, Referred::element_set})
    EXPECT_FALSE(references.named(referred, 5)) << name(referred);
}

TEST(References, know_what_cards_define) {
  References references;
  Referrer set;
  set.id = 7;
  set.defines = Referred::node_set;
  references.add(set);
  references.finish();
  EXPECT_TRUE(references.defined(Referred::node_set, 7));
  EXPECT_FALSE(references.defined(Referred::part_set, 7));
  EXPECT_FALSE(references.defined(Referred::node_set, 8));
}

TEST(References, take_ids_that_count_up_as_one_and_pass_over_what_is_no_id) {
  References references;
  references.add(Referrer{});
  for (const std::int64_t id : {0, -3, 4, 5, 6, 8}) references.add({Referred::node, ReferenceRole::list, id, id, 1, 0, 0});
  references.add(range(Referred::node, -10, 1000000000000000000, 0));
  references.finish();
  EXPECT_EQ(references.all().size(), 3u);
  EXPECT_EQ(references.naming(Referred::node, 5).size(), 2u);
  EXPECT_EQ(references.naming(Referred::node, 7).size(), 1u);
}

TEST(References, keep_ids_behind_a_range_or_in_steps_apart) {
  References references;
  references.add(Referrer{});
  references.add(range(Referred::node, 1, 4));
  references.add({Referred::node, ReferenceRole::list, 5, 5, 1, 0, 0});
  references.add({Referred::shell, ReferenceRole::list, 1, 5, 2, 0, 0});
  references.add({Referred::shell, ReferenceRole::list, 6, 6, 1, 0, 0});
  references.finish();
  EXPECT_EQ(references.all(Referred::node).size(), 2u);
  EXPECT_FALSE(references.named(Referred::shell, 2));
  EXPECT_TRUE(references.named(Referred::shell, 6));
}

TEST(References, begin_at_the_first_id_above_0_of_their_steps) {
  References references;
  references.add(Referrer{});
  references.add(range(Referred::node, -3, 20, 5));
  references.finish();
  EXPECT_EQ(references.all()[0].first, 2);

  References whole_steps;
  whole_steps.add(Referrer{});
  whole_steps.add(range(Referred::node, -5, 20, 5));
  whole_steps.finish();
  EXPECT_EQ(whole_steps.all()[0].first, 5);
}

TEST(References, name_an_id_in_the_order_of_their_first_ids) {
  References references;
  references.add(Referrer{});
  for (const std::int64_t first : {9, 1, 5}) references.add(range(Referred::node, first, 20));
  references.finish();
  const std::vector<Reference> found = references.naming(Referred::node, 10);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].first, 1);
  EXPECT_EQ(found[1].first, 5);
  EXPECT_EQ(found[2].first, 9);
}

TEST(References, of_two_cards_or_kinds_stay_apart_though_their_ids_count_up) {
  References references;
  references.add(Referrer{});
  references.add(Referrer{});
  references.add({Referred::node, ReferenceRole::list, 4, 4, 1, 0, 0});
  references.add({Referred::node, ReferenceRole::list, 5, 5, 1, 1, 0});
  references.add({Referred::shell, ReferenceRole::list, 6, 6, 1, 1, 0});
  references.finish();
  ASSERT_EQ(references.all(Referred::node).size(), 2u);
  EXPECT_EQ(references.naming(Referred::node, 5).at(0).referrer, 1u);
  EXPECT_TRUE(references.named(Referred::shell, 6));
}

TEST(References, keep_their_cards_when_appended) {
  References first, second;
  Referrer card;
  card.id = 1;
  first.add(card);
  card.id = 2;
  second.add(card);
  second.add(range(Referred::node, 5, 5));
  first.append(std::move(second));
  first.finish();
  ASSERT_EQ(first.naming(Referred::node, 5).size(), 1u);
  EXPECT_EQ(first.referrers()[first.naming(Referred::node, 5)[0].referrer].id, 2);
}

TEST(References, cards_make_one_set_if_group_keyword_and_id_are_the_same) {
  Referrer a, b;
  a.keyword = b.keyword = "SPC1";
  a.group = b.group = "g";
  a.id = b.id = 1;
  EXPECT_TRUE(same_set(a, b));
  b.id = 2;
  EXPECT_FALSE(same_set(a, b));
  b = a;
  b.group = "";
  EXPECT_FALSE(same_set(a, b));
  b = a;
  b.keyword = "SPC";
  EXPECT_FALSE(same_set(a, b));
}

TEST(References, a_set_without_an_id_defines_none) {
  References references;
  Referrer set;
  set.defines = Referred::node_set;
  references.add(set);
  references.finish();
  EXPECT_FALSE(references.defined(Referred::node_set, 0));
}

}  // namespace
}  // namespace prismesh::mesh
