// What the contacts of decks of each format make of the distance at which shells are too close: read from small decks, with the distances
// worked out by hand.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/contacts.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

class ContactRules : public ::testing::Test {
 protected:
  Document opened(const std::string& name, const std::string& text) {
    put_content(folder_ / name, text);
    Result<Document> document = open(folder_ / name, {});
    if (!document) ADD_FAILURE() << document.error().text();
    return std::move(*document);
  }
  static std::vector<ContactRegion> regions(const Document& document, const ContactWish& wish = {}) {
    ContactSearch search;
    const Result<Contacts> found = find_contacts(document.current(), search, wish);
    if (!found) ADD_FAILURE() << found.error().text();
    return found ? found->regions : std::vector<ContactRegion>();
  }
  /// Of the only region; -1: there is none.
  static double depth(const Document& document, const ContactWish& wish = {}) {
    const std::vector<ContactRegion> found = regions(document, wish);
    EXPECT_LE(found.size(), 1u);
    return found.empty() ? -1 : found[0].max_depth.value_or(-2);
  }
  Folder folder_;
};

/// Part 1: a plate of 10 x 10 at z = 0, 1 thick, its normal up; part 2: 6 x 6, `height` above it, 2 thick. NLOC of part 1; CNTCO; and the
/// contact's own thickness.
std::string plates_with_offset(double height, const std::string& location, const std::string& control, const std::string& thickness) {
  const auto node = [](int id, double x, double y, double z) {
    char line[80];
    std::snprintf(line, sizeof line, "%8d%16.4f%16.4f%16.4f\n", id, x, y, z);
    return std::string(line);
  };
  return "*KEYWORD\n*CONTROL_CONTACT\n\n         0         0         0         0         0         1\n*CONTROL_SHELL\n\n\n" +
         std::string("         0         0") + control +
         "\n*CONTACT_AUTOMATIC_SINGLE_SURFACE\n         0         0         0\n\n       0.0       0.0" + thickness + thickness +
         "\n*NODE\n" + node(1, 0, 0, 0) + node(2, 10, 0, 0) + node(3, 10, 10, 0) + node(4, 0, 10, 0) + node(11, 2, 2, height) +
         node(12, 8, 2, height) + node(13, 8, 8, height) + node(14, 2, 8, height) +
         "*ELEMENT_SHELL\n       1       1       1       2       3       4\n       2       2      11      12      13      14\n" +
         "*PART\nfloor\n         1         1\n*PART\nroof\n         2         2\n" +
         "*SECTION_SHELL\n         1         2\n       1.0       1.0       1.0       1.0" + location + "\n" +
         "*SECTION_SHELL\n         2         2\n       2.0       2.0       2.0       2.0\n*END\n";
}

constexpr const char* kNone = "       0.0";

TEST_F(ContactRules, ls_dyna_offsets_count_where_the_control_says_so) {
  const auto deck = [&](const char* location, const char* control, const char* thickness = kNone) {
    return opened("plates.k", plates_with_offset(1.25, location, control, thickness));
  };
  EXPECT_NEAR(depth(deck(kNone, "         1")), 0.25, 1e-12);
  EXPECT_NEAR(depth(deck("       1.0", "         0")), 0.25, 1e-12) << "the nodes' plane, by default";
  EXPECT_EQ(depth(deck("       1.0", "         1")), -1) << "the nodes are the top: 1.75 apart";
  EXPECT_NEAR(depth(deck("      -1.0", "         1")), 0.75, 1e-12) << "the nodes are the bottom: 0.75 apart";
  EXPECT_NEAR(depth(deck("      -0.5", "         1")), 0.5, 1e-12);
  EXPECT_NEAR(depth(deck("      -1.0", "         1", "       2.4")), 2.4 - 0.75, 1e-12) << "half of the shell's own thickness";
  EXPECT_NEAR(depth(deck("      -1.0", "         2", "       2.4")), 2.4 - 0.05, 1e-12) << "half of the contact's thickness";
  EXPECT_NEAR(depth(deck("      -1.0", "         1"), {{}, 0, {}, false}), 0.25, 1e-12) << "without the contacts there is no offset";
}

TEST_F(ContactRules, an_offset_surface_is_told_where_it_is_and_the_way_out_from_the_node) {
  const std::vector<ContactRegion> found = regions(opened("plates.k", plates_with_offset(1.25, "      -1.0", "         1", kNone)));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].at.z(), (0.5 + 1.25) / 2, 1e-12);
  EXPECT_EQ(found[0].thickness_from, "contact");
  EXPECT_EQ(found[0].contact, "CONTACT_AUTOMATIC_SINGLE_SURFACE");
  ASSERT_FALSE(found[0].vectors.empty());
  for (const ContactVector& vector : found[0].vectors) EXPECT_NEAR(std::abs(vector.to.z() - 1.25), 0.75, 1e-12) << "of the upper plate";
}

