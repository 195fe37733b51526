// What expressions make of operators, comparisons, the deck's sets and its files.
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/select/expression.h"
#include "mesh/select/names.h"
#include "mesh/select/parse.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

using Ids = std::vector<std::int64_t>;
using Role = ReferenceRole;

/// 3 x 3 nodes 10, 20, .. 90; shells 100, 101 of part 3, 205, 206 of part 7 "rail"; beam 9 of part 8 from 90 to 1000.
Model sample() {
  std::vector<test::NodeSpec> nodes;
  for (int i = 0; i < 9; ++i) nodes.push_back({10 * (i + 1), Vec3(i % 3, i / 3, 0)});
  nodes.push_back({1000, Vec3(5, 5, 5)});
  nodes.push_back({9223372036854775807, Vec3(9, 9, 8)});
  return test::make_model(nodes,
                          {{100, 3, {10, 20, 50, 40}}, {101, 3, {20, 30, 60, 50}}, {205, 7, {40, 50, 80, 70}}, {206, 7, {50, 60, 90}}},
                          {{ElementClass::beam, 9, 8, {90, 1000}}});
}

/// What a deck's sets say, made by hand as the readers do.
class Sets {
 public:
  std::uint32_t card(const std::string& keyword, std::int64_t id, const std::string& title, std::optional<Referred> defines) {
    Referrer card;
    card.keyword = keyword;
    card.id = id;
    card.title = title;
    card.defines = defines;
    return references_.add(card);
  }
  Sets& name(std::uint32_t card, Referred referred, Role role, std::int64_t first, std::int64_t last = 0, std::int64_t step = 1,
             bool takes_away = false) {
    references_.add(Reference{referred, role, first, last == 0 ? first : last, step, card, ++line_, takes_away});
    return *this;
  }
  const References& finish() {
    references_.finish();
    return references_;
  }

 private:
  References references_;
  std::uint64_t line_ = 0;
};

class Algebra : public ::testing::Test {
 protected:
  Algebra() {
    const auto list = [&](const char* keyword, std::int64_t id, const char* title, Referred defines, Referred member, const Ids& ids) {
      const std::uint32_t card = sets_.card(keyword, id, title, defines);
      for (const std::int64_t each : ids) sets_.name(card, member, Role::list, each);
      return card;
    };
    list("SET_NODE_LIST_TITLE", 17, "flange nodes", Referred::node_set, Referred::node, {10, 20, 90});
    list("SET_NODE_LIST", 18, "", Referred::node_set, Referred::node, {30});
    list("SET_PART_LIST", 17, "", Referred::part_set, Referred::part, {7});
    list("SET_SHELL_LIST_TITLE", 21, "Skin", Referred::shell_set, Referred::shell, {101, 206});
    const std::uint32_t range = sets_.card("SET_NODE_LIST_GENERATE", 30, "", Referred::node_set);
    sets_.name(range, Referred::node, Role::range, 10, 90, 40);
    const std::uint32_t added = sets_.card("SET_NODE_ADD", 31, "both", Referred::node_set);
    sets_.name(added, Referred::node_set, Role::list, 17).name(added, Referred::node_set, Role::list, 18);
    const std::uint32_t met = sets_.card("SET_NODE_INTERSECT", 32, "", Referred::node_set);
    sets_.name(met, Referred::node_set, Role::list, 17).name(met, Referred::node_set, Role::list, 30);
    const std::uint32_t general = sets_.card("SET_NODE_GENERAL", 33, "", Referred::node_set);
    sets_.name(general, Referred::part, Role::single, 3).name(general, Referred::node, Role::single, 50, 50, 1, true);
    const std::uint32_t own = sets_.card("SET_NODE_ADD", 34, "", Referred::node_set);
    sets_.name(own, Referred::node_set, Role::list, 34);
    list("SET_NODE_LIST_TITLE", 40, "twice", Referred::node_set, Referred::node, {10});
    list("SET_NODE_LIST_TITLE", 41, "TWICE", Referred::node_set, Referred::node, {20});
    list("SET_BEAM", 50, "", Referred::beam_set, Referred::beam, {9});
    list("SET_SOLID", 50, "", Referred::solid_set, Referred::solid, {1});
    list("SET_NODE_LIST", 60, "", Referred::node_set, Referred::node, {12345});
    const std::uint32_t grids = sets_.card("SET", 70, "", std::nullopt);  // Nastran's case control: used for both
    sets_.name(grids, Referred::node, Role::list, 10).name(grids, Referred::any_element, Role::list, 100);
    sets_.name(sets_.card("SET1", 71, "", std::nullopt), Referred::part, Role::list, 7);
    sets_.name(sets_.card("SET3", 72, "", std::nullopt), Referred::any_element, Role::list, 101);
    const std::uint32_t nset = sets_.card("NSET", 0, "NTop", std::nullopt);
    sets_.name(nset, Referred::node, Role::list, 70, 80, 10);
    const std::uint32_t elset = sets_.card("ELSET", 0, "rail-mesh", std::nullopt);
    sets_.name(elset, Referred::any_element, Role::range, 200, 300);
    const std::uint32_t group = sets_.card("/GRNOD/NODE", 80, "Gruppe", std::nullopt);
    sets_.name(group, Referred::node, Role::list, 60);
    const std::uint32_t load = sets_.card("BOUNDARY_SPC_NODE", 90, "no set", std::nullopt);
    sets_.name(load, Referred::node, Role::single, 60);
    names_.references = &sets_.finish();
    names_.files = {"main.k", "sub/bumper.k", "roof/welds.k", "floor/welds.k"};
    // nodes up to 60 and part 3's shells: the bumper; 90 and 1000: the roof's welds
    names_.file_of_node = [](NodeIndex node) { return node.value < 6 ? 1u : node.value == 8 || node.value == 9 ? 2u : 0u; };
    names_.file_of_shell = [](ShellIndex shell) { return shell.value < 2 ? 1u : 0u; };
  }

