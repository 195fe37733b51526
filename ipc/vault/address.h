// Where a vault is, as people write it: s3+https://HOST[:PORT]/BUCKET[/FOLDER].
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::ipc::vault {

struct VaultAddress {
  bool is_plain = false;  ///< http: nothing of what goes over the line is hidden
  std::string host;       ///< a name or an address, without brackets
  std::optional<std::uint16_t> port;
  std::string bucket;
  std::string folder;  ///< before each object's name: "" or "a/b/"
  bool operator==(const VaultAddress&) const = default;

  std::string text() const;
  /// "https://host:port"
  std::string origin() const;
  /// The host is this computer.
  bool is_loopback() const;
};

/// Errors: the text is no such address; it has credentials in it.
Result<VaultAddress> parse_vault_address(std::string_view text);

}  // namespace prismesh::ipc::vault