TEST_F(ContactRules, separating_moves_only_what_is_not_offset) {
  Document document = opened("plates.k", plates_with_offset(1.25, "      -1.0", "         1", kNone));
  const EditReport report = must_apply(document, R"({"edit":"separate"})");
  EXPECT_EQ(report.separated->regions_removed, 1u);
  EXPECT_EQ(place_of(document, 1), Vec3::Zero());
  EXPECT_NEAR(place_of(document, 11).z(), 2, 1e-6);
  EXPECT_EQ(depth(document), -1);
  Document locked = opened("plates.k", plates_with_offset(1.25, "      -1.0", "         1", kNone));
  must_apply(locked, R"({"edit":"lock","on":"2"})");
  const EditReport left = must_apply(locked, R"({"edit":"separate","on":"part:1","move":"on"})");
  EXPECT_EQ(left.separated->regions_left.at(0).why, "nodes of part 1 are offset from the contact's surface");
}

/// The same plates in a Radioss deck, 1.25 apart, and these blocks.
std::string radioss_plates(const std::string& blocks) {
  const auto node = [](int id, double x, double y, double z) {
    char line[80];
    std::snprintf(line, sizeof line, "%10d%20.4f%20.4f%20.4f\n", id, x, y, z);
    return std::string(line);
  };
  const std::string units = "                  Mg                  mm                   s\n";
  const auto property = [](const std::string& id, const std::string& thickness) {
    return "/PROP/SHELL/" + id + "\nsheet\n\n\n         1         0" + thickness + "\n";
  };
  return "#RADIOSS STARTER\n/BEGIN\nplates\n      2021         0\n" + units + units + "/UNIT/2\nmetres\n" +
         "                  Mg                   m                   s\n/NODE\n" + node(1, 0, 0, 0) + node(2, 10, 0, 0) +
         node(3, 10, 10, 0) + node(4, 0, 10, 0) + node(11, 2, 2, 1.25) + node(12, 8, 2, 1.25) + node(13, 8, 8, 1.25) +
         node(14, 2, 8, 1.25) +
         "/SHELL/1\n         1         1         2         3         4\n/SHELL/2\n         2        11        12        13        14\n" +
         "/PART/1\nfloor\n         1         0\n/PART/2\nroof\n         2         0\n" + property("1", "                 1.0") +
         property("2", "                 2.0") + blocks + "/END\n";
}

struct Gap {
  int kind = 0;
  std::string scale = "0", max = "0", mesh = "0", min = "0";
};
/// An interface with these sides.
std::string interface(const std::string& keyword, int secondary, int main, const Gap& gap) {
  const auto real = [](const std::string& text) { return std::string(20 - text.size(), ' ') + text; };
  char sides[80];
  std::snprintf(sides, sizeof sides, "%10d%10d%10d%10d%10d\n", secondary, main, 0, 0, gap.kind);
  return keyword + "\nthe contact\n" + sides + real(gap.scale) + real(gap.max) + "\n" + real("0") + real("0") + real(gap.mesh) + "\n" +
         real("0") + real("0") + real(gap.min) + "\n";
}

constexpr const char* kRadiossGroups =
    "/SURF/PART/21\nfloor\n         1\n/SURF/PART/22\nroof\n         2\n/GRNOD/PART/32\nroof\n         2\n/GRNOD/NODE/31\nfloor\n"
    "         1         2         3         4\n/SURF/SURF/23\nboth\n        21        22\n/SURF/SURF/24\nboth but the roof\n        23     "
    "  -22\n"
    "/GRNOD/GRNOD/33\nthe roof's\n        32\n/SURF/BOX/25\nnot known\n        21\n";

TEST_F(ContactRules, radioss_gaps_are_constant_or_between_limits) {
  const auto deck = [&](const Gap& gap) {
    return opened("plates_0000.rad", radioss_plates(kRadiossGroups + interface("/INTER/TYPE7/5", 32, 21, gap)));
  };
  EXPECT_NEAR(depth(deck({1, "0", "0", "0", "1.4"})), 0.25, 1e-12) << "half of both thicknesses";
  EXPECT_NEAR(depth(deck({1, "0", "0", "0", "2.0"})), 0.75, 1e-12) << "at least Gapmin";
  EXPECT_NEAR(depth(deck({1, "1.2", "1.4", "0", "0.1"})), 0.25, 1e-12) << "neither scale nor max count for Igap = 1";
  EXPECT_NEAR(depth(deck({2, "1.2", "0", "0", "0.1"})), 0.55, 1e-12);
  EXPECT_NEAR(depth(deck({2, "0", "1.4", "0", "0.1"})), 0.15, 1e-12) << "at most Gapmax";
  EXPECT_NEAR(depth(deck({3, "0", "0", "0.09", "0.1"})), 0.19, 1e-12) << "0.09 of 10 and 6";
  EXPECT_NEAR(depth(deck({3, "0", "0", "0", "0.1"})), 0.25, 1e-12);
  EXPECT_EQ(depth(deck({0, "0", "0", "0", "0.5"})), -1) << "constant";
  EXPECT_NEAR(depth(deck({0, "0", "0", "0", "1.3"})), 0.05, 1e-12);
  EXPECT_NEAR(depth(deck({1000, "0", "0", "0", "1.3"})), 0.05, 1e-12);
  EXPECT_EQ(depth(deck({0, "0", "0", "0", "0"})), -1) << "the main surface's thickness: 1";
  EXPECT_NEAR(depth(deck({0, "0", "0", "0", "1.3"}), {{}, 0, {}, false}), 0.25, 1e-12) << "by sections";
}