  Ids of(std::string_view expression, EntityKind kind = EntityKind::node) {
    const auto chosen = evaluate(model_, expression, kind, names_);
    EXPECT_TRUE(chosen.has_value()) << expression << ": " << chosen.error().text();
    Ids ids;
    if (!chosen) return ids;
    if (kind == EntityKind::node)
      for (const NodeIndex node : chosen->nodes) ids.push_back(model_.node_ids[node.value]);
    if (kind == EntityKind::element)
      for (const ShellIndex shell : chosen->shells) ids.push_back(model_.shell_ids[shell.value]);
    if (kind == EntityKind::part)
      for (const PartIndex part : chosen->parts) ids.push_back((*model_.parts)[part.value].id);
    return ids;
  }
  std::string error_of(std::string_view expression, EntityKind kind = EntityKind::node) {
    const auto chosen = evaluate(model_, expression, kind, names_);
    return chosen ? "no error" : chosen.error().text();
  }

  Model model_ = sample();
  Sets sets_;
  Names names_;
};

TEST_F(Algebra, joins_meets_and_turns_over) {
  EXPECT_EQ(of("10-50 & 30-90"), (Ids{30, 40, 50}));
  EXPECT_EQ(of("10|30|20"), (Ids{10, 20, 30}));
  EXPECT_EQ(of("10-90 & ~20-80"), (Ids{10, 90}));
  EXPECT_EQ(of("10-90 & !20-80"), (Ids{10, 90}));
  EXPECT_EQ(of("~part:3 & ~node:1000-9223372036854775807"), (Ids{70, 80, 90}));
  EXPECT_EQ(of("~~10"), (Ids{10}));
  EXPECT_EQ(of("part:3 & part:7"), (Ids{40, 50, 60}));
  EXPECT_EQ(of("part:3 & part:7", EntityKind::element), Ids());
  EXPECT_EQ(of("~part:3", EntityKind::element), (Ids{205, 206}));
  EXPECT_EQ(of("~3", EntityKind::part), (Ids{7, 8}));
  EXPECT_EQ(of("!3", EntityKind::part), Ids());  // as ever: takes away from nothing
}

