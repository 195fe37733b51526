#include "mesh/document/edit_json.h"

#include <bit>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

std::string why_not(const std::string& text) {
  const Result<Edit> edit = parse_edit(text);
  return edit ? "" : edit.error().text();
}

TEST(EditJson, every_edit_reads_its_example) {
  for (
      const char* text : {
          R"({"edit":"select","expr":"1-100,205,!17,part:3"})",
          R"({"edit":"select","expr":"3","kind":"part","mode":"add"})",
          R"({"edit":"select_region","at":17,"angle":30})",
          R"({"edit":"select_region","at":[1,2.5,-3e2]})",
          R"({"edit":"select_flange","at":17})",
          R"({"edit":"select_flange","between":"1,2","gap":0.5,"max_width":30,"mode":"add"})",
          R"({"edit":"lift","distance":1,"on":{"edit":"select_flange","at":[1,2,3],"gap":1}})",
          R"({"edit":"select_lasso","outline":[[0,0],[1,0],[0,1]],"view":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"visible":false})",
          R"({"edit":"grow","rings":3})",
          R"({"edit":"shrink"})",
          R"({"edit":"invert"})",
          R"({"edit":"hide","on":"3"})",
          R"({"edit":"show"})",
          R"({"edit":"only","on":"1-3"})",
          R"({"edit":"lock","on":"3"})",
          R"({"edit":"unlock"})",
          R"({"edit":"set_target_size","size":5.5,"on":"3"})",
          R"({"edit":"set_target_size","size":"deck"})",
          R"({"edit":"set_criteria","criteria":"strict"})",
          R"({"edit":"set_criteria","criteria":"ours.toml","on":"3","text":"name = \"ours\"\n"})",
          R"({"edit":"translate","by":[0,0,1],"on":"1-100","grab":7,"falloff":{"profile":"gaussian","flat":0.5,"along":[1,0,0]},"free_ends":false,"origin":"free_edge","max_move":2})",
          R"({"edit":"lift","distance":-2.5,"normals":"each","grab":[1,2,3],"on":{"edit":"select_region","at":[0,0,0],"angle":20}})",
          R"({"edit":"slide","by":[3,0,0],"grab":7,"max_move":2,"across_welds":true})",
          R"({"edit":"translate","by":[0,0,1],"free_ends":"weighted","origin":"free_edge","origin_at":[1,2,3]})",
          R"({"edit":"rotate","point":[0,0,1],"axis":[0,2,0],"degrees":-30,"on":"1-9","free_ends":true})",
          R"({"edit":"move","by":[1,2,3],"point":[0,0,1],"axis":[0,2,0],"degrees":-30,"on":"1-9"})",
          R"({"edit":"translate","by":[0,0,1],"symmetry":{"point":[0,1,0],"normal":[0,1,0]}})",
          R"({"edit":"undo"})",
          R"({"edit":"redo"})",
          R"({"edit":"branch","number":3})",
      }) {
    const Result<Edit> edit = parse_edit(text);
    ASSERT_TRUE(edit) << text << ": " << edit.error().text();
    const Json written = edit_to_json(*edit);
    EXPECT_EQ(written["edit"], Json::parse(text)["edit"]);
    // every field that was given comes back as it was
    const Json given = Json::parse(text);
    for (const auto& [key, value] : given.items()) {
      if (key == "on" && value.is_object()) continue;
      EXPECT_EQ(written[key], value) << text << " " << key;
    }
    const Result<Edit> again = parse_edit(written.dump());
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(edit_to_json(*again), written);
  }
}

TEST(EditJson, defaults_are_those_of_the_contract) {
  const auto translate = std::get<Translate>(parse_edit(R"({"edit":"translate","by":[1,2,3]})").value());
  EXPECT_EQ(translate.by, Vec3(1, 2, 3));
  EXPECT_EQ(translate.shaping.weights.falloff.profile, shape::Profile::smooth);
  EXPECT_EQ(translate.shaping.weights.free_ends, shape::FreeEnds::rigid);
  EXPECT_EQ(translate.shaping.weights.origin, shape::Origin::grab);
  EXPECT_FALSE(translate.shaping.on);
  EXPECT_FALSE(translate.shaping.grab);
  EXPECT_FALSE(translate.shaping.max_move);
  const auto select = std::get<Select>(parse_edit(R"({"edit":"select","expr":"1"})").value());
  EXPECT_EQ(select.kind, select::EntityKind::node);
  EXPECT_EQ(select.mode, SelectMode::set);
  EXPECT_EQ(std::get<SelectRegion>(parse_edit(R"({"edit":"select_region","at":1})").value()).angle, 30);
  EXPECT_EQ(std::get<Grow>(parse_edit(R"({"edit":"grow"})").value()).rings, 1);
  EXPECT_FALSE(std::get<Lift>(parse_edit(R"({"edit":"lift","distance":1})").value()).each_normal);
}

