// Asks the model server for the welds and what is wrong with them, and keeps its newest answer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/link/model_link.h"

namespace prismesh::kiosk::tools::welding {

/// After a search that took the server longer the next one waits until the user asks for it: edits would wait behind it.
inline constexpr std::int64_t kMaxOwnWeldSearchNs = 1'000'000'000;

class WeldList {
 public:
  explicit WeldList(link::ModelLink& link) : link_(link) {}

  /// Asks for the generation's welds unless they are here or the last search took long. Call it again after each message of the server.
  /// `now`: the user asks, so none of these counts.
  void want(std::uint64_t generation, bool now = false);
  void forget();
  /// The newest ones; possibly of another generation. Null: none.
  const ipc::WeldChecks* checks() const { return checks_ ? &*checks_ : nullptr; }
  /// Counts up with each answer.
  std::uint64_t answers() const { return answers_; }
  bool asking() const { return asking_; }
  /// Why there was no answer; empty: there was.
  const std::string& problem() const { return problem_; }

 private:
  link::ModelLink& link_;
  std::optional<ipc::WeldChecks> checks_;
  std::optional<std::uint64_t> refused_;  ///< generation
  std::string problem_;
  std::uint64_t answers_ = 0;
  std::uint64_t question_ = 0;  ///< number of the last one: an answer to an earlier one doesn't count
  std::uint64_t asked_on_ = 0;  ///< the connection
  bool asking_ = false;
};

}  // namespace prismesh::kiosk::tools::welding