TEST_F(Algebra, binds_meeting_before_joining_before_commas) {
  EXPECT_EQ(of("10|20&30"), (Ids{10}));
  EXPECT_EQ(of("(10|20)&20"), (Ids{20}));
  EXPECT_EQ(of("10,20&20-30"), (Ids{10, 20}));
  EXPECT_EQ(of("(10,20)&20-30"), (Ids{20}));
  EXPECT_EQ(of("10-90,!20-40|60-80"), (Ids{10, 50, 90}));
  EXPECT_EQ(of("10-90,!(20-80 & ~50)"), (Ids{10, 50, 90}));
  EXPECT_EQ(of("10-90 & (!20-80)"), (Ids{10, 90}));  // within parentheses taking away begins with everything
  EXPECT_EQ(of("10-90 & (20-80,!50)"), (Ids{20, 30, 40, 60, 70, 80}));
  EXPECT_EQ(of("((((10))))"), (Ids{10}));
}

TEST_F(Algebra, obeys_the_laws_of_sets) {
  const std::vector<std::string> terms{"10-40",    "part:7", "shell:100",     "set:17", "id>45",        "10-90:20",
                                       "(10,!10)", "all",    "file:bumper.k", "id!=50", "set:\"both\"", "20|60"};
  std::mt19937 random(5);
  const auto pick = [&] { return "(" + terms[random() % terms.size()] + ")"; };
  for (int i = 0; i < 300; ++i) {
    const std::string a = pick(), b = pick(), c = pick();
    EXPECT_EQ(of("~(" + a + "|" + b + ")"), of("~" + a + "&~" + b)) << a << b;
    EXPECT_EQ(of("~(" + a + "&" + b + ")"), of("~" + a + "|~" + b)) << a << b;
    EXPECT_EQ(of(a + "&(" + b + "|" + c + ")"), of(a + "&" + b + "|" + a + "&" + c)) << a << b << c;
    EXPECT_EQ(of(a + ",!" + b), of(a + "&~" + b)) << a << b;
    EXPECT_EQ(of(a + "," + b), of(b + "|" + a)) << a << b;
  }
}

TEST_F(Algebra, compares_ids) {
  EXPECT_EQ(of("id>70 & id<1000"), (Ids{80, 90}));
  EXPECT_EQ(of("id >= 80 & id <= 90"), (Ids{80, 90}));
  EXPECT_EQ(of("ID<=20"), (Ids{10, 20}));
  EXPECT_EQ(of("id=20,id==30"), (Ids{20, 30}));
  EXPECT_EQ(of("10-30 & id!=20"), (Ids{10, 30}));
  EXPECT_EQ(of("id!=10").size(), 10u);
  EXPECT_EQ(of("id>=9223372036854775807"), (Ids{9223372036854775807}));
  EXPECT_EQ(of("shell:id>205"), (Ids{50, 60, 90}));
  EXPECT_EQ(of("shell:id!=100", EntityKind::element), (Ids{101, 205, 206}));
  EXPECT_EQ(of("part:id<=3", EntityKind::element), (Ids{100, 101}));
  EXPECT_EQ(of("id>3", EntityKind::part), (Ids{7, 8}));
  EXPECT_EQ(error_of("id<10"), "expression:1: no node has such an id; the nearest is node:10");
  EXPECT_EQ(error_of("beam:id!=9"), "expression:1: no beam has such an id; the nearest is beam:9");
  EXPECT_EQ(error_of("id>9223372036854775807"), "expression:3: no id is greater than 9223372036854775807");
}

