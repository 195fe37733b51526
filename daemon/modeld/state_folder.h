// modeld's files between two lives: journals named by their deck, and what was open. The rules are in docs/protocol.md.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "ipc/messages.h"

namespace prismesh::modeld {

/// $STATE_DIRECTORY, else $XDG_STATE_HOME/prismesh, else ~/.local/state/prismesh; `override` before all.
std::filesystem::path state_directory(const std::optional<std::filesystem::path>& override = {});

class StateFolder {
 public:
  explicit StateFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The journal of a deck in one state of its content.
  std::filesystem::path journal(const std::filesystem::path& deck, const Hash128& content) const;
  /// Journals of the same deck in other states.
  std::vector<std::filesystem::path> other_journals(const std::filesystem::path& deck, const Hash128& content) const;
  /// Beside a journal: what a save that is under way will have changed.
  static std::filesystem::path save_intent(const std::filesystem::path& journal);
  /// Save intents of a deck, whatever its state.
  std::vector<std::filesystem::path> save_intents(const std::filesystem::path& deck) const;

  /// Removes a file of this folder, if it is there, so that it stays removed.
  void remove(const std::filesystem::path& file) const;
  /// A number above all that earlier lives have begun with and those they may have counted up to from there. By the clock, and by what is
  /// noted here in case it was set back.
  std::uint64_t first_number() const;
  /// Takes a journal out of use without deleting it: it gets `ending` and a number. Only the newest are kept.
  Result<std::filesystem::path> retire(const std::filesystem::path& journal, const char* ending) const;

  struct Session {
    ipc::Open open;
    std::uint64_t attempts = 0;  ///< starts that tried to open it and didn't get to the end
  };
  Result<void> write_session(const Session& session) const;
  Result<std::optional<Session>> read_session() const;
  void forget_session() const;

 private:
  std::filesystem::path folder_;
};

}  // namespace prismesh::modeld
