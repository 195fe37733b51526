// Files that modeld keeps between two runs: journals named by their deck, and which deck was open. docs/protocol.md has the rules.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "ipc/model/messages.h"

namespace prismesh::modeld {

/// The ending of what was moved aside since it can't be read.
inline constexpr const char* kDamaged = ".damaged";

class StateFolder {
 public:
  explicit StateFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Path of the journal of a deck with this content.
  std::filesystem::path journal(const std::filesystem::path& deck, const Hash128& content) const;
  /// Journals of the same deck with other contents.
  std::vector<std::filesystem::path> other_journals(const std::filesystem::path& deck, const Hash128& content) const;
  /// Path of the save intent (save_intent.h) that belongs to a journal.
  static std::filesystem::path save_intent(const std::filesystem::path& journal);
  /// Save intents of a deck, whatever its content.
  std::vector<std::filesystem::path> save_intents(const std::filesystem::path& deck) const;

  /// Removes a file of this folder if it exists, and flushes the folder, so that a power cut doesn't bring it back.
  void remove(const std::filesystem::path& file) const;
  /// Returns a first chunk number above all numbers that earlier runs can have used. Derived from the clock, and from a noted number in
  /// case the clock was set back.
  std::uint64_t first_number() const;
  /// Renames a file to `ending` and a number, so that it is no longer used. Of the retired journals only the newest are kept, and all that
  /// are `kDamaged`. Returns the new path. Errors: it can't be renamed.
  Result<std::filesystem::path> retire(const std::filesystem::path& journal, const char* ending) const;

  struct Session {
    ipc::Open open;
    std::uint64_t attempts = 0;  ///< starts of the daemon that began to open it and never finished
  };
  /// A file that can't be read is moved aside first. Errors: it can't be written.
  Result<void> write_session(const Session& session) const;
  Result<std::optional<Session>> read_session() const;
  void forget_session() const;

 private:
  void keep_unread_session() const;

  std::filesystem::path folder_;
};

}  // namespace prismesh::modeld