TEST_F(ContactRules, radioss_interfaces_know_their_sides) {
  const Gap by_thickness{1, "0", "0", "0", "2.0"};
  const auto contact = [&](const std::string& blocks) {
    const std::vector<ContactRegion> found = regions(opened("plates_0000.rad", radioss_plates(kRadiossGroups + blocks)));
    return found.size() == 1 ? found[0].contact : std::to_string(found.size()) + " regions";
  };
  const std::string seen = "INTER/TYPE7 5 the contact";
  EXPECT_EQ(contact(interface("/INTER/TYPE7/5", 32, 21, by_thickness)), seen);
  EXPECT_EQ(contact(interface("/INTER/TYPE7/5", 33, 21, by_thickness)), seen);
  EXPECT_EQ(contact(interface("/INTER/TYPE7/5", 31, 22, by_thickness)), seen);
  EXPECT_EQ(contact(interface("/INTER/TYPE7/5", 0, 23, by_thickness)), seen) << "with itself";
  EXPECT_EQ(contact(interface("/INTER/TYPE7/5", 31, 24, by_thickness)), "") << "without the roof";
  EXPECT_EQ(contact(interface("/INTER/TYPE7/5", 32, 25, by_thickness)), "") << "a side that isn't known";
  EXPECT_EQ(contact(interface("/INTER/TYPE19/5", 22, 21, by_thickness)), "INTER/TYPE19 5 the contact");
  EXPECT_EQ(contact(interface("/INTER/TYPE2/5", 32, 21, by_thickness)), "");
  std::string tangled;
  for (int group = 100; group < 140; ++group) {
    std::string block = "/SURF/SURF/" + std::to_string(group) + "\nnames all\n        21\n";
    for (int other = 100; other < 140; ++other) block += std::string(7, ' ') + std::to_string(other) + "\n";
    tangled += block;
  }
  EXPECT_EQ(contact(tangled + interface("/INTER/TYPE7/5", 32, 117, by_thickness)), seen) << "groups that name each other";
  const Document metres =
      opened("plates_0000.rad", radioss_plates(kRadiossGroups + interface("/INTER/TYPE7/5/2", 32, 21, {0, "0", "0", "0", "0.0014"})));
  EXPECT_NEAR(depth(metres), 0.15, 1e-12);
  const Document thick = opened("plates_0000.rad", radioss_plates(kRadiossGroups + interface("/INTER/TYPE7/5", 31, 22, {})));
  EXPECT_NEAR(depth(thick), 0.75, 1e-12) << "the main surface's thickness: 2";
}

/// The same plates in an Abaqus deck, 1.25 apart; parameters of the lower one's section.
std::string abaqus_plates(const std::string& parameters) {
  return "*NODE\n1, 0, 0, 0\n2, 10, 0, 0\n3, 10, 10, 0\n4, 0, 10, 0\n11, 2, 2, 1.25\n12, 8, 2, 1.25\n13, 8, 8, 1.25\n14, 2, 8, 1.25\n"
         "*ELEMENT, TYPE=S4, ELSET=FLOOR\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=S4, ELSET=ROOF\n2, 11, 12, 13, 14\n"
         "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*SHELL SECTION, ELSET=FLOOR, MATERIAL=STEEL" +
         parameters + "\n1.0, 5\n*SHELL SECTION, ELSET=ROOF, MATERIAL=STEEL\n2.0, 5\n";
}

TEST_F(ContactRules, abaqus_offsets_of_sections_move_the_surface) {
  const auto deck = [&](const char* parameters) { return opened("plates.inp", abaqus_plates(parameters)); };
  EXPECT_NEAR(depth(deck("")), 0.25, 1e-12);
  EXPECT_EQ(depth(deck(", OFFSET=SPOS")), -1) << "the nodes are the top: 1.75 apart";
  EXPECT_NEAR(depth(deck(", OFFSET=SNEG")), 0.75, 1e-12) << "the nodes are the bottom";
  EXPECT_NEAR(depth(deck(", OFFSET=-0.25")), 0.5, 1e-12);
  EXPECT_NEAR(depth(deck(", offset = sneg")), 0.75, 1e-12);
  EXPECT_NEAR(depth(deck(", OFFSET=SOME_DISTRIBUTION")), 0.25, 1e-12);
  EXPECT_NEAR(depth(deck(", OFFSET=SNEG"), {{}, 0, {}, false}), 0.25, 1e-12) << "by sections there is no offset";
  EXPECT_EQ(regions(deck(", OFFSET=SNEG")).at(0).thickness_from, "section");
}

}  // namespace
}  // namespace prismesh::mesh::document
