#include "mesh/contact/deck_contacts.h"

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh::contact {
namespace {

/// Five quads of 10 in a row, ids 1 to 5, each a part of its own with that number, 1 to 5 thick. They share no nodes.
Model five_parts() {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int i = 0; i < 5; ++i) {
    const double x = 20.0 * i;
    const std::int64_t n = 10 * i;
    nodes.insert(nodes.end(), {{n + 1, Vec3(x, 0, 0)}, {n + 2, Vec3(x + 10, 0, 0)}, {n + 3, Vec3(x + 10, 10, 0)}, {n + 4, Vec3(x, 10, 0)}});
    shells.push_back({i + 1, i + 1, {n + 1, n + 2, n + 3, n + 4}});
  }
  Model model = test::make_model(nodes, shells);
  std::vector<Part> parts = *model.parts;
  for (std::size_t p = 0; p < parts.size(); ++p) parts[p].thickness = static_cast<double>(p + 1);
  model.parts = std::make_shared<const std::vector<Part>>(std::move(parts));
  return model;
}

ShellIndex shell(int number) { return ShellIndex(static_cast<std::size_t>(number - 1)); }

ContactCard single(ContactSide side) {
  ContactCard card;
  card.keyword = "CONTACT_AUTOMATIC_SINGLE_SURFACE";
  card.a = side;
  card.limited_by_sides = true;
  return card;
}
ContactSide of(Referred referred, std::int64_t id) {
  ContactSide side;
  side.referred = referred;
  side.id = id;
  return side;
}
ContactSide everything() {
  ContactSide side;
  side.everything = true;
  return side;
}

/// Part set 7: parts 1 and 2, and those of set 8 (4 to 5, without 5). Segment set 9: the shell of part 3. Shell set 6: shell 4.
References sets() {
  References references;
  const auto add = [&](Referred defines, std::int64_t id) {
    Referrer referrer;
    referrer.keyword = "SET";
    referrer.id = id;
    referrer.defines = defines;
    return references.add(referrer);
  };
  const std::uint32_t seven = add(Referred::part_set, 7), eight = add(Referred::part_set, 8), nine = add(Referred::segment_set, 9),
                      six = add(Referred::shell_set, 6), loop = add(Referred::part_set, 5);
  references.add({Referred::part, ReferenceRole::list, 1, 2, 1, seven, 0});
  references.add({Referred::part_set, ReferenceRole::list, 8, 8, 1, seven, 0});
  references.add({Referred::part, ReferenceRole::range, 4, 5, 1, eight, 0});
  references.add({Referred::part, ReferenceRole::list, 5, 5, 1, eight, 0, true});
  for (const std::int64_t node : {21, 22, 23, 24}) references.add({Referred::node, ReferenceRole::segment, node, node, 1, nine, 0});
  references.add({Referred::shell, ReferenceRole::list, 4, 4, 1, six, 0});
  references.add({Referred::part_set, ReferenceRole::list, 5, 5, 1, loop, 0});
  references.finish();
  return references;
}

std::vector<double> thicknesses(const ContactCards& cards) { return DeckContacts(five_parts(), cards, sets()).thickness().of_shell; }

TEST(DeckContacts, shells_have_their_own_thickness_in_a_contact_without_one) {
  ContactCards cards;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{1, 2, 3, 4, 5})) << "no contact: that of the section";
  cards.cards.push_back(single(everything()));
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{1, 2, 3, 4, 4})) << "at most 0.4 of the shortest side";
  cards.cards[0].limited_by_sides = false;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(DeckContacts, part_then_side_then_control_replace_it_else_it_is_scaled) {
  ContactCards cards;
  cards.cards.push_back(single(everything()));
  cards.cards[0].a.scale = 0.5;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{0.5, 1, 1.5, 2, 2.5}));
  cards.of_part[2].scale = 2;
  cards.of_part[3].thickness = 0.3;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{0.5, 4, 0.3, 2, 2.5}));
  cards.thickness = 0.7;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{0.7, 0.7, 0.3, 0.7, 0.7}));
  cards.cards[0].a.thickness = 6;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{6, 6, 0.3, 6, 6})) << "a thickness that is given isn't limited by sides";
}

