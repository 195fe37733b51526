// Tokens and pairing: who may do what. Safe to use from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "daemon/intake/access/audit_log.h"
#include "daemon/intake/access/token.h"
#include "daemon/intake/access/token_text.h"
#include "daemon/intake/store/limits.h"
#include "ipc/intake/pairing_code.h"
#include "ipc/store/folder.h"

namespace prismesh::intake {

/// Seconds since 1970.
using WallClock = std::function<std::int64_t()>;

struct AccessLimits {
  std::int64_t code_lifetime_s = 300;
  int wrong_secrets = 10;  ///< after which a code is void
  std::size_t tokens = 200;
  std::int64_t token_lifetime_s = std::int64_t{365} * 24 * 3600;
  double requests_per_s = 100;  ///< of a token, in the long run
  double requests_at_once = 500;
};

/// What is asked for when a code is made.
struct PairingOffer {
  std::string name;  ///< the token's; empty: the client says one
  Scopes scopes;
};

struct NewToken {
  std::string token;  ///< given out once
  TokenRecord record;
};

enum class Denial : std::uint8_t { unknown, too_many_requests };

class Access {
 public:
  /// `folder`: of the tokens and the audit log. Errors: one of them is damaged, the disk.
  static Result<std::unique_ptr<Access>> open(const ipc::store::Folder& folder, const AccessLimits& limits, Clock& clock, WallClock now,
                                              Randomness randomness, std::vector<std::string>& notes);

  /// Makes a secret that is good for one pairing; an earlier one is void.
  std::array<std::uint8_t, 10> make_secret(const PairingOffer& offer);
  /// Takes the secret for a token. Errors: wrong, expired or used (all alike); a bad name; too many tokens; the disk.
  Result<NewToken> pair(std::string_view secret, const std::string& name);

  /// Who has this token. Counts as a request of it.
  tl::expected<Caller, Denial> caller_of(std::string_view token);
  /// Whether the caller still has that right: tokens are revoked and expire while requests are under way.
  bool still_may(const Caller& caller, Scope scope);

  std::vector<TokenRecord> tokens();
  /// Errors: there is no such token; the disk.
  Result<void> revoke(const std::string& name);

  /// Writes a line of the audit log; a disk that refuses is told of in the log.
  void note(const std::string& who, const std::string& what, const std::string& about);

 private:
  struct Offer {
    PairingOffer is;
    std::array<std::uint8_t, 10> secret{};
    std::int64_t until_ns = 0;
    int wrong = 0;
  };
  struct Rate {
    double left = 0;
    std::int64_t at_ns = 0;
  };
  Access(ipc::store::Folder folder, const AccessLimits& limits, Clock& clock, WallClock now, Randomness randomness, AuditLog audit)
      : folder_(std::move(folder)),
        limits_(limits),
        clock_(&clock),
        now_(std::move(now)),
        randomness_(std::move(randomness)),
        audit_(std::move(audit)) {}
  Result<void> write_tokens(const TokenFile& tokens);
  std::int64_t latest_time();
  const TokenRecord* find(const ipc::store::ContentHash& hash);
  bool takes_secret(std::string_view text);
  bool within_rate(const ipc::store::ContentHash& token);
  void note_locked(const std::string& who, const std::string& what, const std::string& about);

  std::mutex mutex_;
  ipc::store::Folder folder_;
  AccessLimits limits_;
  Clock* clock_;
  WallClock now_;
  Randomness randomness_;
  AuditLog audit_;
  TokenFile tokens_;
  std::optional<Offer> offer_;
  std::map<ipc::store::ContentHash, Rate> rates_;
};

}  // namespace prismesh::intake