TEST_F(Algebra, names_sets_by_id_and_by_name) {
  EXPECT_EQ(of("set:17"), (Ids{10, 20, 90}));
  EXPECT_EQ(of("set:\"flange nodes\""), (Ids{10, 20, 90}));
  EXPECT_EQ(of("set:'FLANGE Nodes'"), (Ids{10, 20, 90}));
  EXPECT_EQ(of("set:17-18"), (Ids{10, 20, 30, 90}));
  EXPECT_EQ(of("set:30"), (Ids{10, 50, 90}));
  EXPECT_EQ(of("set:skin"), (Ids{20, 30, 50, 60, 90}));
  EXPECT_EQ(of("set:21", EntityKind::element), (Ids{101, 206}));
  EXPECT_EQ(of("part_set:17"), (Ids{40, 50, 60, 70, 80, 90}));
  EXPECT_EQ(of("set:17", EntityKind::part), (Ids{7}));
  EXPECT_EQ(of("node_set:17", EntityKind::element), (Ids{100, 101, 206}));
  EXPECT_EQ(of("beam_set:50"), (Ids{90, 1000}));
  EXPECT_EQ(of("set:id<19"), (Ids{10, 20, 30, 90}));
  EXPECT_EQ(of("set:18-60:12"), (Ids{10, 30, 50, 90}));  // 18 and 30; 60 holds nothing
}

TEST_F(Algebra, follows_sets_made_of_sets) {
  EXPECT_EQ(of("set:31"), (Ids{10, 20, 30, 90}));
  EXPECT_EQ(of("set:32"), (Ids{10, 90}));
  EXPECT_EQ(of("set:33"), (Ids{10, 20, 30, 40, 60}));  // part 3 without node 50
  EXPECT_EQ(error_of("10,set:34"), "expression:4: node_set:34 contains itself, or contains sets nested deeper than 32 levels");
}

TEST(SetsOfSets, take_away_what_inner_sets_hold) {
  Sets sets;
  for (const std::int64_t id : {1, 2})
    sets.name(sets.card("SET_NODE_LIST", id, "", Referred::node_set), Referred::node, Role::range, 10 * id, 30, 10);
  const std::uint32_t added = sets.card("SET_NODE_ADD", 3, "", Referred::node_set);
  sets.name(added, Referred::node_set, Role::list, 1).name(added, Referred::node_set, Role::single, 2, 2, 1, true);
  const Names names{&sets.finish(), {}, {}, {}};
  const Model model = sample();
  const auto chosen = evaluate(model, "set:3", EntityKind::node, names);
  ASSERT_TRUE(chosen.has_value()) << chosen.error().text();
  ASSERT_EQ(chosen->nodes.size(), 1u);
  EXPECT_EQ(model.node_ids[chosen->nodes[0].value], 10);
}

/// Each set up to `last` is made of the next one, named `times` times; the last holds node 10.
std::string error_of_chain(std::int64_t last, int times) {
  Sets sets;
  for (std::int64_t id = 1; id < last; ++id) {
    const std::uint32_t card = sets.card("SET_NODE_ADD", id, "", Referred::node_set);
    for (int time = 0; time < times; ++time) sets.name(card, Referred::node_set, Role::single, id + 1);
  }
  sets.name(sets.card("SET_NODE_LIST", last, "", Referred::node_set), Referred::node, Role::list, 10);
  const Names names{&sets.finish(), {}, {}, {}};
  const auto chosen = evaluate(sample(), "set:1", EntityKind::node, names);
  return chosen ? "" : chosen.error().text();
}

TEST(SetsOfSets, go_32_deep_and_no_deeper) {
  EXPECT_EQ(error_of_chain(33, 1), "");
  EXPECT_EQ(error_of_chain(34, 1), "expression:1: node_set:34 contains itself, or contains sets nested deeper than 32 levels");
}

TEST(SetsOfSets, that_multiply_are_refused) {
  EXPECT_EQ(error_of_chain(10, 2), "");
  EXPECT_NE(error_of_chain(20, 2).find("contains too many sets"), std::string::npos);
}

