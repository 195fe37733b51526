// Scripts with parameters: where values go, that they stay values, and what is wrong by file and line.
#include "mesh/batch/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::mesh::batch {
namespace {

using ::testing::HasSubstr;

const std::vector<Parameter> kParameters{{"height", {}, 0, 1}, {"part", {}, 0, 1}, {"rings", {}, 0, 1}};

Result<std::vector<ScriptEdit>> made(const std::string& text, std::vector<ParameterValue> values = {2.5, "part:3", 4.0}) {
  return edits_with({"s.jsonl", text}, kParameters, values);
}

TEST(ScriptTest, values_take_their_places) {
  const auto edits = made(
      "{\"edit\": \"translate\", \"on\": \"${part},!7\", \"by\": [0, 0, \"${height}\"]}\n\n"
      "{\"edit\": \"grow\", \"rings\": \"${rings}\"}\r\n{\"edit\": \"select\", \"expr\": \"1-${rings}\"}");
  ASSERT_TRUE(edits) << edits.error().text();
  ASSERT_EQ(edits->size(), 3U);
  EXPECT_THAT((*edits)[0].json, HasSubstr("[0,0,2.5]"));
  EXPECT_THAT((*edits)[0].json, HasSubstr("\"part:3,!7\""));
  EXPECT_EQ((*edits)[0].line, 1);
  EXPECT_THAT((*edits)[1].json, HasSubstr("\"rings\":4}"));
  EXPECT_EQ((*edits)[1].line, 3);
  EXPECT_THAT((*edits)[2].json, HasSubstr("\"1-4\""));
}

TEST(ScriptTest, a_value_is_never_read_as_json_and_names_of_fields_are_untouched) {
  const auto edits = made("{\"edit\": \"select\", \"expr\": \"${part}\"}", {1.0, "1\", \"mode\": \"add", 1.0});
  ASSERT_TRUE(edits);
  EXPECT_THAT((*edits)[0].json, HasSubstr("\"1\\\", \\\"mode\\\": \\\"add\""));
  const auto twice = made("{\"edit\": \"select\", \"expr\": \"${part}\"}", {1.0, "${height}", 1.0});
  ASSERT_TRUE(twice);
  EXPECT_THAT((*twice)[0].json, HasSubstr("\"${height}\"")) << "values aren't searched for parameters";
  const auto name = made("{\"edit\": \"grow\", \"${rings}\": 2}");
  ASSERT_FALSE(name);
}

TEST(ScriptTest, what_is_wrong_is_said_with_its_line) {
  const std::pair<const char*, const char*> wrong[] = {
      {"{\"edit\": \"undo\"}\n{\"edit\": \"lift\", \"distance\": \"${hight}\"}",
       "s.jsonl:2: the plan has no parameter \"hight\"; the nearest known is \"height\""},
      {"{\"edit\": \"lift\", \"distance\": \"${height\"}", "s.jsonl:1: \"${height\" has a ${ without its }"},
      {"\n{\"edit\": ", "s.jsonl:2: "},
      {"{\"edit\": \"lift\", \"distanze\": 1}", "s.jsonl:1: "},
      {"{\"edit\": \"lift\", \"distance\": \"${part}\"}", "s.jsonl:1: "},
      {"{\"edit\": \"grow\", \"rings\": \"${height}\"}", "s.jsonl:1: "},
  };
  for (const auto& [text, words] : wrong) {
    const auto edits = made(text);
    ASSERT_FALSE(edits) << text;
    EXPECT_THAT(edits.error().text(), HasSubstr(words));
  }
  EXPECT_FALSE(made(std::string(500, '[')));
}

TEST(ScriptTest, the_parameters_of_a_script) {
  const auto named = parameters_named({"s.jsonl", "{\"a\": [\"${b}\", {\"c\": \"x${a}${b}\"}]}\n{\"edit\": \"undo\"}\n"});
  ASSERT_TRUE(named);
  EXPECT_EQ(*named, (std::vector<std::string>{"a", "b"}));
}

}  // namespace
}  // namespace prismesh::mesh::batch
