#include "tests/architecture/include_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/architecture/tree.h"

namespace prismesh::architecture {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(IncludeRules, layers_stand_on_those_below) {
  for (const char* module : {"cli", "kiosk", "daemon/modeld"})
    for (const char* below : {"ipc", "mesh/document", "mesh/model", "drivers", "base"})
      EXPECT_TRUE(may_include(module, below)) << module << " " << below;
  EXPECT_TRUE(may_include("ipc", "mesh/document"));
  EXPECT_TRUE(may_include("mesh/model", "base"));
}

TEST(IncludeRules, neighbours_never_see_each_other) {
  const std::vector<std::string> programs{"cli", "kiosk", "daemon/modeld", "daemon/deviced"};
  for (const std::string& from : programs)
    for (const std::string& to : programs) EXPECT_EQ(may_include(from, to), from == to) << from << " " << to;
  EXPECT_FALSE(may_include("mesh/shape", "drivers"));
  EXPECT_FALSE(may_include("drivers", "mesh/model"));
}

TEST(IncludeRules, nothing_looks_up) {
  EXPECT_FALSE(may_include("base", "mesh/model"));
  EXPECT_FALSE(may_include("mesh/document", "ipc"));
  EXPECT_FALSE(may_include("ipc", "kiosk"));
  EXPECT_FALSE(may_include("kiosk", "tests"));
}

TEST(IncludeRules, modules_of_the_mesh_keep_their_order) {
  EXPECT_TRUE(may_include("mesh/document", "mesh/deck"));
  EXPECT_TRUE(may_include("mesh/document", "mesh/spatial"));
  EXPECT_TRUE(may_include("mesh/shape", "mesh/model"));
  EXPECT_FALSE(may_include("mesh/deck", "mesh/quality"));
  EXPECT_FALSE(may_include("mesh/shape", "mesh/select"));
  EXPECT_FALSE(may_include("mesh/select", "mesh/quality"));
  EXPECT_FALSE(may_include("mesh/model", "mesh/spatial"));
  EXPECT_FALSE(may_include("mesh/model", "mesh/no_such_module"));
}

TEST(IncludeRules, the_simulated_viewer_shares_nothing_with_what_it_judges) {
  for (const char* judged : {"kiosk", "drivers", "ipc", "mesh/model", "tests"}) EXPECT_FALSE(may_include("tests/viewer", judged)) << judged;
  EXPECT_TRUE(may_include("tests", "tests/viewer"));
  EXPECT_EQ(module_of("tests/viewer/seen.cpp"), "tests/viewer");
}

TEST(IncludeRules, a_planted_violation_is_found_at_its_line) {
  EXPECT_THAT(include_violations("mesh/shape/move.cpp", "#include \"mesh/shape/move.h\"\n\n#include \"mesh/document/document.h\"\n"),
              ElementsAre("mesh/shape/move.cpp:3: mesh/shape must not include mesh/document (mesh/document/document.h)"));
  EXPECT_THAT(include_violations("cli/main.cpp", "  #  include <kiosk/render/renderer.h>"),
              ElementsAre("cli/main.cpp:1: cli must not include kiosk (kiosk/render/renderer.h)"));
  EXPECT_THAT(include_violations("base/error.cpp", "#include \"error.h\"\n"),
              ElementsAre("base/error.cpp:1: \"error.h\" isn't written from the project's root"));
}

TEST(IncludeRules, what_is_no_include_is_passed_over) {
  EXPECT_THAT(
      include_violations("base/error.cpp", "// #include \"kiosk/x.h\"\n#include <vector>\n#include <nlohmann/json.hpp>\nint kiosk;"),
      IsEmpty());
}

TEST(IncludeRules, the_tree_keeps_them) {
  std::size_t files = 0;
  for (const SourceText& source : source_tree()) {
    ++files;
    EXPECT_THAT(include_violations(source.path, source.text), IsEmpty());
  }
  EXPECT_GT(files, 50u) << "the sources weren't found";
}

TEST(Headers, say_what_they_are_and_guard_themselves) {
  for (const SourceText& source : source_tree()) {
    if (!source.path.ends_with(".h")) continue;
    EXPECT_TRUE(source.text.starts_with("// ")) << source.path << " doesn't open with a line that says what it is";
    EXPECT_NE(source.text.find("#pragma once"), std::string::npos) << source.path;
    EXPECT_EQ(source.text.find("\nusing namespace"), std::string::npos) << source.path;
  }
}

}  // namespace
}  // namespace prismesh::architecture