TEST(EditJson, doubles_keep_every_bit) {
  for (const double value : {0.1, 1.0 / 3.0, 5e-324, -0.0, 123456789.123456789, 1e299}) {
    Lift lift;
    lift.distance = value;
    const auto back = std::get<Lift>(parse_edit(edit_to_json(lift).dump()).value());
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back.distance), std::bit_cast<std::uint64_t>(value));
  }
}

TEST(EditJson, names_the_nearest_known) {
  EXPECT_EQ(
      why_not(R"({"edit":"lift","distence":1})"),
      "lift has no field \"distence\"; the nearest is \"distance\" (known: edit, distance, normals, on, grab, grab_at, falloff, free_ends, "
      "origin, origin_at, across_welds, symmetry, max_move, contact)");
  EXPECT_THAT(why_not(R"({"edit":"tranlsate","by":[0,0,1]})"), HasSubstr("there is no edit \"tranlsate\"; the nearest is \"translate\""));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"falloff":{"profil":"smooth"}})"),
              HasSubstr("lift: \"falloff\" has no field \"profil\"; the nearest is \"profile\""));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"falloff":{"profile":"smoth"}})"), HasSubstr("the nearest is \"smooth\""));
  EXPECT_THAT(why_not(R"({"edit":"select","expr":"1","kind":"elment"})"), HasSubstr("must be one of node, element, part"));
}

TEST(EditJson, names_the_wrong_type) {
  EXPECT_EQ(why_not(R"({"edit":"lift","distance":"1"})"), "lift: \"distance\" must be a number, not the text \"1\"");
  EXPECT_EQ(why_not(R"({"edit":"translate","by":[0,1]})"), "translate: \"by\" must be a list of 3 numbers, not a list of 2");
  EXPECT_THAT(why_not(R"({"edit":"translate","by":[0,1,"x"]})"), HasSubstr("number 3 must be a number, not the text \"x\""));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"free_ends":1})"), HasSubstr("\"free_ends\" must be true or false"));
  EXPECT_THAT(why_not(R"({"edit":"grow","rings":0})"), HasSubstr("between 1 and"));
  EXPECT_THAT(why_not(R"({"edit":"grow","rings":1.5})"), HasSubstr("between 1 and"));
  EXPECT_THAT(why_not(R"({"edit":"grow","rings":99999999999999999999})"), HasSubstr("between 1 and"));
  EXPECT_THAT(why_not(R"({"edit":"select_region","at":1.5})"), HasSubstr("a node's id or its coordinates"));
  EXPECT_THAT(why_not(R"({"edit":"select_region","at":18446744073709551615})"), HasSubstr("a node's id"));
  EXPECT_THAT(why_not(R"({"edit":"select_region","at":1,"angle":181})"), HasSubstr("between 0"));
  EXPECT_THAT(why_not(R"({"edit":"select_flange","at":"node:1"})"), HasSubstr("a node's id or its coordinates"));
  EXPECT_THAT(why_not(R"({"edit":"select_flange","at":1,"gap":-1})"), HasSubstr("\"gap\" must be"));
  EXPECT_THAT(why_not(R"({"edit":"select_flange","at":1,"max_width":0})"), HasSubstr("greater than 0"));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"max_move":0})"), HasSubstr("greater than 0"));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"falloff":{"along":[0,0,0]}})"), HasSubstr("must be a direction"));
  EXPECT_THAT(why_not(R"({"edit":"lift"})"), HasSubstr("lift needs the field \"distance\""));
  EXPECT_EQ(why_not(R"({"edit":"set_criteria","criteria":5})"), "set_criteria: \"criteria\" must be a text in quotes, not the number 5");
  EXPECT_THAT(why_not(R"({"edit":"set_criteria"})"), HasSubstr("set_criteria needs the field \"criteria\""));
  EXPECT_THAT(why_not(R"({"edit":"set_criteria","criterion":"strict"})"), HasSubstr("the nearest is \"criteria\""));
  EXPECT_THAT(why_not(R"({"distance":1})"), HasSubstr("\"edit\" is missing"));
  EXPECT_THAT(why_not("[1]"), HasSubstr("an edit is an object"));
}

