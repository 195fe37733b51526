// A vault: objects in a store that speaks S3, each written once; cut lines and refusals for a while are tried again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/store/record.h"
#include "ipc/vault/s3_answers.h"
#include "ipc/vault/s3_line.h"
#include "ipc/wire/retrying.h"

namespace prismesh::ipc::vault {

struct VaultOptions {
  S3Patience line;
  RetryPatience retry;
};

class Vault {
 public:
  Vault(VaultAddress address, const VaultSettings& keys, VaultOptions options, Stop stop);

  /// Its address, for messages.
  std::string name() const { return line_.address().text(); }

  /// Nothing: there is no such object.
  Result<std::optional<std::uint64_t>> size_of(const std::string& object);
  /// The bytes that were put under this name. Nothing: there is no such object. Errors: it has more than `max_bytes`; what comes has
  /// another hash each time.
  Result<std::optional<std::string>> get(const std::string& object, const store::ContentHash& hash, std::size_t max_bytes);
  /// As above, without a hash to compare with.
  Result<std::optional<std::string>> get_unchecked(const std::string& object, std::size_t max_bytes);
  /// The store compares the bytes with their hash.
  Result<void> put(const std::string& object, std::string_view bytes, const store::ContentHash& hash);
  /// All objects whose names begin so. Errors: over_limit: more than 200,000.
  Result<std::vector<ListedObject>> list(std::string_view beginning);

  bool is_stopped() const { return retrying_.is_stopped(); }

 private:
  /// Tries until there is an answer. Errors: as Retrying.
  Result<S3Answer> ask(const S3Request& request, std::string& content, std::size_t max_bytes);
  /// What an answer says that isn't what was asked for.
  Error refusal(const S3Answer& answer) const;

  S3Line line_;
  Retrying retrying_;
};

/// All models that are there, the newest first, with their newest names; one that also has the name `preferred` has that. One without a
/// name that can be read has none, and the time 0.
Result<std::vector<store::ModelRecord>> models(Vault& vault, std::string_view preferred = {});

}  // namespace prismesh::ipc::vault
