// Who may do what: the table of users and their roles that each socket and each client consults (docs/roles.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <sys/types.h>

#include "base/error.h"

namespace prismesh::ipc {

enum class Role : std::uint8_t {
  watch,    ///< look at the document and at the state of the devices
  edit,     ///< change, open and save the document; includes watch
  devices,  ///< move the mask, re-arm devices, read settings again; includes watch
  offer,    ///< have a model that was edited in its folder published in the store
  serve,    ///< answer clients: a daemon's own user
};
inline constexpr int kRoleCount = 5;
std::string_view name(Role role);

/// A set of roles.
class Roles {
 public:
  Roles() = default;
  Roles(std::initializer_list<Role> roles) {
    for (const Role role : roles) add(role);
  }
  static Roles all() { return {Role::watch, Role::edit, Role::devices, Role::offer, Role::serve}; }

  void add(Role role);
  bool has(Role role) const { return (bits_ >> static_cast<int>(role) & 1) != 0; }
  bool none() const { return bits_ == 0; }
  std::string names() const;  ///< "watch, offer"
  bool operator==(const Roles&) const = default;

 private:
  std::uint8_t bits_ = 0;
};

class RoleTable {
 public:
  /// The process's own user and root have all roles; others only those that are given to them.
  Roles of(uid_t user) const;
  void give(uid_t user, const Roles& roles);
  /// Whether other users than the own one and root have a role.
  bool has_others() const;

 private:
  std::map<uid_t, Roles> given_;
};

/// The number of a user; nothing: there is no such user.
using FindUser = std::function<std::optional<uid_t>(const std::string& name)>;

/// Reads the text of a table: `[users]`, then lines like `prismesh-kiosk = ["edit", "devices"]`; a user is a name or a number. `file` is
/// for errors, which name the line: no TOML, an unknown role (with the nearest), an unknown user.
Result<RoleTable> parse_roles(std::string_view text, const std::filesystem::path& file, const FindUser& find_user);

/// Reads $PRISMESH_ROLES, else /etc/prismesh/roles.toml; if that is missing, no other user has a role. Errors: as above; the file belongs
/// to another user than the own one and root, or others may write to it.
Result<RoleTable> read_roles();

}  // namespace prismesh::ipc
