// Which sheets a deck joins, by its cards and elements: regions and weights continue on the same ones.
#include "mesh/document/joined_sheets.h"

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/sheets_deck.h"

namespace prismesh::mesh::document {
namespace {

class JoinedSheetsTest : public ::testing::Test {
 protected:
  /// Two sheets of 16 shells, 1.6 apart and 1 thick (nodes 1-25 of part 1, 101-125 of part 2), and these cards.
  Document two_sheets_with(const std::string& cards) {
    DeckText deck;
    deck.sheet(1, 1, 0);
    deck.sheet(2, 101, 1.6);
    deck.cards(cards);
    put_content(folder_ / "main.k", deck.text());
    Result<Document> document = open(folder_ / "main.k", {});
    if (!document) ADD_FAILURE() << document.error().text();
    return std::move(*document);
  }
  /// Whether the region of the first sheet continues on the second.
  bool joined_by(const std::string& cards) {
    Document document = two_sheets_with(cards);
    must_apply(document, R"({"edit":"select_region","at":1,"across_welds":true})");
    const std::size_t shells = document.current().selected_shells;
    EXPECT_TRUE(shells == 16 || shells == 32) << shells;
    return shells == 32;
  }
  Folder folder_;
};

TEST_F(JoinedSheetsTest, by_cards_of_welds_and_rivets) {
  EXPECT_FALSE(joined_by(""));
  EXPECT_TRUE(joined_by("*CONSTRAINED_SPOTWELD\n        13       113\n"));
  EXPECT_TRUE(joined_by("*CONSTRAINED_RIVET_ID\n         5\n        13       113\n"));
  EXPECT_FALSE(joined_by("*CONSTRAINED_SPOTWELD\n        12        13\n       112       113\n")) << "each within a sheet";
  EXPECT_FALSE(joined_by("*CONSTRAINED_SPOTWELD\n         1       125\n")) << "too long";
  const std::string set = "*SET_NODE_LIST\n         7\n        13       113\n";
  EXPECT_TRUE(joined_by(set + "*CONSTRAINED_GENERALIZED_WELD_SPOT\n         7\n"));
  EXPECT_FALSE(joined_by(set + "*BOUNDARY_SPC_SET\n         7\n"));
}

TEST_F(JoinedSheetsTest, by_rigid_bodies_of_few_nodes) {
  const auto body_of = [](int nodes) {
    std::string set = "*SET_NODE_LIST\n         7";
    for (int i = 0; i < nodes; ++i) {
      char id[11];
      std::snprintf(id, sizeof id, "%10d", i % 2 == 0 ? 1 + i / 2 : 101 + i / 2);
      set += (i % 8 == 0 ? "\n" : "") + std::string(id);
    }
    return set + "\n*CONSTRAINED_NODAL_RIGID_BODY\n        50         0         7\n";
  };
  EXPECT_TRUE(joined_by(body_of(2)));
  EXPECT_TRUE(joined_by(body_of(16)));
  EXPECT_FALSE(joined_by(body_of(17))) << "a part, or a barrier";
  EXPECT_FALSE(joined_by("*CONSTRAINED_JOINT_REVOLUTE\n        13       113        14       114\n")) << "a hinge";
}

TEST_F(JoinedSheetsTest, by_tied_nodes_while_they_lie_on_the_other_sheet) {
  const std::string tie =
      "*SET_NODE_LIST\n         8\n       113       114\n*CONTACT_TIED_NODES_TO_SURFACE\n         8         1         4         3\n\n\n";
  EXPECT_TRUE(joined_by(tie));
  Document document = two_sheets_with(tie);
  must_apply(document, R"({"edit":"translate","by":[0,0,9],"on":"part:2","falloff":{"profile":"constant"}})");
  must_apply(document, R"({"edit":"select_region","at":1,"across_welds":true})");
  EXPECT_EQ(document.current().selected_shells, 16u);
}

TEST_F(JoinedSheetsTest, are_those_that_pulls_carry_to) {
  const auto moved_with = [&](const std::string& cards) {
    Document document = two_sheets_with(cards);
    return must_apply(document,
                      R"({"edit":"translate","by":[0,0,1],"on":"all","grab":13,"falloff":{"profile":"linear"},"across_welds":true})")
        .nodes_moved;
  };
  EXPECT_EQ(moved_with(""), 25u);
  EXPECT_EQ(moved_with("*CONSTRAINED_SPOTWELD\n        13       113\n"), 50u);
}

}  // namespace
}  // namespace prismesh::mesh::document
