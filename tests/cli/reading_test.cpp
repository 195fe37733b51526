// info, check, diff, distance: the commands that only read.
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

using nlohmann::json;
using ::testing::Not;

TEST_F(Cli, info_has_every_field) {
  const std::string deck = write("plate.k", plate_text());
  const Outcome outcome = prismesh({"info", deck, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json info = outcome.json();
  EXPECT_EQ(info["format"], "ls-dyna");
  EXPECT_EQ(info["files"], json::array({deck}));
  EXPECT_EQ(info["length_unit"], "mm");
  EXPECT_EQ(info["target_size"], 5.0);
  EXPECT_EQ(info["nodes"], 35);
  EXPECT_EQ(info["elements"],
            (json{{"quad", 24}, {"tri", 0}, {"quad8", 0}, {"tri6", 0}, {"beam", 0}, {"solid", 0}, {"tshell", 0}, {"other", 0}}));
  EXPECT_EQ(info["elements_left_out"],
            (json{{"quad", 0}, {"tri", 0}, {"quad8", 0}, {"tri6", 0}, {"beam", 0}, {"solid", 0}, {"tshell", 0}, {"other", 0}}));
  EXPECT_EQ(info["parts"], json::array({{{"id", 7},
                                         {"name", "plate"},
                                         {"quads", 24},
                                         {"tris", 0},
                                         {"thickness", 1.2},
                                         {"box", {{0.0, 0.0, 0.0}, {30.0, 20.0, 0.0}}},
                                         {"target_size", 5.0},
                                         {"target_size_from", "part"},
                                         {"criteria", "default"}}}));
  EXPECT_EQ(info["warnings"], json::array());
  EXPECT_EQ(outcome.err, "");
  const Outcome text = prismesh({"info", deck});
  EXPECT_THAT(text.out, Not(HasSubstr("left out")));
  EXPECT_THAT(text.out, HasSubstr("target size  5 mm (guessed)"));
  EXPECT_THAT(text.out, HasSubstr("part:7  plate  24 quads, 0 triangles, 1.2 mm thick"));
}

TEST_F(Cli, what_is_missing_is_a_warning_with_its_place) {
  std::string text = plate_text();
  text.insert(text.find("*PART"), "*INCLUDE\nnowhere.k\n*ELEMENT_SHELL\n" + shell_card(2000, 7, 101, 102, 109, 999));
  const std::string deck = write("plate.k", text);
  const Outcome outcome = prismesh({"info", deck, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json warnings = outcome.json()["warnings"];
  ASSERT_EQ(warnings.size(), 2u) << warnings;
  EXPECT_EQ(outcome.json()["elements"]["quad"], 24);
  EXPECT_EQ(outcome.json()["elements_left_out"]["quad"], 1);
  EXPECT_EQ(prismesh({"check", deck, "--json"}).json()["elements"], 24);
  EXPECT_THAT(prismesh({"info", deck}).out, HasSubstr("left out     1 shell, 0 beams, 0 solids, 0 thick shells, 0 more: see the warnings"));
  std::vector<std::string> kinds;
  for (const json& warning : warnings) {
    EXPECT_EQ(warning["file"], deck);
    EXPECT_GT(warning["line"], 0);
    EXPECT_EQ(warning["count"], 1);
    kinds.push_back(warning["kind"]);
  }
  EXPECT_THAT(kinds, ::testing::UnorderedElementsAre("missing-include", "undefined-node"));
  EXPECT_THAT(prismesh({"check", deck}).err, HasSubstr("nowhere.k"));
}

TEST_F(Cli, what_is_no_deck_is_refused_in_one_line) {
  const std::string picture = write("picture.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16));
  const std::string prose = write("letter.txt", "Dear colleague,\nplease find attached nothing.\n");
  const std::string empty = write("empty.k", "");
  for (const std::string& file : {picture, prose, empty, path("absent.k"), folder.string()}) {
    for (const char* command : {"info", "check"}) {
      const Outcome outcome = prismesh({command, file, "--json"});
      EXPECT_EQ(outcome.status, kFailed) << file;
      EXPECT_THAT(outcome.err, StartsWith(file)) << file;
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
      EXPECT_EQ(outcome.out, "");
    }
  }
}

TEST_F(Cli, text_that_is_not_utf_8_appears_escaped) {
  std::string text = plate_text();
  text.replace(text.find("plate\n    "), 5, "T\xfcr\x01");
  const Outcome outcome = prismesh({"info", write("plate.k", text), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(outcome.json()["parts"][0]["name"], "T\\xFCr\\x01");
}

TEST_F(Cli, check_has_every_field) {
  std::string text = plate_text();
  const std::string flat = node_card(109, 5, 5, 0);
  text.replace(text.find(flat), flat.size(), node_card(109, 5, 5, 2.5));  // warps the four shells around it
  const std::string deck = write("plate.k", text);
  const Outcome outcome = prismesh({"check", deck, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json check = outcome.json();
  EXPECT_EQ(check["elements"], 24);
  EXPECT_EQ(check["ok"], 20);
  EXPECT_EQ(check["warn"], 0);
  EXPECT_EQ(check["fail"], 4);
  EXPECT_EQ(check["triangles_percent"], 0.0);
  ASSERT_EQ(check["metrics"].size(), 11u);
  for (const char* name : {"warpage", "aspect", "skew", "jacobian", "taper", "min_angle_quad", "max_angle_quad", "min_angle_tri",
                           "max_angle_tri", "min_length", "max_length"}) {
    const json& metric = check["metrics"][name];
    for (const char* field : {"min", "mean", "max", "warn", "fail", "worst"}) EXPECT_TRUE(metric.contains(field)) << name << field;
  }
  EXPECT_EQ(check["metrics"]["warpage"]["fail"], 4);
  EXPECT_THAT(check["metrics"]["warpage"]["worst"].get<std::string>(), StartsWith("shell:10"));
  EXPECT_TRUE(check["metrics"]["min_angle_tri"]["min"].is_null());
  EXPECT_TRUE(check["metrics"]["min_angle_tri"]["worst"].is_null());
  EXPECT_NEAR(check["mass"].get<double>(), 30 * 20 * 1.2 * 7.85e-9, 2e-7);
  EXPECT_EQ(check["cog"].size(), 3u);
  EXPECT_NEAR(check["time_step"]["min"].get<double>(), 0.9 * 5 / 5.42e6, 0.1e-6);
  EXPECT_THAT(check["time_step"]["element"].get<std::string>(), StartsWith("shell:"));
}

TEST_F(Cli, check_counts_defects_apart_and_puts_them_into_no_mean) {
  std::string text = plate_text();
  const std::string flat = node_card(109, 5, 5, 0);
  text.replace(text.find(flat), flat.size(), node_card(109, 0, 0, 0));  // onto node 101: one shell has two corners at one place
  const Outcome outcome = prismesh({"check", write("plate.k", text), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  const json check = outcome.json();
  EXPECT_EQ(check["defects"]["not_finite"], 0);
  EXPECT_EQ(check["defects"]["repeated_node"], 1);
  EXPECT_EQ(check["composite"]["min"], -1);
  EXPECT_LT(check["metrics"]["aspect"]["max"].get<double>(), 1e6);
  EXPECT_EQ(check["metrics"]["aspect"]["measured"].get<int>() + 1, check["elements"].get<int>());
}

TEST_F(Cli, check_says_how_shells_are_joined_and_how_parts_do) {
  const json check = prismesh({"check", write("plate.k", plate_text()), "--json"}).json();
  for (const char* name :
       {"duplicates", "normals_not_aligned", "multiply_connected_edges", "unjoined_edges", "free_edges_inside", "triangle_clusters"}) {
    EXPECT_EQ(check["structure"][name]["count"], 0) << name;
    EXPECT_TRUE(check["structure"][name]["first"].empty()) << name;
  }
  ASSERT_EQ(check["parts"].size(), 1u);
  const json& part = check["parts"][0];
  EXPECT_EQ(part["id"], 7);
  EXPECT_EQ(part["elements"], 24);
  EXPECT_EQ(part["fail"], 0);
  EXPECT_EQ(part["composite"]["min"], 1);
  EXPECT_EQ(part["composite"]["mean"], 1);
  EXPECT_EQ(part["mass"], check["mass"]);
  EXPECT_TRUE(check["unknown"].empty());
  EXPECT_FALSE(check.contains("chordal_deviation"));
  const json chordal = prismesh({"check", write("plate.k", plate_text()), "--chordal", "--json"}).json()["chordal_deviation"];
  EXPECT_EQ(chordal["measured"], 24);
  EXPECT_NEAR(chordal["max"].get<double>(), 0, 1e-6);
}

TEST_F(Cli, check_says_once_what_cannot_be_known) {
  std::string text = plate_text();
  text.replace(text.find("*MAT_ELASTIC"), std::string::npos, "*END\n");
  const Outcome outcome = prismesh({"check", write("plate.k", text), "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_TRUE(outcome.json()["mass"].is_null());
  EXPECT_TRUE(outcome.json()["time_step"].is_null());
  EXPECT_EQ(outcome.json()["unknown"].size(), 2u);
  const std::string sentence = "part 7 has no thickness or no density: its mass isn't known";
  EXPECT_EQ(outcome.err.find(sentence), outcome.err.rfind(sentence));
  EXPECT_THAT(outcome.err, HasSubstr(sentence));
}

TEST_F(Cli, strict_criteria_by_name) {
  const std::string deck = write("plate.k", plate_text());
  EXPECT_EQ(prismesh({"check", deck, "--criteria", "strict", "--json"}).json()["criteria"], "strict");
  EXPECT_EQ(prismesh({"check", deck, "--criteria", "default", "--json"}).json()["criteria"], "default");
}

TEST_F(Cli, check_of_a_selection) {
  const std::string deck = write("plate.k", plate_text());
  EXPECT_EQ(prismesh({"check", deck, "--select", "1001-1006", "--json"}).json()["elements"], 6);
  EXPECT_EQ(prismesh({"check", deck, "--select", "part:7,!shell:1001", "--json"}).json()["elements"], 23);
  const Outcome bad = prismesh({"check", deck, "--select", "1001,part:8", "--json"});
  EXPECT_EQ(bad.status, kFailed);
  EXPECT_THAT(bad.err, StartsWith("expression:6: "));
  EXPECT_EQ(bad.out, "");
}

TEST_F(Cli, criteria_of_one_s_own) {
  const std::string deck = write("plate.k", plate_text());
  const std::string strict = write("strict.toml", "name = \"strict\"\n[metrics.max_length]\nfail_above = 0.5\n");
  const Outcome outcome = prismesh({"check", deck, "--criteria", strict, "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_EQ(outcome.json()["fail"], 24);
  EXPECT_EQ(outcome.json()["criteria"], "strict");
  const std::string wrong = write("wrong.toml", "\n[metrics.max_lenght]\nfail_above = 0.5\n");
  const Outcome refused = prismesh({"check", deck, "--criteria", wrong});
  EXPECT_EQ(refused.status, kFailed);
  EXPECT_THAT(refused.err, StartsWith(wrong + ":2: "));
  EXPECT_THAT(refused.err, HasSubstr("max_length"));
}

TEST_F(Cli, diff_counts_by_id_and_by_line) {
  const std::string a = write("a.k", plate_text());
  const json nothing = {{"nodes_moved", 0},    {"max_displacement", 0.0}, {"nodes_added", 0},  {"nodes_removed", 0},
                        {"elements_added", 0}, {"elements_removed", 0},   {"lines_changed", 0}};
  const auto counts_of = [](const json& difference) {
    json counts;
    for (const char* name :
         {"nodes_moved", "max_displacement", "nodes_added", "nodes_removed", "elements_added", "elements_removed", "lines_changed"})
      counts[name] = difference.at(name);
    return counts;
  };
  const json same = prismesh({"diff", a, a, "--json"}).json();
  EXPECT_EQ(counts_of(same), nothing);
  EXPECT_EQ(same["elements_changed"], 0);
  EXPECT_EQ(same["displacement"]["nodes"], 35);
  EXPECT_EQ(same["surface_distance"]["max"], 0.0);
  std::string text = plate_text();
  const std::string moved = node_card(109, 5, 5, 0);
  text.replace(text.find(moved), moved.size(), node_card(109, 8, 9, 0));
  text.erase(text.find(shell_card(1024, 7, 127, 128, 135, 134)), 49);
  text.insert(text.find("*ELEMENT_SHELL"), node_card(500, 1, 2, 3) + node_card(501, 1, 2, 3));
  const std::string b = write("b.k", text);
  const json difference = prismesh({"diff", a, b, "--json"}).json();
  EXPECT_EQ(counts_of(difference), (json{{"nodes_moved", 1},
                                         {"max_displacement", 5.0},
                                         {"nodes_added", 2},
                                         {"nodes_removed", 0},
                                         {"elements_added", 0},
                                         {"elements_removed", 1},
                                         {"lines_changed", 4}}));
  EXPECT_EQ(difference["elements_changed"], 0);
  EXPECT_EQ(difference["moved"], "109");
  EXPECT_EQ(difference["added"], "500,501");
  EXPECT_EQ(same["moved"], "");
  EXPECT_EQ(difference["displacement"]["max"], 5.0);
  EXPECT_EQ(difference["displacement"]["max_at"], "node:109");
  EXPECT_EQ(difference["surface_distance"]["max"], 0.0) << "it moved in the plate's plane";
  EXPECT_EQ(prismesh({"diff", b, a, "--json"}).json()["nodes_removed"], 2);
  EXPECT_EQ(prismesh({"diff", a, path("absent.k")}).status, kFailed);
  EXPECT_THAT(prismesh({"diff", a, path("absent.k")}).err, StartsWith(path("absent.k")));
}

TEST_F(Cli, distance_between_nodes_shells_and_parts) {
  std::string text = plate_text();
  text.insert(text.find("*PART"), "*NODE\n" + node_card(901, 12, 7, 3) + node_card(902, 14, 7, 3) + node_card(903, 14, 9, 4) +
                                      "*ELEMENT_SHELL\n" + shell_card(3000, 8, 901, 902, 903, 903));
  const std::string deck = write("plate.k", text);
  const auto distance = [&](const char* from, const char* to) {
    const Outcome outcome = prismesh({"distance", deck, "--from", from, "--to", to, "--json"});
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    return outcome.json();
  };
  EXPECT_DOUBLE_EQ(distance("101", "102-104")["distance"], 5.0);
  EXPECT_EQ(distance("101", "102-104")["to"]["entity"], "node:102");
  EXPECT_DOUBLE_EQ(distance("part:7", "part:8")["distance"], 3.0);
  EXPECT_EQ(distance("part:7", "part:8")["to"]["entity"], "shell:3000");
  EXPECT_DOUBLE_EQ(distance("901", "part:7")["distance"], 3.0);
  EXPECT_EQ(distance("901", "part:7")["to"]["point"], json::array({12.0, 7.0, 0.0}));
  const Outcome bad = prismesh({"distance", deck, "--from", "101", "--to", "102,oops"});
  EXPECT_EQ(bad.status, kFailed);
  EXPECT_THAT(bad.err, HasSubstr("warning: elements name part 8"));
  EXPECT_THAT(bad.err.substr(bad.err.find('\n') + 1), StartsWith("expression:5: "));
}

}  // namespace
}  // namespace prismesh::cli
