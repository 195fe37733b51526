#include "ipc/wire/roles.h"

#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace prismesh::ipc {
namespace {

using testing::HasSubstr;

std::optional<uid_t> find_user(const std::string& name) {
  if (name == "kiosk") return uid_t{4001};
  if (name == "intake") return uid_t{4002};
  return std::nullopt;
}

Result<RoleTable> parsed(std::string_view text) { return parse_roles(text, "roles.toml", find_user); }

TEST(Roles, are_given_to_users_by_name_and_number) {
  const Result<RoleTable> table =
      parsed("[users]\nkiosk = [\"edit\", \"devices\"]\nintake = [\"watch\", \"offer\"]\n4003 = [\"serve\"]\n4004 = []\n");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->of(4001), (Roles{Role::watch, Role::edit, Role::devices}));
  EXPECT_EQ(table->of(4002), (Roles{Role::watch, Role::offer}));
  EXPECT_FALSE(table->of(4002).has(Role::edit));
  EXPECT_EQ(table->of(4003), (Roles{Role::serve})) << "a daemon isn't a client";
  EXPECT_TRUE(table->of(4004).none());
  EXPECT_TRUE(table->of(4005).none());
  EXPECT_TRUE(table->has_others());
}

TEST(Roles, of_the_own_user_and_root_are_all) {
  const RoleTable table;
  EXPECT_EQ(table.of(::geteuid()), Roles::all());
  EXPECT_EQ(table.of(0), Roles::all());
  EXPECT_FALSE(table.has_others());
  EXPECT_TRUE(table.of(::geteuid() + 1).none());
}

TEST(Roles, to_edit_or_to_move_devices_is_also_to_watch) {
  EXPECT_TRUE(Roles{Role::edit}.has(Role::watch));
  EXPECT_TRUE(Roles{Role::devices}.has(Role::watch));
  EXPECT_FALSE(Roles{Role::offer}.has(Role::watch));
  EXPECT_FALSE((Roles{Role::watch, Role::devices}.has(Role::edit)));
  EXPECT_EQ(Roles{Role::edit}.names(), "watch, edit");
  EXPECT_EQ(Roles{}.names(), "none");
}

TEST(Roles, bad_tables_are_refused_with_file_and_line) {
  const std::pair<std::string_view, std::string_view> cases[] = {
      {"[users]\nkiosk = [\"edti\"]\n", "roles.toml:2: there is no role \"edti\"; the nearest is \"edit\""},
      {"[users]\n\nghost = [\"watch\"]\n", "roles.toml:3: there is no user \"ghost\""},
      {"[users]\nkiosk = \"edit\"\n", "roles.toml:2: kiosk: expected a list of roles"},
      {"[users]\nkiosk = [1]\n", "roles.toml:2: a role must be a text in quotes"},
      {"[user]\nkiosk = [\"edit\"]\n", "roles.toml:1: \"user\" isn't known here"},
      {"users = 3\n", "roles.toml:1: \"users\" isn't known here"},
      {"[users]\nkiosk = [\"edit\"\n", "roles.toml:2: Error while parsing array"},
      {"[users]\n\"-1\" = [\"edit\"]\n", "there is no user \"-1\""},
      {"[users]\n\"99999999999\" = [\"edit\"]\n", "there is no user \"99999999999\""},
  };
  for (const auto& [text, error] : cases) {
    const Result<RoleTable> table = parsed(text);
    ASSERT_FALSE(table) << text;
    EXPECT_THAT(table.error().text(), HasSubstr(std::string(error)));
  }
}

TEST(Roles, a_named_table_that_is_missing_is_an_error) {
  ::setenv("PRISMESH_ROLES", "/nowhere/roles.toml", 1);
  const Result<RoleTable> table = read_roles();
  ::unsetenv("PRISMESH_ROLES");
  ASSERT_FALSE(table);
  EXPECT_THAT(table.error().text(), HasSubstr("/nowhere/roles.toml"));
}

}  // namespace
}  // namespace prismesh::ipc
