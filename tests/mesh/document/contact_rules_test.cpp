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

}  // namespace
}  // namespace prismesh::mesh::document
