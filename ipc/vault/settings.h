// Which vault is meant, and by which keys it is opened: from the environment, or a file that only its user may read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::ipc::vault {

struct VaultSettings {
  std::optional<std::string> vault;  ///< its address
  std::string region = "us-east-1";  ///< part of each signature
  std::string access_key_id;
  std::string secret_access_key;   ///< never shown
  std::string authorities;         ///< a file of certificates that vouch for the store's; empty: the computer's
  std::string session_token = {};  ///< of keys that are lent for a time, never shown; empty: none
};

/// The file's text (TOML): vault, region, access_key_id, secret_access_key. `file` is for errors, none of which shows a value. Errors, with
/// line: no TOML, an unknown key, a value that can't be.
Result<VaultSettings> parse_vault_settings(std::string_view text, const std::string& file);

/// The file `given`, else $XDG_CONFIG_HOME/prismesh/vault.toml, else ~/.config/prismesh/vault.toml if it is there; then what
/// PRISMESH_VAULT, AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, AWS_SESSION_TOKEN, AWS_CA_BUNDLE, and AWS_REGION or AWS_DEFAULT_REGION say.
/// Errors: others may read the file; as above; a key is missing.
Result<VaultSettings> read_vault_settings(const std::optional<std::filesystem::path>& given);

}  // namespace prismesh::ipc::vault