TEST_F(Algebra, takes_any_number_of_parentheses_beside_each_other) {
  std::string expression = "(10)";
  for (int i = 0; i < 2 * kMaxParenthesisDepth; ++i) expression += ",(20)";
  EXPECT_EQ(of(expression), (Ids{10, 20}));
}

TEST_F(Algebra, names_the_sets_of_the_other_formats) {
  EXPECT_EQ(of("set:70"), (Ids{10}));
  EXPECT_EQ(of("set:70", EntityKind::element), (Ids{100}));
  EXPECT_EQ(of("set:ntop"), (Ids{70, 80}));
  EXPECT_EQ(of("set:rail-mesh", EntityKind::element), (Ids{205, 206}));
  EXPECT_EQ(of("element_set:\"RAIL-MESH\" & ~part:3"), (Ids{70, 80, 90}));
  EXPECT_EQ(of("set:80"), (Ids{60}));
  EXPECT_EQ(of("set:gruppe"), (Ids{60}));
  // Nastran's are of what their numbers name
  EXPECT_EQ(of("part_set:71", EntityKind::element), (Ids{205, 206}));
  EXPECT_EQ(of("element_set:72", EntityKind::element), (Ids{101}));
  EXPECT_EQ(error_of("node_set:71"), "expression:1: there is no node set 71; the nearest is node_set:70");
}

TEST_F(Algebra, says_which_set_is_near) {
  EXPECT_EQ(error_of("10,set:19"), "expression:4: there is no set 19; the nearest is node_set:18");
  EXPECT_EQ(error_of("set:\"flange node\""), "expression:1: there is no set \"flange node\"; did you mean \"flange nodes\"?");
  EXPECT_EQ(error_of("shell_set:17"), "expression:1: there is no shell set 17; the nearest is shell_set:21");
  EXPECT_EQ(error_of("tshell_set:17"), "expression:1: there is no tshell set in the deck");
  EXPECT_EQ(error_of("part_set:x"), "expression:1: there is no part set \"x\": no part set has a name; the first is part_set:17");
  EXPECT_EQ(error_of("set:twice"), "expression:1: several sets are called \"twice\": write node_set:40 or node_set:41");
  EXPECT_EQ(error_of("set:50"), "expression:1: several sets are called 50: write beam_set:50 or solid_set:50");
  EXPECT_EQ(error_of("set:60"), "expression:1: node_set:60 holds nothing that can be selected here");
  EXPECT_EQ(error_of("set:90"), "expression:1: there is no set 90; the nearest is node_set:80");
  EXPECT_EQ(error_of("set:0"), "expression:1: sets are numbered from 1");
  names_ = {};
  EXPECT_EQ(error_of("set:1"), "expression:1: there is no set in the deck");
}

TEST_F(Algebra, names_what_stands_in_a_file) {
  EXPECT_EQ(of("file:sub/bumper.k"), (Ids{10, 20, 30, 40, 50, 60}));
  EXPECT_EQ(of("file:bumper.k", EntityKind::element), (Ids{100, 101}));
  EXPECT_EQ(of("file:BUMPER.K", EntityKind::part), (Ids{3}));
  EXPECT_EQ(of("file:\"roof/welds.k\""), (Ids{90, 1000}));
  EXPECT_EQ(of("file:roof/welds.k", EntityKind::part), (Ids{8}));
  EXPECT_EQ(error_of("file:roof/welds.k", EntityKind::element), "expression:1: no shell is in the file \"roof/welds.k\"");
  EXPECT_EQ(error_of("file:welds.k"), "expression:1: several files are called \"welds.k\": write \"roof/welds.k\" or \"floor/welds.k\"");
  EXPECT_EQ(error_of("10,file:bumpr.k"), "expression:4: there is no file \"bumpr.k\" in the deck; did you mean \"bumper.k\"?");
  EXPECT_EQ(error_of("file:umper.k"), "expression:1: there is no file \"umper.k\" in the deck; did you mean \"bumper.k\"?");
}

