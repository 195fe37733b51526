// Asks the model server where parts touch, one question at a time, and keeps its newest answer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/link/model_link.h"

namespace prismesh::kiosk::tools::contact {

/// After a search that took the server longer the next one waits until the user asks for it: edits would wait behind it. A slow
/// answer alone doesn't count: it may have waited behind an edit, or for a busy machine.
inline constexpr std::int64_t kMaxOwnSearchNs = 1'000'000'000;

class ContactLink {
 public:
  explicit ContactLink(link::ModelLink& link) : link_(link) {}

  /// Asks for the generation's regions unless they are here, or were refused, or the last search took long. Call it again after each
  /// message of the server. `now`: the user asks: none of these counts.
  void want(std::uint64_t generation, bool now = false);
  void forget();
  /// The newest ones; possibly of another generation. Null: none.
  const ipc::Contacts* contacts() const { return contacts_ ? &*contacts_ : nullptr; }
  /// Counts up with each answer.
  std::uint64_t answers() const { return answers_; }
  bool asking() const { return asking_; }
  /// Why there was no answer; empty: there was.
  const std::string& problem() const { return problem_; }

 private:
  link::ModelLink& link_;
  std::optional<ipc::Contacts> contacts_;
  std::optional<std::uint64_t> refused_;  ///< generation
  std::string problem_;
  bool slow_ = false;  ///< the last search took long, or the user stopped it
  std::uint64_t answers_ = 0;
  std::uint64_t question_ = 0;  ///< number of the last one: an answer to an earlier one doesn't count
  bool asking_ = false;
  std::uint64_t asked_on_ = 0;  ///< the connection
};

}  // namespace prismesh::kiosk::tools::contact