TEST(DeckContacts, see_the_members_of_sets_of_parts_shells_and_segments) {
  const Model model = five_parts();
  const References references = sets();
  ContactCards cards;
  cards.cards.push_back(single(of(Referred::part_set, 7)));
  cards.cards[0].a.thickness = 9;
  ContactThickness thickness = DeckContacts(model, cards, references).thickness();
  EXPECT_EQ(thickness.of_shell, (std::vector<double>{9, 9, 3, 9, 5}));
  EXPECT_EQ(thickness.of_part[0], ThicknessFrom::contact);
  EXPECT_EQ(thickness.of_part[2], ThicknessFrom::section);
  cards.cards[0].a.all_but = true;
  EXPECT_EQ(DeckContacts(model, cards, references).thickness().of_shell, (std::vector<double>{1, 2, 9, 4, 9}));
  cards.cards[0].a = of(Referred::segment_set, 9);
  cards.cards[0].a.thickness = 9;
  EXPECT_EQ(DeckContacts(model, cards, references).thickness().of_shell, (std::vector<double>{1, 2, 9, 4, 5}));
  cards.cards[0].a = of(Referred::shell_set, 6);
  cards.cards[0].a.thickness = 9;
  EXPECT_EQ(DeckContacts(model, cards, references).thickness().of_shell, (std::vector<double>{1, 2, 3, 9, 5}));
  cards.cards[0].a = of(Referred::part_set, 5);
  EXPECT_EQ(DeckContacts(model, cards, references).thickness().of_shell, (std::vector<double>{1, 2, 3, 4, 5})) << "it names itself";
}

/// Forty sets that each name all of them twice, and a part of their own: each is followed once.
TEST(DeckContacts, follow_sets_that_name_each_other_once) {
  References references;
  for (std::int64_t set = 1; set <= 40; ++set) {
    Referrer referrer;
    referrer.keyword = "SET";
    referrer.id = set;
    referrer.defines = Referred::part_set;
    const std::uint32_t index = references.add(referrer);
    for (std::int64_t other = 1; other <= 40; ++other)
      for (const std::uint64_t card : {0U, 100U})
        references.add({Referred::part_set, ReferenceRole::list, other, other, 1, index, card + static_cast<std::uint64_t>(2 * other)});
    references.add({Referred::part, ReferenceRole::list, 1 + set % 3, 1 + set % 3, 1, index, 0});
  }
  references.finish();
  const Model model = five_parts();
  ContactCards cards;
  cards.cards.push_back(single(of(Referred::part_set, 17)));
  cards.cards[0].a.thickness = 9;
  EXPECT_EQ(DeckContacts(model, cards, references).thickness().of_shell, (std::vector<double>{9, 9, 9, 4, 5}));
}

TEST(DeckContacts, of_several_contacts_the_greatest_thickness_counts) {
  ContactCards cards;
  cards.cards = {single(of(Referred::part, 1)), single(everything())};
  cards.cards[0].a.thickness = 6;
  cards.cards[1].a.thickness = 2;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{6, 2, 2, 2, 2}));
}

TEST(DeckContacts, say_which_contact_keeps_two_shells_apart) {
  const Model model = five_parts();
  const References references = sets();
  ContactCards cards;
  ContactCard two;
  two.keyword = "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE";
  two.id = 3;
  two.a = of(Referred::part, 1);
  two.b = of(Referred::part_set, 8);
  ContactCard tie = single(everything());
  tie.ties = true;
  cards.cards = {tie, two, single(of(Referred::part_set, 7))};
  const DeckContacts contacts(model, cards, references);
  EXPECT_EQ(contacts.between(shell(1), shell(4)), &cards.cards[1]);
  EXPECT_EQ(contacts.between(shell(4), shell(1)), &cards.cards[1]) << "in either order";
  EXPECT_EQ(contacts.between(shell(1), shell(2)), &cards.cards[2]);
  EXPECT_EQ(contacts.between(shell(1), shell(3)), nullptr) << "a tie keeps nothing apart";
  EXPECT_EQ(contacts.between(shell(1), shell(1)), &cards.cards[2]);
}

TEST(DeckContacts, without_thickness_touch_at_their_middle) {
  ContactCards cards;
  cards.cards.push_back(single(everything()));
  cards.cards[0].thick = false;
  EXPECT_EQ(thicknesses(cards), (std::vector<double>{0, 0, 0, 0, 0}));
}

TEST(DeckContacts, a_part_without_a_thickness_may_get_one_there) {
  Model model = five_parts();
  std::vector<Part> parts = *model.parts;
  parts[1].thickness.reset();
  parts[2].thickness.reset();
  model.parts = std::make_shared<const std::vector<Part>>(std::move(parts));
  ContactCards cards;
  cards.cards.push_back(single(everything()));
  cards.of_part[2].thickness = 1.5;
  const ContactThickness thickness = DeckContacts(model, cards, {}).thickness();
  EXPECT_EQ(thickness.of_shell[1], 1.5);
  EXPECT_EQ(thickness.without, std::vector{PartIndex(std::size_t{2})});
}

}  // namespace
}  // namespace prismesh::mesh::contact
