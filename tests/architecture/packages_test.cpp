// packages.txt is the one list of packages: known sections, valid names, no duplicates. debian/ says the same.
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/architecture/tree.h"

namespace prismesh::architecture {
namespace {

using Sections = std::map<std::string, std::vector<std::string>>;

Sections read_packages() {
  Sections sections;
  std::istringstream lines(read_text(project_root() / "packages.txt"));
  std::string line, section;
  while (std::getline(lines, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    if (!(words >> word)) continue;
    if (word.starts_with('['))
      section = word;
    else
      sections[section].push_back(word);
    EXPECT_FALSE(words >> word) << "two words in: " << line;
  }
  return sections;
}

TEST(Packages, have_a_section_for_each_purpose) {
  std::vector<std::string> names;
  for (const auto& [name, packages] : read_packages()) names.push_back(name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("[run]", "[build]", "[test]", "[judge]", "[package]", "[package-test]", "[image]",
                                                   "[image-and-disks]", "[roots]", "[disks]", "[vm]"));
}

TEST(Packages, are_named_as_debian_names_them_and_stand_once) {
  std::set<std::string> seen;
  const std::regex debian_name("[a-z0-9][a-z0-9.+-]+");
  for (const auto& [section, packages] : read_packages())
    for (const std::string& package : packages) {
      EXPECT_TRUE(std::regex_match(package, debian_name)) << section << " " << package;
      EXPECT_TRUE(seen.insert(package).second) << package << " stands twice";
    }
}

TEST(Packages, running_needs_no_headers_and_no_compiler) {
  const std::vector<std::string> packages = read_packages()["[run]"];
  ASSERT_FALSE(packages.empty());
  for (const std::string& package : packages) {
    EXPECT_FALSE(package.ends_with("-dev")) << package;
    EXPECT_FALSE(package.starts_with("clang") || package == "g++") << package;
  }
}

/// The names in the field of debian/control that begins with `field`.
std::set<std::string> control_field(const std::string& field) {
  std::istringstream lines(read_text(project_root() / "debian/control"));
  std::string line;
  std::set<std::string> names;
  for (bool inside = false; std::getline(lines, line);) {
    inside = line.starts_with(field) || (inside && line.starts_with(' '));
    if (!inside) continue;
    std::istringstream entries(line.substr(line.starts_with(field) ? field.size() : 0));
    for (std::string entry, name; std::getline(entries, entry, ',');)
      if (std::istringstream(entry) >> name) names.insert(name);
  }
  return names;
}

TEST(Packages, that_the_build_needs_are_those_of_the_source_package) {
  std::set<std::string> needed{"debhelper-compat", "dh-sequence-installsysusers", "dh-sequence-python3"};
  const std::vector<std::string> packages = read_packages()["[build]"];
  for (const std::string& package : packages)
    if (package != "g++" && package != "ccache") needed.insert(package);  // g++ is there for each build of a package, ccache isn't needed
  EXPECT_EQ(control_field("Build-Depends:"), needed) << "debian/control, Build-Depends, differs from [build] in packages.txt";
}

TEST(Packages, have_the_version_of_the_programs) {
  const std::string changelog = read_text(project_root() / "debian/changelog");
  EXPECT_THAT(changelog, testing::StartsWith("prismesh (" PRISMESH_VERSION ")"));
}

TEST(Packages, are_installed_in_one_place_that_removes_nothing) {
  EXPECT_THAT(read_text(project_root() / "scripts/steps.sh"),
              testing::HasSubstr("apt-get install -y -qq --no-install-recommends --no-remove"));
  for (const char* script : {"station", "scripts/test.sh", "scripts/package.sh", ".ci/run", "demo/play", "demo/station"})
    EXPECT_THAT(read_text(project_root() / script), testing::Not(testing::HasSubstr("apt-get"))) << script;
}

}  // namespace
}  // namespace prismesh::architecture
