// diff and distance give the figures of the fields that views are coloured by.
#include <cmath>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/document/distance_fields.h"
#include "mesh/document/field.h"
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using mesh::document::FieldFigures;
using nlohmann::json;

void expect_figures(const json& said, const FieldFigures& field) {
  ASSERT_TRUE(said.is_object()) << said;
  EXPECT_EQ(said["nodes"], field.measured);
  EXPECT_EQ(said["min"].get<double>(), field.min);
  EXPECT_EQ(said["mean"].get<double>(), field.mean);
  EXPECT_EQ(said["max"].get<double>(), field.max);
}

TEST_F(Cli, diff_gives_the_fields_figures) {
  const std::string a = write("a.k", plate_text());
  const std::string b = path("b.k");
  const Outcome edited = prismesh({"edit", a, "--edit", R"({"edit": "lift", "on": "100-120", "distance": 3})", "-o", b});
  ASSERT_EQ(edited.status, kDone) << edited.err;
  const Outcome outcome = prismesh({"diff", a, b, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json said = outcome.json();
  const auto first = mesh::deck::open(a), second = mesh::deck::open(b);
  ASSERT_TRUE(first && second);
  const auto displacement = mesh::document::displacement_field(first->model, second->model, LengthUnit::mm);
  const auto distance = mesh::document::surface_distance_field(first->model, second->model, LengthUnit::mm);
  ASSERT_TRUE(displacement && distance);
  expect_figures(said["displacement"], displacement->figures);
  expect_figures(said["surface_distance"], distance->figures);
  EXPECT_GT(displacement->figures.max, 0);
  EXPECT_EQ(said["max_displacement"], said["displacement"]["max"]);
  EXPECT_EQ(said["displacement"]["max_at"], "node:" + std::to_string(second->model.node_ids[displacement->figures.max_at]));
  const Outcome text = prismesh({"diff", a, b});
  EXPECT_THAT(text.out, HasSubstr("displacement: max "));
}

TEST_F(Cli, diff_of_decks_without_common_ids_has_no_displacement) {
  const std::string a = write("a.k", plate_text());
  const std::string b =
      write("b.k", "*KEYWORD\n*NODE\n" + node_card(90001, 0, 0, 2) + node_card(90002, 10, 0, 2) + node_card(90003, 10, 10, 2) +
                       node_card(90004, 0, 10, 2) + "*ELEMENT_SHELL\n" + shell_card(90001, 1, 90001, 90002, 90003, 90004) + "*END\n");
  const json said = prismesh({"diff", a, b, "--json"}).json();
  EXPECT_TRUE(said["displacement"].is_null());
  EXPECT_EQ(said["max_displacement"], 0);
  EXPECT_EQ(said["surface_distance"]["nodes"], 4);
  EXPECT_EQ(said["nodes_added"], 4);
  EXPECT_THAT(prismesh({"diff", a, b}).out, HasSubstr("no node in common"));
}

TEST_F(Cli, diff_counts_shells_with_other_corners) {
  const std::string start = "*KEYWORD\n*NODE\n" + node_card(1, 0, 0, 0) + node_card(2, 10, 0, 0) + node_card(3, 10, 10, 0) +
                            node_card(4, 0, 10, 0) + "*ELEMENT_SHELL\n";
  const std::string a = write("a.k", start + shell_card(1, 1, 1, 2, 3, 4) + "*END\n");
  const std::string b = write("b.k", start + shell_card(1, 1, 1, 2, 3, 3) + shell_card(2, 1, 1, 3, 4, 4) + "*END\n");
  const json said = prismesh({"diff", a, b, "--json"}).json();
  EXPECT_EQ(said["elements_changed"], 1);
  EXPECT_EQ(said["elements_added"], 1);
  EXPECT_EQ(said["elements_removed"], 0);
}

TEST_F(Cli, distance_gives_the_fields_figures) {
  std::string text = "*KEYWORD\n*NODE\n";
  for (int part = 0; part < 2; ++part)
    text += node_card(10 * part + 1, 0, 0, 4 * part) + node_card(10 * part + 2, 10, 0, 4 * part) +
            node_card(10 * part + 3, 10, 10, 5 * part) + node_card(10 * part + 4, 0, 10, 5 * part);
  text += "*ELEMENT_SHELL\n" + shell_card(1, 1, 1, 2, 3, 4) + shell_card(2, 2, 11, 12, 13, 14) + "*END\n";
  const std::string deck = write("two.k", text);
  const Outcome outcome = prismesh({"distance", deck, "--from", "part:2", "--to", "part:1", "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json said = outcome.json();
  EXPECT_EQ(said["distance"], 4);
  EXPECT_EQ(said["nodes"]["nodes"], 4);
  EXPECT_EQ(said["nodes"]["min"], 4);
  EXPECT_EQ(said["nodes"]["max"], 5);
  EXPECT_EQ(said["nodes"]["mean"], 4.5);
  EXPECT_EQ(said["nodes"]["max_at"], "node:13");
}

}  // namespace
}  // namespace prismesh::cli
