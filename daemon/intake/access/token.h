// What a client may do, by the token that it shows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/store/sha256.h"

namespace prismesh::intake {

enum class Scope : std::uint8_t {
  read,     ///< list, follow and fetch models
  upload,   ///< send and publish models
  remove,   ///< remove published models
  metrics,  ///< figures of the station
};
inline constexpr std::array<std::string_view, 4> kScopeNames{"read", "upload", "remove", "metrics"};

class Scopes {
 public:
  static Scopes all() {
    Scopes scopes;
    scopes.bits_ = 15;
    return scopes;
  }
  void add(Scope scope) { bits_ = static_cast<std::uint8_t>(bits_ | 1U << static_cast<unsigned>(scope)); }
  bool has(Scope scope) const { return (bits_ >> static_cast<unsigned>(scope) & 1U) != 0; }
  bool none() const { return bits_ == 0; }
  bool operator==(const Scopes&) const = default;

 private:
  std::uint8_t bits_ = 0;
};

/// What is kept of a token; the token itself isn't.
struct TokenRecord {
  std::string name;              ///< of whoever it was given to; one of its kind
  ipc::store::ContentHash hash;  ///< of the token's text
  Scopes scopes;
  std::int64_t made_s = 0;     ///< since 1970
  std::int64_t expires_s = 0;  ///< since 1970
  bool operator==(const TokenRecord&) const = default;
};

/// Who a request is from.
struct Caller {
  std::string name;
  Scopes scopes;
  ipc::store::ContentHash token;
};

}  // namespace prismesh::intake
