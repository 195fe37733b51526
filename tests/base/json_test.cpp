#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/json/nesting.h"
#include "base/json/read.h"
#include "base/json/write.h"

namespace prismesh::json {
namespace {

enum class Colour { red, green, blue };
struct Point {
  std::array<double, 3> at{};
  bool free = false;
};
struct Sample {
  std::string name;
  Colour colour = Colour::red;
  std::optional<double> share;
  double length = 0;
  int rings = 1;
  std::uint8_t small = 0;
  std::vector<std::string> tags{"none"};
  std::optional<Point> point;
  bool each = false;
};

}  // namespace

PRISMESH_JSON_NAMES(Colour, {{"red", Colour::red}, {"green", Colour::green}, {"blue", Colour::blue}});
template <>
struct Definition<Point> {
  static constexpr std::string_view kExample = R"({"at": [0, 0, 1]})";
  static bool is_absent(const Point& m) { return m.free; }
  static void fields(auto& m, auto& f) { f.required("at", m.at); }
};
PRISMESH_JSON_OBJECT(Sample, f.required("name", m.name), f("colour", m.colour), f("share", m.share, NumberLimits{0, 1}),
                     f("length", m.length, NumberLimits{0, kMaxNumber, true}), f("rings", m.rings, WholeNumberLimits{1, 9}),
                     f("small", m.small), f("tags", m.tags, ListLimits{1, 3, "tags", "tag"}), f("point", m.point),
                     f("each", m.each, TwoWords{"one", "each", "\"one\" or \"each\""}));

namespace {

std::string wrong(const std::string& text, Author author) {
  Sample sample;
  return read(Json::parse(text), sample, author).value_or("");
}
std::string told_person(const std::string& text) { return wrong(text, Author::person); }
std::string told_program(const std::string& text) { return wrong(text, Author::program); }

TEST(JsonFields, are_read_and_written_by_one_definition) {
  const std::string text =
      R"({"colour":"blue","each":"each","length":2.5,"name":"a","point":{"at":[1.0,2.0,3.0]},"rings":3,"share":0.5,"small":7,"tags":["x","y"]})";
  for (const Author author : {Author::person, Author::program}) {
    Sample sample;
    ASSERT_FALSE(read(Json::parse(text), sample, author));
    EXPECT_EQ(sample.colour, Colour::blue);
    EXPECT_TRUE(sample.each);
    EXPECT_EQ(sample.tags, (std::vector<std::string>{"x", "y"}));
    EXPECT_EQ(to_line(to_json(sample)), text);
  }
}

TEST(JsonFields, that_are_missing_keep_their_defaults_and_empty_ones_are_not_written) {
  Sample sample;
  ASSERT_FALSE(read(Json::parse(R"({"name":"a"})"), sample, Author::person));
  EXPECT_EQ(to_line(to_json(sample)), R"({"colour":"red","each":"one","length":0.0,"name":"a","rings":1,"small":0,"tags":["none"]})");
  sample.point = Point{{}, true};
  EXPECT_FALSE(to_json(sample).contains("point")) << "its definition calls it absent";
}

TEST(JsonFields, say_a_person_what_stands_there_and_what_is_known) {
  EXPECT_EQ(told_person(R"({"name":7})"), R"(: "name" must be a text in quotes, not the number 7)");
  EXPECT_EQ(told_person(R"({"colour":"gren"})"),
            R"(: "colour" must be one of red, green, blue, not the text "gren"; the nearest is "green")");
  EXPECT_EQ(told_person(R"({"share":1.5})"), R"(: "share" must be a number between 0.0 and 1.0, not the number 1.500000)");
  EXPECT_EQ(told_person(R"({"share":null})"), R"(: "share" must be a number between 0.0 and 1.0, not null)");
  EXPECT_EQ(told_person(R"({"length":0})"), R"(: "length" must be a number greater than 0, not the number 0)");
  EXPECT_EQ(told_person(R"({"rings":10})"), R"(: "rings" must be a whole number between 1 and 9, not the number 10)");
  EXPECT_EQ(told_person(R"({"tags":[]})"), R"(: "tags" must be a list of 1 to 3 tags, not a list of 0)");
  EXPECT_EQ(told_person(R"({"tags":["a",true]})"), R"(: "tags" has a wrong tag 2: it must be a text in quotes, not true)");
  EXPECT_EQ(told_person(R"({"each":{}})"), R"(: "each" must be "one" or "each", not an object)");
  EXPECT_EQ(told_person(R"({"point":[1]})"), R"(: "point" must be an object like {"at": [0, 0, 1]}, not a list of 1)");
  EXPECT_EQ(told_person(R"({"point":{"at":[0,1]}})"), R"(: "point": "at" must be a list of 3 numbers, not a list of 2)");
  EXPECT_TRUE(told_person(R"({"point":{"at":[0,1,1e301]}})")
                  .starts_with(R"(: "point": "at" must be a list of 3 numbers; number 3 must be a number, not the number 1)"));
  EXPECT_EQ(told_person("{}"), R"(needs the field "name")");
  EXPECT_EQ(told_person(R"({"point":{}})"), R"(: "point" needs the field "at")");
  EXPECT_EQ(told_person(R"({"name":7,"point":{"att":1}})"), R"(: "name" must be a text in quotes, not the number 7)");
  EXPECT_EQ(told_person(R"({"point":{"att":1},"nmae":"a"})"),
            R"(has no field "nmae"; the nearest is "name" (known: name, colour, share, length, rings, small, tags, point, each))")
      << "the outer object's unknown field comes first";
  EXPECT_EQ(told_person(R"({"point":{"att":1}})"), R"(: "point" has no field "att"; the nearest is "at" (known: at))");
}

TEST(JsonFields, tell_a_program_in_short_and_ignore_what_a_newer_one_adds) {
  EXPECT_EQ(told_program(R"({"name":7})"), R"(field "name" must be a text in quotes)");
  EXPECT_EQ(told_program(R"({"colour":"gren"})"), R"(field "colour" must be "red", "green" or "blue")");
  EXPECT_EQ(told_program(R"({"small":256})"), R"(field "small" is too large)");
  EXPECT_EQ(told_program(R"({"small":-1})"), R"(field "small" must not be negative)");
  EXPECT_EQ(told_program(R"({"point":{"at":[0,1,"2"]}})"),
            R"(field "point" field "at" must be a list of three numbers: one must be a number)");
  EXPECT_EQ(told_program("{}"), R"(field "name" is missing)");
  EXPECT_EQ(told_program(R"({"name":"a","share":null,"mood":"sunny","point":{"at":[0,1,2],"mood":"sunny"}})"), "");
}

TEST(JsonFields, unknown_ones_are_found_on_request) {
  const Json json = Json::parse(R"({"att":1})");
  FieldReader none(json, Author::program);
  EXPECT_EQ(none.unknown_field(), R"(has no field "att": it has none)");
  FieldReader reader(json, Author::program);
  Point point;
  Definition<Point>::fields(point, reader);
  EXPECT_EQ(reader.unknown_field(), R"(has no field "att"; the nearest is "at")");
}

TEST(JsonText, is_measured_before_it_is_parsed) {
  EXPECT_FALSE(is_nested_deeper("[[]]", 2));
  EXPECT_TRUE(is_nested_deeper("[[[", 2));
  EXPECT_TRUE(is_nested_deeper(R"({"a":{"b":[)", 2));
  EXPECT_FALSE(is_nested_deeper("[[],[],{}]", 2)) << "side by side";
  EXPECT_FALSE(is_nested_deeper(R"(["[[[", "\"[["])", 2)) << "within texts";
}

TEST(JsonText, that_is_not_utf8_is_replaced) { EXPECT_EQ(to_line(Json("caf\xe9")), "\"caf\xef\xbf\xbd\""); }

}  // namespace
}  // namespace prismesh::json
