// What *CONTACT, *CONTROL_CONTACT and *PART_CONTACT say about sides and thicknesses.
#include "mesh/model/contact_cards.h"

#include "mesh/deck/open.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

ContactCards cards_of(const std::string& text) {
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n" + text + "*NODE\n       1             0.0             0.0             0.0\n*END\n");
  if (!opened) ADD_FAILURE() << opened.error().text();
  return opened ? opened->deck->contacts : ContactCards();
}

TEST(ContactCards, a_single_surface_contact_of_everything) {
  const ContactCards cards = cards_of(
      "*CONTACT_AUTOMATIC_SINGLE_SURFACE_ID\n"
      "        32                                                      Body Interaction\n"
      "         0         0         5         0         0         0         0         0\n"
      "       0.1         0         0         0        10         0         0         0\n"
      "       1.0       1.0       1.5       2.5       0.8       0.9       1.0       1.0\n");
  ASSERT_EQ(cards.cards.size(), 1u);
  const ContactCard& card = cards.cards[0];
  EXPECT_EQ(card.name(), "CONTACT_AUTOMATIC_SINGLE_SURFACE 32 Body Interaction");
  EXPECT_TRUE(card.a.everything);
  EXPECT_FALSE(card.b);
  EXPECT_EQ(card.a.thickness, 1.5);
  EXPECT_EQ(card.a.scale, 0.8);
  EXPECT_TRUE(card.thick);
  EXPECT_TRUE(card.limited_by_sides);
  EXPECT_FALSE(card.ties);
}

TEST(ContactCards, sides_by_part_set_and_part_with_thicknesses_of_their_own) {
  const ContactCards cards = cards_of(
      "*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_MPP_TITLE\n"
      "         7door to pillar\n"
      "         1         2\n"
      "&        3\n"
      "        11         4         2         3\n"
      "\n"
      "       1.0       1.0       1.5       2.5       0.8       0.9\n"
      "*CONTACT_TIED_SHELL_EDGE_TO_SURFACE\n"
      "1,2,4,0\n0.,0.\n0.,0.,2.0,2.0\n");
  ASSERT_EQ(cards.cards.size(), 2u);
  const ContactCard& card = cards.cards[0];
  EXPECT_EQ(card.name(), "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE 7 door to pillar");
  EXPECT_EQ(card.a.referred, Referred::part_set);
  EXPECT_EQ(card.a.id, 11);
  ASSERT_TRUE(card.b);
  EXPECT_EQ(card.b->referred, Referred::part);
  EXPECT_EQ(card.b->id, 4);
  EXPECT_EQ(card.b->thickness, 2.5);
  EXPECT_EQ(card.b->scale, 0.9);
  EXPECT_FALSE(card.limited_by_sides);
  EXPECT_TRUE(cards.cards[1].ties);
  EXPECT_EQ(cards.cards[1].a.referred, Referred::node_set);
  EXPECT_EQ(cards.cards[1].b->referred, Referred::segment_set);
}

TEST(ContactCards, old_types_consider_thickness_only_where_they_are_told_to) {
  const std::string contact =
      "*CONTACT_SURFACE_TO_SURFACE\n"
      "         1         2         3         3\n\n\n";
  EXPECT_FALSE(cards_of(contact).cards.at(0).thick);
  EXPECT_TRUE(cards_of(contact + "*CONTROL_CONTACT\n         0         0         0         1\n").cards.at(0).thick)
      << "the control, also behind it";
  EXPECT_TRUE(cards_of(contact + "         0\n         0         0         2\n").cards.at(0).thick) << "its own optional card";
  EXPECT_TRUE(cards_of("*CONTACT_FORMING_SURFACE_TO_SURFACE\n         1         2         3         3\n\n\n").cards.at(0).thick);
}

