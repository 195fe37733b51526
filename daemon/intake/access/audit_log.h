// What was done with tokens and models, a line each; each line carries a hash of itself and the line before, so that a line that was
// changed or taken out is found.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/store/folder.h"
#include "ipc/store/sha256.h"

namespace prismesh::intake {

struct AuditEntry {
  std::int64_t when_s = 0;
  std::string who;   ///< a token's name; empty: nobody that is known
  std::string what;  ///< a word: "paired", "published"
  std::string about;
};

/// Used by one thread at a time.
class AuditLog {
 public:
  /// A line that was cut off by a power cut is taken off; `note` says so. Errors: the chain is broken (with line), the disk.
  static Result<AuditLog> open(const ipc::store::Folder& folder, const std::string& name, std::string& note);
  /// The entry is on disk afterwards.
  Result<void> add(const AuditEntry& entry);
  std::uint64_t count() const { return count_; }

 private:
  AuditLog(ipc::Descriptor file, std::filesystem::path shown) : file_(std::move(file)), shown_(std::move(shown)) {}
  ipc::Descriptor file_;
  std::filesystem::path shown_;
  std::uint64_t size_ = 0;
  std::uint64_t count_ = 0;
  std::string last_;  ///< the hash of the last line
};

/// Checks the whole text of a log: its last hash, its lines, and how many bytes are whole lines. Errors, with line: the chain is broken.
struct AuditChain {
  std::string last;
  std::uint64_t lines = 0;
  std::uint64_t whole_bytes = 0;
};
Result<AuditChain> check_audit(std::string_view text, const std::string& file);

}  // namespace prismesh::intake
