#include "daemon/intake/access/access.h"

#include <openssl/crypto.h>

#include <algorithm>

#include "base/log.h"
#include "ipc/store/utf8.h"

namespace prismesh::intake {

namespace {

using ipc::store::ContentHash;

constexpr const char* kTokensFile = "tokens";
constexpr const char* kAuditFile = "audit.log";
constexpr const char* kTemporaryFile = "tokens.new";
constexpr std::size_t kMaxTokensBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxTokenName = 64;

bool is_token_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxTokenName && ipc::store::is_plain_utf8(name) && name.front() != ' ' && name.back() != ' ';
}

}  // namespace

Result<std::unique_ptr<Access>> Access::open(const ipc::store::Folder& folder, const AccessLimits& limits, Clock& clock, WallClock now,
                                             Randomness randomness, std::vector<std::string>& notes) {
  std::string note;
  Result<AuditLog> audit = AuditLog::open(folder, kAuditFile, note);
  if (!audit) return fail(audit.error());
  if (!note.empty()) notes.push_back(note);
  Result<ipc::store::Folder> own = ipc::store::Folder::open(folder.path());
  if (!own) return fail(own.error());
  std::unique_ptr<Access> access(new Access(std::move(*own), limits, clock, std::move(now), std::move(randomness), std::move(*audit)));
  if (const Result<void> removed = folder.remove(kTemporaryFile); !removed) return fail(removed.error());
  if (!folder.has(kTokensFile)) return access;
  const Result<std::string> text = folder.content(kTokensFile, kMaxTokensBytes);
  if (!text) return fail(text.error());
  Result<TokenFile> tokens = decode_tokens(*text, (folder.path() / kTokensFile).string());
  if (!tokens) return fail(tokens.error());
  access->tokens_ = std::move(*tokens);
  return access;
}

std::int64_t Access::latest_time() {
  tokens_.latest_s = std::max(tokens_.latest_s, now_());
  return tokens_.latest_s;
}

Result<void> Access::write_tokens(const TokenFile& tokens) {
  (void)folder_.remove(kTemporaryFile);
  return folder_.replace(kTokensFile, encode_tokens(tokens), kTemporaryFile, 0600);
}

std::array<std::uint8_t, 10> Access::make_secret(const PairingOffer& offer) {
  const std::lock_guard lock(mutex_);
  Offer made{offer, {}, clock_->now_ns() + limits_.code_lifetime_s * 1'000'000'000, 0};
  randomness_(std::as_writable_bytes(std::span(made.secret)));
  offer_ = made;
  note_locked(offer.name, "pairing code made", "");
  return made.secret;
}

bool Access::takes_secret(std::string_view text) {
  if (!offer_ || clock_->now_ns() >= offer_->until_ns) return false;
  const Result<std::array<std::uint8_t, 10>> given = ipc::decode_pairing_secret(text);
  if (given && CRYPTO_memcmp(given->data(), offer_->secret.data(), given->size()) == 0) return true;
  if (++offer_->wrong >= limits_.wrong_secrets) offer_.reset();
  return false;
}

Result<NewToken> Access::pair(std::string_view secret, const std::string& name) {
  const std::lock_guard lock(mutex_);
  // Without an offer nothing is noted: strangers must not fill the log.
  const bool is_offered = offer_ && clock_->now_ns() < offer_->until_ns;
  if (!takes_secret(secret)) {
    if (is_offered) note_locked("", "pairing refused", "");
    return fail("pairing code", "is wrong, or its time is over; make a new one at the station");
  }
  const std::string& given = offer_->is.name.empty() ? name : offer_->is.name;
  if (!is_token_name(given)) return fail("name", "must be a line of text of 1 to " + std::to_string(kMaxTokenName) + " bytes");
  const std::int64_t now_s = latest_time();
  TokenFile tokens = tokens_;
  std::erase_if(tokens.tokens, [&](const TokenRecord& token) { return token.expires_s <= now_s; });
  const auto same = [&](const TokenRecord& token) { return token.name == given; };
  if (std::any_of(tokens.tokens.begin(), tokens.tokens.end(), same))
    return fail("name", "'" + given + "' has a token already; revoke that, or choose another name");
  if (tokens.tokens.size() >= limits_.tokens) return fail("tokens", "there are " + std::to_string(limits_.tokens) + "; revoke some");
  std::array<std::uint8_t, 32> random{};
  randomness_(std::as_writable_bytes(std::span(random)));
  const std::string token = "pm_" + ContentHash{random}.hex();
  const TokenRecord record{given, ipc::store::sha256(token), offer_->is.scopes, now_s, now_s + limits_.token_lifetime_s};
  tokens.tokens.push_back(record);
  if (const Result<void> written = write_tokens(tokens); !written) return fail(written.error());
  tokens_ = std::move(tokens);
  offer_.reset();
  note_locked(given, "paired", "");
  return NewToken{token, record};
}

/// Looks at every token, in a time that says nothing of how far one fits.
const TokenRecord* Access::find(const ContentHash& hash) {
  const std::int64_t now_s = latest_time();
  const TokenRecord* found = nullptr;
  for (const TokenRecord& token : tokens_.tokens)
    if (CRYPTO_memcmp(token.hash.bytes.data(), hash.bytes.data(), hash.bytes.size()) == 0) found = &token;
  return found != nullptr && found->expires_s > now_s ? found : nullptr;
}

bool Access::within_rate(const ContentHash& token) {
  const std::int64_t now_ns = clock_->now_ns();
  const auto [at, is_new] = rates_.try_emplace(token, Rate{limits_.requests_at_once, now_ns});
  Rate& rate = at->second;
  rate.left = std::min(limits_.requests_at_once, rate.left + static_cast<double>(now_ns - rate.at_ns) * 1e-9 * limits_.requests_per_s);
  rate.at_ns = now_ns;
  if (rate.left < 1) return false;
  rate.left -= 1;
  return true;
}

tl::expected<Caller, Denial> Access::caller_of(std::string_view token) {
  const ContentHash hash = ipc::store::sha256(token);
  const std::lock_guard lock(mutex_);
  const TokenRecord* found = find(hash);
  if (found == nullptr) return tl::unexpected(Denial::unknown);
  if (!within_rate(hash)) return tl::unexpected(Denial::too_many_requests);
  return Caller{found->name, found->scopes, found->hash};
}

bool Access::still_may(const Caller& caller, Scope scope) {
  const std::lock_guard lock(mutex_);
  const TokenRecord* found = find(caller.token);
  return found != nullptr && found->scopes.has(scope);
}

std::vector<TokenRecord> Access::tokens() {
  const std::lock_guard lock(mutex_);
  return tokens_.tokens;
}

Result<void> Access::revoke(const std::string& name) {
  const std::lock_guard lock(mutex_);
  TokenFile tokens = tokens_;
  latest_time();
  if (std::erase_if(tokens.tokens, [&](const TokenRecord& token) { return token.name == name; }) == 0)
    return fail("tokens", "there is none of '" + name + "'");
  if (const Result<void> written = write_tokens(tokens); !written) return written;
  tokens_ = std::move(tokens);
  note_locked(name, "revoked", "");
  return {};
}

void Access::note(const std::string& who, const std::string& what, const std::string& about) {
  const std::lock_guard lock(mutex_);
  note_locked(who, what, about);
}

void Access::note_locked(const std::string& who, const std::string& what, const std::string& about) {
  if (const Result<void> added = audit_.add({now_(), who, what, about}); !added)
    logging::error("the audit log misses '{}' of '{}': {}", what, who, added.error().text());
}

}  // namespace prismesh::intake
