#include "ipc/wire/roles.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <pwd.h>
#include <sys/stat.h>
#include <toml++/toml.h>
#include <unistd.h>

#include "base/file.h"
#include "base/nearest_name.h"

namespace prismesh::ipc {

namespace {

constexpr std::array<std::string_view, kRoleCount> kNames{"watch", "edit", "devices", "offer", "serve"};
constexpr const char* kUsualFile = "/etc/prismesh/roles.toml";

long line_of(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

Result<Role> role_named(const toml::node& node, const std::string& file) {
  const auto word = node.value<std::string_view>();
  if (!word) return fail(file, line_of(node), "a role must be a text in quotes");
  for (int i = 0; i < kRoleCount; ++i)
    if (kNames[static_cast<std::size_t>(i)] == *word) return static_cast<Role>(i);
  const std::vector<std::string_view> known(kNames.begin(), kNames.end());
  return fail(file, line_of(node),
              "there is no role \"" + std::string(*word) + "\"; the nearest is \"" + std::string(nearest_name(*word, known)) + "\"");
}

std::optional<uid_t> number_of(const std::string& user) {
  uid_t number = 0;
  const auto [end, problem] = std::from_chars(user.data(), user.data() + user.size(), number);
  if (problem != std::errc() || end != user.data() + user.size()) return std::nullopt;
  return number;
}

Result<Roles> roles_of_user(const std::string& user, const toml::node& node, const std::string& file) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return fail(file, line_of(node), user + ": expected a list of roles, like [\"watch\"]");
  Roles roles;
  for (const toml::node& each : *list) {
    const Result<Role> role = role_named(each, file);
    if (!role) return fail(role.error());
    roles.add(*role);
  }
  return roles;
}

std::optional<uid_t> user_of_the_system(const std::string& user) {
  std::vector<char> texts(std::size_t{16} * 1024);
  passwd entry{};
  passwd* found = nullptr;
  if (::getpwnam_r(user.c_str(), &entry, texts.data(), texts.size(), &found) != 0 || found == nullptr) return std::nullopt;
  return found->pw_uid;
}

}  // namespace

std::string_view name(Role role) { return kNames[static_cast<std::size_t>(role)]; }

void Roles::add(Role role) {
  bits_ = static_cast<std::uint8_t>(bits_ | 1U << static_cast<int>(role));
  if (role == Role::edit || role == Role::devices) add(Role::watch);
}

std::string Roles::names() const {
  std::string all;
  for (int i = 0; i < kRoleCount; ++i)
    if (has(static_cast<Role>(i))) all += (all.empty() ? "" : ", ") + std::string(kNames[static_cast<std::size_t>(i)]);
  return all.empty() ? "none" : all;
}

Roles RoleTable::of(uid_t user) const {
  if (user == ::geteuid() || user == 0) return Roles::all();
  const auto found = given_.find(user);
  return found == given_.end() ? Roles() : found->second;
}

void RoleTable::give(uid_t user, const Roles& roles) { given_[user] = roles; }

bool RoleTable::has_others() const {
  for (const auto& [user, roles] : given_)
    if (user != ::geteuid() && user != 0 && !roles.none()) return true;
  return false;
}

Result<RoleTable> parse_roles(std::string_view text, const std::filesystem::path& path, const FindUser& find_user) {
  const std::string file = path.string();
  toml::table table;
  try {
    table = toml::parse(text, file);
  } catch (const toml::parse_error& problem) {
    return fail(file, static_cast<long>(problem.source().begin.line), std::string(problem.description()));
  }
  RoleTable roles;
  for (const auto& [key, node] : table) {
    const toml::table* users = key.str() == "users" ? node.as_table() : nullptr;
    if (users == nullptr) return fail(file, line_of(node), "\"" + std::string(key.str()) + "\" isn't known here; the table is [users]");
    for (const auto& [user_key, list] : *users) {
      const std::string user(user_key.str());
      const Result<Roles> given = roles_of_user(user, list, file);
      if (!given) return fail(given.error());
      std::optional<uid_t> number = number_of(user);
      if (!number) number = find_user(user);
      if (!number) return fail(file, line_of(list), "there is no user \"" + user + "\"");
      roles.give(*number, *given);
    }
  }
  return roles;
}

Result<RoleTable> read_roles() {
  const char* named = std::getenv("PRISMESH_ROLES");
  const std::filesystem::path file = named != nullptr && *named != 0 ? named : kUsualFile;
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    if (errno == ENOENT && file == kUsualFile) return RoleTable();
    return fail(file.string(), std::string("can't be read: ") + std::strerror(errno));
  }
  if (status.st_uid != 0 && status.st_uid != ::geteuid())
    return fail(file.string(), "belongs to another user (" + std::to_string(status.st_uid) + "), who could give any role");
  if ((status.st_mode & 0022) != 0) return fail(file.string(), "others may write to it and give any role; make it private (chmod go-w)");
  const Result<FileBytes> bytes = read_file(file);
  if (!bytes) return fail(bytes.error());
  return parse_roles(bytes->text(), file, user_of_the_system);
}

}  // namespace prismesh::ipc
