// The states that undo and redo move among, as the model server told them last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kiosk/link/connection.h"

namespace prismesh::kiosk::link {

class FollowedHistory final : public ConnectionListener {
 public:
  explicit FollowedHistory(Connection& connection) : connection_(connection) { connection_.add(*this); }

  /// Oldest first; empty: not told yet.
  const std::vector<ipc::ListedGeneration>& states() const { return told_.generations; }
  /// Undone states that edits took the place of.
  const std::vector<ipc::HistoryBranch>& branches() const { return told_.branches; }
  /// What made a state of the history or of a branch; empty: it isn't known.
  std::string_view maker_of(std::uint64_t generation) const;
  /// Index of a state; absent: it isn't among them.
  std::optional<std::size_t> place_of(std::uint64_t generation) const;
  /// The server may have other states by now, and wasn't asked for them.
  bool stale() const { return stale_ && !asking_ && connection_.connected(); }
  /// They are those of now, as far as the server has told.
  bool fresh() const { return !stale_ && !asking_; }
  void ask();

  void heard(const ipc::Event& event) override;
  void lost() override;

 private:
  Connection& connection_;
  ipc::History told_;
  bool stale_ = true, asking_ = false;
};

}  // namespace prismesh::kiosk::link
