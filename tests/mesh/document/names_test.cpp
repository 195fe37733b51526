// Sets and files of decks in expressions, from the text to the selection; on real decks where PRISMESH_MODELS points to them.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/deck_relations.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const char* const kMain =
    "*KEYWORD\n*INCLUDE\nbumper.k\n*INCLUDE\nwelds.k\n*PART\nrail\n         1\n*PART\nbumper\n         2\n*PART\nwelds\n         3\n"
    "*NODE\n       1             0.0             0.0             0.0\n       2            10.0             0.0             0.0\n"
    "       3            10.0            10.0             0.0\n       4             0.0            10.0             0.0\n"
    "*ELEMENT_SHELL\n       1       1       1       2       3       4\n"
    "*SET_NODE_LIST_TITLE\nFlange nodes\n        17\n         1         2        11\n"
    "*SET_NODE_GENERAL\n        18\nPART               2\nDNODE             12        13\n"
    "*SET_PART_LIST\n        17\n         2\n*SET_NODE_LIST_GENERATE\n        19\n         3        12\n"
    "*SET_NODE_ADD\n        20\n        17        18\n*END\n";
const char* const kBumper =
    "*KEYWORD\n*NODE\n      11            20.0             0.0             0.0\n      12            30.0             0.0             0.0\n"
    "      13            30.0            10.0             0.0\n      14            20.0            10.0             0.0\n"
    "*ELEMENT_SHELL\n       2       2      11      12      13      14\n       3       2       2      11      14       3\n*END\n";
const char* const kWelds =
    "*KEYWORD\n*NODE\n      21            50.0             0.0             0.0\n      22            60.0             0.0             0.0\n"
    "*ELEMENT_BEAM\n       1       3      21      22       0\n*END\n";

class NamesTest : public ::testing::Test {
 protected:
  NamesTest() {
    put_content(folder_ / "main.k", kMain);
    put_content(folder_ / "bumper.k", kBumper);
    put_content(folder_ / "welds.k", kWelds);
    OpenOptions options;
    options.target_size = 10.0;
    document_ = open(folder_ / "main.k", options).value();
  }
  std::vector<std::int64_t> selected(const std::string& expression) {
    std::string json = R"({"edit":"select","expr":")";
    for (const char c : expression) json += c == '"' ? std::string("\\\"") : std::string(1, c);
    must_apply(document_, json + "\"}");
    std::vector<std::int64_t> ids = selected_ids(document_);  // in the deck's order: includes first
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  std::vector<std::int64_t> parts_with(bool PartState::*state) const {
    std::vector<std::int64_t> ids;
    for (std::size_t p = 0; p < document_.current().parts->size(); ++p)
      if ((*document_.current().parts)[p].*state) ids.push_back((*document_.current().model.parts)[p].id);
    return ids;
  }

  Folder folder_;
  Document document_;
};

TEST_F(NamesTest, sets_of_the_deck) {
  EXPECT_THAT(selected("set:17"), ElementsAre(1, 2, 11));
  EXPECT_THAT(selected("set:\"flange nodes\",!11"), ElementsAre(1, 2));
  EXPECT_THAT(selected("set:18"), ElementsAre(2, 3, 11, 14));
  EXPECT_THAT(selected("set:19"), ElementsAre(3, 4, 11, 12));
  EXPECT_THAT(selected("set:20"), ElementsAre(1, 2, 3, 11, 14));
  EXPECT_THAT(selected("part_set:17 & ~set:19"), ElementsAre(2, 13, 14));
  EXPECT_EQ(refusal(document_, R"({"edit":"select","expr":"set:\"flang nodes\""})"),
            "expression:1: there is no set \"flang nodes\"; did you mean \"Flange nodes\"?");
}

TEST_F(NamesTest, files_of_the_deck) {
  EXPECT_THAT(selected("file:main.k"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(selected("file:bumper.k"), ElementsAre(2, 3, 11, 12, 13, 14));
  EXPECT_THAT(selected("file:welds.k"), ElementsAre(21, 22));
}

TEST_F(NamesTest, parts_are_hidden_locked_and_reversed_by_file) {
  must_apply(document_, R"({"edit":"hide","on":"file:bumper.k"})");
  EXPECT_THAT(parts_with(&PartState::hidden), ElementsAre(2));
  must_apply(document_, R"({"edit":"only","on":"file:welds.k"})");
  EXPECT_THAT(parts_with(&PartState::hidden), ElementsAre(1, 2));
  must_apply(document_, R"({"edit":"reverse"})");
  EXPECT_THAT(parts_with(&PartState::hidden), ElementsAre(3));
  must_apply(document_, R"({"edit":"reverse","on":"1,3"})");
  EXPECT_THAT(parts_with(&PartState::hidden), ElementsAre(1));
  must_apply(document_, R"({"edit":"show","on":"file:main.k"})");
  EXPECT_THAT(parts_with(&PartState::hidden), IsEmpty());
  must_apply(document_, R"({"edit":"lock","on":"file:welds.k | part_set:17"})");
  EXPECT_THAT(parts_with(&PartState::locked), ElementsAre(2, 3));
  must_apply(document_, R"({"edit":"unlock","on":"file:bumper.k"})");
  EXPECT_THAT(parts_with(&PartState::locked), ElementsAre(3));
}

TEST_F(NamesTest, reversing_twice_is_nothing_and_deselects_what_it_hides) {
  selected("1-4");
  must_apply(document_, R"({"edit":"hide","on":"2"})");
  must_apply(document_, R"({"edit":"reverse"})");
  EXPECT_THAT(parts_with(&PartState::hidden), ElementsAre(1, 3));
  EXPECT_THAT(selected_ids(document_), ElementsAre(2, 3));  // those that part 2 uses as well
  must_apply(document_, R"({"edit":"reverse"})");
  EXPECT_THAT(parts_with(&PartState::hidden), ElementsAre(2));
  must_apply(document_, R"({"edit":"undo"})");
  EXPECT_THAT(parts_with(&PartState::hidden), ElementsAre(1, 3));
}

TEST_F(NamesTest, real_decks_sets_have_their_members) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  struct Case {
    const char* deck;
    const char* expression;
    std::size_t nodes;  ///< counted in the text
  };
  const Case cases[] = {{"hatprofile/Hatprofile.k", "set:1", 1616},
                        {"hatprofile/Hatprofile.k", "set:\"hat tied nodes\"", 1616},
                        {"wheel_k/wheel.k", "set:spc", 48},
                        {"ccx_wire/wire.inp", "set:nwire", 11},
                        {"boxbeam_rad/BOXBEAM_0000.rad", "set:9", 15},
                        {"ac10804/ac10804.bdf", "set:77", 11}};
  for (const Case& each : cases) {
    const Result<Document> document = open(std::filesystem::path(models) / each.deck, OpenOptions{});
    ASSERT_TRUE(document) << document.error().text();
    const auto chosen =
        select::evaluate(document->current().model, each.expression, select::EntityKind::node, document->current().relations->names);
    ASSERT_TRUE(chosen) << each.deck << ": " << chosen.error().text();
    EXPECT_EQ(chosen->nodes.size(), each.nodes) << each.deck << " " << each.expression;
  }
}

}  // namespace
}  // namespace prismesh::mesh::document