TEST(ContactCards, controls_take_the_limit_away_and_give_a_thickness) {
  const ContactCards cards = cards_of(
      "*CONTROL_CONTACT\n\n         0         0         0         0         0         1\n       0.0       0.0       0.0       0.0       "
      "0.7\n"
      "*CONTACT_AUTOMATIC_GENERAL\n         9         0         6\n\n\n");
  ASSERT_EQ(cards.cards.size(), 1u);
  EXPECT_FALSE(cards.cards[0].limited_by_sides);
  EXPECT_TRUE(cards.cards[0].a.all_but);
  EXPECT_EQ(cards.cards[0].a.id, 9);
  EXPECT_EQ(cards.thickness, 0.7);
}

TEST(ContactCards, parts_have_thicknesses_of_their_own) {
  const ContactCards cards = cards_of(
      "*PART_INERTIA_CONTACT_PRINT\nfirst\n         3         1         1\n"
      "       0.0       0.0       0.0       1.0         0\n       1.0       0.0       0.0       1.0       0.0       1.0\n       0.0\n"
      "       0.1       0.1       0.0       0.0       1.2       0.5\n"
      "         0\n"
      "second\n         4         1         1\n"
      "       0.0       0.0       0.0       1.0         0\n       1.0       0.0       0.0       1.0       0.0       1.0\n       0.0\n"
      "       0.1       0.1       0.0       0.0       0.0       0.6\n"
      "         0\n");
  ASSERT_EQ(cards.of_part.size(), 2u);
  EXPECT_EQ(cards.of_part.at(3).thickness, 1.2);
  EXPECT_EQ(cards.of_part.at(3).scale, 0.5);
  EXPECT_EQ(cards.of_part.at(4).thickness, 0);
  EXPECT_EQ(cards.of_part.at(4).scale, 0.6);
}

TEST(ContactCards, other_forms_and_cut_off_cards_are_passed_over) {
  EXPECT_EQ(cards_of("*CONTACT_2D_AUTOMATIC_SINGLE_SURFACE\n         1\n\n\n").cards.size(), 0u);
  EXPECT_EQ(cards_of("*CONTACT_FORCE_TRANSDUCER_PENALTY\n         1\n\n\n").cards.size(), 0u);
  EXPECT_EQ(cards_of("*CONTACT_AUTOMATIC_SINGLE_SURFACE\n         1\n").cards.size(), 0u);
  EXPECT_EQ(cards_of("*CONTACT_AUTOMATIC_SINGLE_SURFACE_ID\n").cards.size(), 0u);
  EXPECT_EQ(cards_of("*CONTROL_CONTACT\n").thickness, 0);
}

TEST(ContactCards, numbers_that_cant_be_a_thickness_are_none) {
  const ContactCards cards = cards_of(
      "*CONTACT_AUTOMATIC_SINGLE_SURFACE\n         3         0         3\n\n"
      "       0.0       0.0      -1.5       0.0       abc\n");
  ASSERT_EQ(cards.cards.size(), 1u);
  EXPECT_EQ(cards.cards[0].a.thickness, 0);
  EXPECT_EQ(cards.cards[0].a.scale, 0);
}

TEST(ContactCards, offsets_of_sections_and_whether_contacts_follow_them) {
  const std::string sections =
      "*SECTION_SHELL\n         7         2\n       1.0       1.0       1.0       1.0       1.0\n"
      "         8         2\n       1.0       1.0       1.0       1.0      -0.5\n"
      "         9         2\n       1.0       1.0       1.0       1.0       0.0\n";
  ContactCards cards = cards_of(sections);
  EXPECT_EQ(cards.offsets, ContactOffsets::ignored);
  EXPECT_EQ(cards.offset_of_section, (std::map<std::int64_t, double>{{7, -0.5}, {8, 0.25}})) << "the middle lies on the other side";
  const auto control = [](const std::string& value) { return cards_of("*CONTROL_SHELL\n20.,0\n1.0\n0,0," + value + "\n").offsets; };
  EXPECT_EQ(control("1"), ContactOffsets::of_shell);
  EXPECT_EQ(control("2"), ContactOffsets::of_contact);
  EXPECT_EQ(control("0"), ContactOffsets::ignored);
}

}  // namespace
}  // namespace prismesh::mesh::deck