TEST_F(Algebra, ends_a_name_before_whatever_comes_next) {
  for (const char* expression : {"set:ntop|10", "set:ntop,10", "set:ntop\t,10", "(set:ntop),10", "set:ntop&70-80,10"})
    EXPECT_EQ(of(expression), (Ids{10, 70, 80})) << expression;
}

TEST_F(Algebra, says_when_a_range_of_sets_holds_nothing) {
  EXPECT_EQ(error_of("set:60-65"), "expression:1: these sets hold nothing that can be selected here");
  EXPECT_EQ(of("set:60-70"), (Ids{10})) << "one that does is enough";
}

TEST_F(Algebra, names_parts_by_their_names) {
  EXPECT_EQ(of("part:\"Part 7\"", EntityKind::element), (Ids{205, 206}));
  EXPECT_EQ(error_of("part:'part 5'"), "expression:1: there is no part \"part 5\"; did you mean \"part 3\"?");
}

TEST_F(Algebra, tells_surfaces_from_nodes) {
  const auto of_surfaces = [&](std::string_view expression) {
    return evaluate(model_, expression, EntityKind::node, names_).value().of_surfaces;
  };
  for (const char* expression : {"part:3", "shell:100 & part:3", "set:skin", "part_set:17", "file:bumper.k"})
    EXPECT_TRUE(of_surfaces(expression)) << expression;
  for (const char* expression :
       {"10", "part:3,10", "set:17", "beam:9", "all", "part:3 & id>10", "10,part:3", "set:17,part_set:17", "beam:9,shell:100"})
    EXPECT_FALSE(of_surfaces(expression)) << expression;
}

TEST_F(Algebra, points_at_what_it_cannot_read) {
  const std::string deep(40, '(');
  const std::vector<std::pair<std::string, std::string>> cases{
      {"(10", "expression:4: the expression ends where a ) is expected: the ( at column 1 is open"},
      {"10)", "expression:3: this ) closes no ("},
      {"(10 20)", "expression:5: unexpected '2' within parentheses: items are separated by commas"},
      {"()", "expression:2: unexpected ')' where an id is expected"},
      {"10&", "expression:4: the expression ends where an id is expected"},
      {"10|,20", "expression:4: unexpected ',' where an id is expected"},
      {"10,!!20", "expression:5: unexpected '!' where an id is expected"},
      {"id", "expression:3: a comparison must follow \"id\", as in id>5000"},
      {"id~5", "expression:3: a comparison must follow \"id\", as in id>5000"},
      {"id>", "expression:4: the expression ends where an id is expected"},
      {"id>x", "expression:4: unexpected 'x' where an id is expected"},
      {"it>5", "expression:1: unknown word \"it\"; did you mean \"id\"?"},
      {"shel:3", "expression:1: unknown word \"shel\"; did you mean \"shell\"?"},
      {"sett:3", "expression:1: unknown word \"sett\"; did you mean \"set\"?"},
      {"set:\"open", "expression:5: the name that begins here has no closing '\"'"},
      {"set:\"\"", "expression:5: there is no name between the quotes"},
      {"set:", "expression:5: the expression ends where an id is expected"},
      {"file:", "expression:6: the expression ends where a name is expected"},
      {"file: ,", "expression:7: a name is expected here"},
      {"file", "expression:5: a colon and a name must follow \"file\", as in file:bumper.k"},
      {"10,part:x", "expression:9: an id or all must follow \"part:\", not \"x\""},
      {deep, "expression:33: parentheses go deeper than 32"},
      {std::string(1001, '~') + "10", "expression:1001: there are more than 1000 of & | ~ ( in the expression"},
  };
  for (const auto& [expression, message] : cases) EXPECT_EQ(error_of(expression), message) << expression.substr(0, 50);
}

TEST_F(Algebra, takes_any_number_of_commas) {
  std::string text = "10";
  for (int i = 0; i < 20000; ++i) text += i % 2 == 0 ? ",!20" : ",20";
  EXPECT_EQ(of(text), (Ids{10, 20}));
}

}  // namespace
}  // namespace prismesh::mesh::select
