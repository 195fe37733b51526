// Shows the state before the last edit and the newest state in turn. Sends no edits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/link/model_link.h"
#include "kiosk/notices/notices.h"
#include "kiosk/tools/comparison/comparing.h"

namespace prismesh::kiosk::tools::comparison {

class BeforeAfter {
 public:
  BeforeAfter(link::ModelLink& link, Comparing& comparing, notices::Notices& notices, notices::Trace trace)
      : link_(link), comparing_(comparing), notices_(notices), trace_(trace) {}

  /// Shows the other one of the two states, at first the one before the last edit. Waits for edits under way.
  void toggle();
  /// Ends it: shows again what was shown before. False: the picture stays the same.
  bool end();
  /// Call after the link has turned and before Comparing follows. Another newest state ends it.
  void follow();
  /// Call after Comparing has followed: writes to the trace what is shown.
  void tell();

  /// "A: before lift   C shows B"; empty: neither state is shown.
  std::string words() const;
  /// The state before the last edit is on the screen.
  bool shows_before() const { return pair_ && showing_before_ && comparing_.shows_older(); }
  /// The last edit, in words.
  std::string edit() const { return pair_ && !pair_->edit.empty() ? pair_->edit : "the last edit"; }

 private:
  struct Pair {
    std::uint64_t document = 0;  ///< FollowedDocument::number
    std::string edit;
    std::uint64_t before = 0, after = 0;  ///< generations
  };
  void ask();
  void begin(const ipc::DocumentState& state);
  void show();

  link::ModelLink& link_;
  Comparing& comparing_;
  notices::Notices& notices_;
  notices::Trace trace_;
  bool wanted_ = false;                    ///< and not begun: the states aren't known yet
  std::optional<std::uint64_t> asked_on_;  ///< the connection on which the states were asked for and haven't come
  std::optional<Pair> pair_;
  bool showing_before_ = false;
  std::string told_;
};

}  // namespace prismesh::kiosk::tools::comparison