TEST(EditJson, what_is_wrong_within_a_field_is_said) {
  const std::pair<std::string, std::string> cases[] = {
      {R"({"edit":"select_lasso","outline":[[0,0],[1,0],[0,"x"]],"view":[]})",
       R"(select_lasso: "outline" has a wrong point 3: it must be a list of 2 numbers; number 2 must be a number, not the text "x")"},
      {R"({"edit":"select_lasso","outline":[[0,0],[1,0],[0]],"view":[]})",
       R"(select_lasso: "outline" has a wrong point 3: it must be a list of 2 numbers, not a list of 1)"},
      {R"({"edit":"select_lasso","outline":[[0,0],[1,0]],"view":[]})",
       R"(select_lasso: "outline" must be a list of 3 to 100000 points [x, y], not a list of 2)"},
      {R"({"edit":"select_region","at":[0,1]})", R"(select_region: "at" must be a list of 3 numbers, not a list of 2)"},
      {R"({"edit":"select_region","at":[0,1,null]})",
       R"(select_region: "at" must be a list of 3 numbers; number 3 must be a number, not null)"},
      {R"({"edit":"lift","distance":1,"falloff":"smooth"})",
       R"(lift: "falloff" must be an object like {"profile": "smooth"}, not the text "smooth")"},
      {R"({"edit":"relax","max_move":2})", R"(relax: "max_move" must be an object like {"free": 2, "line": 0.5}, not the number 2)"},
      {R"({"edit":"relax","max_move":{"free":0}})", R"(relax: "max_move": "free" must be a number greater than 0, not the number 0)"},
      {R"({"edit":"lift","distance":1,"normals":"all"})",
       R"(lift: "normals" must be "grab" (all nodes along the normal at the grab) or "each", not the text "all")"},
      {R"({"edit":"lift","distance":1,"on":{"edit":"slect"}})",
       R"(lift: "on" has a wrong recipe: there is no edit "slect"; the nearest is "select" (known: )"},
      {R"({"edit":"lift","distance":1,"on":{"edit":"select"}})", R"(lift: "on" has a wrong recipe: select needs the field "expr")"},
      {R"({"edit":"lift","distance":1,"on":[1]})",
       R"(lift: "on" must be an expression in quotes or a recipe like {"edit": "select_region", ...}, not a list of 1)"},
      {R"({"edit":"split","at":[]})", R"(split: "at" must be a list of 1 to 1000 entities like ["shell:12", "shell:40"], not a list of 0)"},
      {R"({"edit":"split","at":["shell:1",2]})",
       R"(split: "at" must be a list of 1 to 1000 entities like ["shell:12", "shell:40"], not the number 2)"},
      {R"({"edit":7})", R"("edit" must be the name of an edit, not the number 7)"},
  };
  for (const auto& [text, words] : cases) EXPECT_THAT(why_not(text), testing::StartsWith(words)) << text;
}

TEST(EditJson, axes_and_planes_are_checked_where_they_are_written) {
  EXPECT_EQ(why_not(R"({"edit":"rotate","point":[0,0,0],"axis":[0,0,0],"degrees":5})"),
            "rotate: \"axis\" must be a direction, not [0, 0, 0]");
  EXPECT_THAT(why_not(R"({"edit":"rotate","point":[0,0,0],"axis":[0,0,1]})"), HasSubstr("needs the field \"degrees\""));
  EXPECT_THAT(why_not(R"({"edit":"rotate","point":[0,0,0],"axis":[0,0,1],"degrees":36001})"), HasSubstr("between -36000"));
  EXPECT_THAT(why_not(R"({"edit":"slide","by":1})"), HasSubstr("slide: \"by\" must be a list of 3 numbers"));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"symmetry":{"point":[0,0,0],"normal":[0,0,0]}})"),
              HasSubstr("lift: \"symmetry\": \"normal\" must be a direction"));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"symmetry":{"point":[0,0,0]}})"), HasSubstr("needs the field \"normal\""));
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"symmetry":[1,0,0]})"), HasSubstr("must be an object like {\"point\""));
}

TEST(EditJson, numbers_that_are_not_finite_are_refused) {
  bool syntax_error = false;
  EXPECT_FALSE(parse_edit(R"({"edit":"lift","distance":1e999})", &syntax_error));
  EXPECT_FALSE(parse_edit(R"({"edit":"lift","distance":NaN})", &syntax_error));
  EXPECT_TRUE(syntax_error);
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 2e300})
    EXPECT_FALSE(edit_from_json(Json{{"edit", "lift"}, {"distance", value}})) << value;
}

TEST(EditJson, syntax_errors_are_told_apart) {
  bool syntax_error = true;
  EXPECT_FALSE(parse_edit(R"({"edit":"lfit"})", &syntax_error));
  EXPECT_FALSE(syntax_error);
  EXPECT_FALSE(parse_edit(R"({"edit":"lift",)", &syntax_error));
  EXPECT_TRUE(syntax_error);
  EXPECT_FALSE(parse_edit("", &syntax_error));
  EXPECT_TRUE(syntax_error);
}

TEST(EditJson, recipes_dont_nest) {
  EXPECT_THAT(why_not(R"({"edit":"lift","distance":1,"on":{"edit":"lift","distance":1}})"), HasSubstr("must be a recipe that selects"));
  std::string deep = R"({"edit":"lift","distance":1,"on":)";
  std::string text;
  for (int i = 0; i < 20000; ++i) text += deep;
  EXPECT_NE(why_not(text + "1" + std::string(20000, '}')), "");
}

}  // namespace
}  // namespace prismesh::mesh::document
