#include "tests/architecture/include_rules.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/architecture/cycles.h"
#include "tests/architecture/modules.h"
#include "tests/architecture/tree.h"

namespace prismesh::architecture {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// --- cycles ---

TEST(Cycles, are_names_that_lead_to_each_other) {
  EXPECT_THAT(cycles({}), IsEmpty());
  EXPECT_THAT(cycles({{"a", {"b", "c"}}, {"b", {"d"}}, {"c", {"d"}}}), IsEmpty()) << "two paths to one node are no cycle";
  EXPECT_THAT(cycles({{"a", {"b"}}, {"b", {"a"}}}), ElementsAre("a, b"));
  EXPECT_THAT(cycles({{"a", {"b"}}, {"b", {"c"}}, {"c", {"d"}}, {"d", {"b"}}}), ElementsAre("b, c, d")) << "what leads into it isn't in it";
  EXPECT_THAT(cycles({{"a", {"b"}}, {"b", {"a", "x"}}, {"x", {"y"}}, {"y", {"x"}}}), ElementsAre("a, b", "x, y"));
  EXPECT_THAT(cycles({{"a", {"b", "c"}}, {"b", {"c", "a"}}, {"c", {"a"}}}), ElementsAre("a, b, c"));
}

// --- the table of modules ---

TEST(ModuleTable, has_modules_that_exist_and_no_cycle) {
  const std::vector<std::string> folders{"base", "mesh/model"};
  EXPECT_THAT(table_faults({{"base", {}}, {"mesh/model", {"base"}}}, folders), IsEmpty());
  EXPECT_THAT(table_faults({{"base", {}}, {"mesh/model", {"base"}}, {"mesh/planned", {}}}, folders),
              ElementsAre("mesh/planned is a module without sources"));
  EXPECT_THAT(table_faults({{"base", {}}}, folders), ElementsAre("mesh/model holds sources and is missing in the table of modules"));
  EXPECT_THAT(table_faults({{"base", {}}, {"base", {}}, {"mesh/model", {}}}, folders), ElementsAre("base is named twice"));
  EXPECT_THAT(table_faults({{"base", {}}, {"mesh/model", {"bass"}}}, folders), ElementsAre("mesh/model uses bass, which is no module"));
  EXPECT_THAT(table_faults({{"base", {"mesh/model"}}, {"mesh/model", {"base"}}}, folders),
              ElementsAre("modules use each other: base, mesh/model"));
}

TEST(ModuleTable, is_that_of_the_tree) {
  std::set<std::string> folders;
  for (const SourceText& source : source_tree())
    if (const std::string module = module_of(source.path); !module.starts_with("tests")) folders.insert(module);
  EXPECT_GT(folders.size(), 20u) << "the sources weren't found";
  EXPECT_THAT(table_faults(modules(), {folders.begin(), folders.end()}), IsEmpty());
}

// --- allowed includes ---

TEST(IncludeRules, programs_use_ipc_and_what_it_uses) {
  for (const char* program : {"cli", "kiosk", "daemon/modeld"})
    for (const char* below : {"ipc/model", "ipc/wire", "mesh/document", "mesh/model", "base"})
      EXPECT_TRUE(may_include(program, below)) << program << " " << below;
  for (const char* program : {"cli", "kiosk", "daemon/deviced"})
    for (const char* below : {"ipc/device", "ipc/wire", "drivers/display", "base"})
      EXPECT_TRUE(may_include(program, below)) << program << " " << below;
  EXPECT_TRUE(may_include("ipc/model", "mesh/document"));
  EXPECT_TRUE(may_include("mesh/model", "base"));
}

TEST(IncludeRules, what_knows_devices_sees_no_deck_and_what_knows_decks_no_device) {
  for (const char* of_devices : {"daemon/deviced", "ipc/device"})
    for (const char* of_decks : {"ipc/model", "mesh/document", "mesh/model"})
      EXPECT_FALSE(may_include(of_devices, of_decks)) << of_devices << " " << of_decks;
  for (const char* of_decks : {"daemon/modeld", "ipc/model"})
    for (const char* of_devices : {"ipc/device", "drivers/port", "drivers/prism_servo"})
      EXPECT_FALSE(may_include(of_decks, of_devices)) << of_decks << " " << of_devices;
  for (const char* part : {"mesh/model", "drivers/port", "ipc/model", "ipc/device"}) EXPECT_FALSE(may_include("ipc/wire", part)) << part;
}

TEST(IncludeRules, programs_never_include_each_other) {
  const std::vector<std::string> programs{"cli", "kiosk", "daemon/modeld", "daemon/deviced", "python"};
  for (const std::string& from : programs)
    for (const std::string& to : programs) EXPECT_EQ(may_include(from, to), from == to) << from << " " << to;
  EXPECT_FALSE(may_include("mesh/shape", "drivers/port"));
  EXPECT_FALSE(may_include("drivers/port", "mesh/model"));
}

TEST(IncludeRules, the_python_package_holds_the_core_alone) {
  for (const char* below : {"mesh/report", "mesh/document", "base"}) EXPECT_TRUE(may_include("python", below)) << below;
  for (const char* other : {"cli", "ipc/wire", "ipc/model", "drivers/port", "kiosk/link"}) {
    EXPECT_FALSE(may_include("python", other)) << other;
    EXPECT_FALSE(may_include(other, "python")) << other;
  }
}

TEST(IncludeRules, no_module_includes_those_that_use_it) {
  EXPECT_FALSE(may_include("base", "mesh/model"));
  EXPECT_FALSE(may_include("mesh/document", "ipc/model"));
  EXPECT_FALSE(may_include("ipc/model", "kiosk"));
  EXPECT_FALSE(may_include("kiosk", "tests"));
  for (const Module& module : modules())
    for (const std::string& used : module.uses) EXPECT_FALSE(may_include(used, module.folder)) << used << " " << module.folder;
}

TEST(IncludeRules, modules_of_the_mesh_keep_their_order) {
  EXPECT_TRUE(may_include("mesh/document", "mesh/deck"));
  EXPECT_TRUE(may_include("mesh/document", "mesh/spatial"));
  EXPECT_TRUE(may_include("mesh/shape", "mesh/model"));
  EXPECT_FALSE(may_include("mesh/deck", "mesh/quality"));
  EXPECT_FALSE(may_include("mesh/deck/lsdyna", "mesh/deck/nastran"));
  EXPECT_FALSE(may_include("mesh/deck/data", "mesh/deck"));
  EXPECT_FALSE(may_include("mesh/shape", "mesh/select"));
  EXPECT_FALSE(may_include("mesh/select", "mesh/relax"));
  EXPECT_FALSE(may_include("mesh/model", "mesh/spatial"));
  EXPECT_FALSE(may_include("mesh/model", "mesh/no_such_module"));
}

TEST(IncludeRules, panels_and_link_know_no_tool_and_tools_not_each_other) {
  for (const char* tool : {"kiosk/tools/files", "kiosk/tools/shaping"}) {
    for (const char* below : {"kiosk/toolkit", "kiosk/panels", "kiosk/link", "kiosk/input", "kiosk/notices"}) {
      EXPECT_TRUE(may_include(tool, below)) << tool << " " << below;
      EXPECT_FALSE(may_include(below, tool)) << below << " " << tool;
    }
    EXPECT_FALSE(may_include(tool, "kiosk/tools/view")) << tool;
  }
  for (const char* no_panel_matter : {"kiosk/toolkit", "kiosk/link", "kiosk/render", "ipc/model"})
    EXPECT_FALSE(may_include("kiosk/panels", no_panel_matter)) << no_panel_matter;
  for (const char* no_link_matter : {"kiosk/toolkit", "kiosk/panels", "kiosk/input", "kiosk/render"})
    EXPECT_FALSE(may_include("kiosk/link", no_link_matter)) << no_link_matter;
}

TEST(IncludeRules, the_simulated_viewer_shares_nothing_with_what_it_judges) {
  for (const char* judged : {"kiosk", "kiosk/render", "drivers/display", "ipc", "mesh/model", "tests"})
    EXPECT_FALSE(may_include("tests/viewer", judged)) << judged;
  EXPECT_TRUE(may_include("tests", "tests/viewer"));
  EXPECT_EQ(module_of("tests/viewer/seen.cpp"), "tests/viewer");
}

TEST(IncludeRules, a_planted_violation_is_found_at_its_line) {
  EXPECT_THAT(include_violations("mesh/shape/move.cpp", "#include \"mesh/shape/move.h\"\n\n#include \"mesh/document/document.h\"\n"),
              ElementsAre("mesh/shape/move.cpp:3: mesh/shape must not include mesh/document (mesh/document/document.h)"));
  EXPECT_THAT(include_violations("cli/main.cpp", "  #  include <kiosk/render/renderer.h>"),
              ElementsAre("cli/main.cpp:1: cli must not include kiosk/render (kiosk/render/renderer.h)"));
  EXPECT_THAT(include_violations("base/error.cpp", "#include \"error.h\"\n"),
              ElementsAre("base/error.cpp:1: \"error.h\" isn't written from the project's root"));
}

TEST(IncludeRules, what_is_no_include_is_passed_over) {
  EXPECT_THAT(
      include_violations("base/error.cpp", "// #include \"kiosk/x.h\"\n#include <vector>\n#include <nlohmann/json.hpp>\nint kiosk;"),
      IsEmpty());
}

TEST(IncludeRules, the_tree_keeps_them) {
  for (const SourceText& source : source_tree()) EXPECT_THAT(include_violations(source.path, source.text), IsEmpty());
}

// --- header–source pairs ---

TEST(PairCycles, join_pairs_through_headers_and_sources) {
  const SourceText low{"a/low.h", "#pragma once\n"}, low_source{"a/low.cpp", "#include \"a/low.h\"\n#include \"b/high.h\"\n"};
  const SourceText high{"b/high.h", "#include \"a/low.h\"\n"}, main{"b/main.cpp", "#include \"b/high.h\"\n#include <vector>\n"};
  EXPECT_THAT(pair_cycles({low, low_source, high, main}), ElementsAre("a/low, b/high")) << "the low source includes its header's user";
  EXPECT_THAT(pair_cycles({low, high, main}), IsEmpty());
}

TEST(PairCycles, are_not_in_the_tree) { EXPECT_THAT(pair_cycles(source_tree()), IsEmpty()); }

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
