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

}  // namespace
}  // namespace prismesh::mesh
