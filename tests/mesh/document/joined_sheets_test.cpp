// Which sheets a deck joins, by its cards and elements: regions and weights continue on the same ones.
#include "mesh/document/joined_sheets.h"

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

}  // namespace
}  // namespace prismesh::mesh::document
