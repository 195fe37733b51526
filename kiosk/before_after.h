// Looking back and forth between the newest state and the one before the last edit. Both are only shown: nothing is sent that edits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/comparing.h"
#include "kiosk/model_link.h"
#include "kiosk/notices.h"

namespace prismesh::kiosk {

class BeforeAfter {
 public:
  BeforeAfter(ModelLink& link, Comparing& comparing, Notices& notices, Trace trace)
      : link_(link), comparing_(comparing), notices_(notices), trace_(trace) {}

  /// The other one of the two states; at first the one before the last edit. Waits for edits that are under way.
  void toggle();
  /// What was shown before is shown again. False: nothing looks otherwise than before.
  bool end();
  /// After the link has turned, and before Comparing follows: another newest state ends it.
  void follow();
  /// After Comparing has followed: says what is shown now.
  void tell();

  /// "A: before lift   C shows B"; empty: neither of the two is shown as one of two.
  std::string words() const;
  /// The state before the last edit is on the screen.
  bool shows_before() const { return pair_ && showing_before_ && comparing_.shows_older(); }
  /// The last edit, in words.
  std::string edit() const { return pair_ && !pair_->edit.empty() ? pair_->edit : "the last edit"; }

 private:
  struct Pair {
    std::uint64_t document = 0;  ///< ModelLink::document_number
    std::string edit;
    std::uint64_t before = 0, after = 0;  ///< generations
  };
  void ask();
  void begin(const ipc::DocumentState& state);
  void show();

  ModelLink& link_;
  Comparing& comparing_;
  Notices& notices_;
  Trace trace_;
  bool wanted_ = false;                    ///< and not begun: the states aren't known yet
  std::optional<std::uint64_t> asked_on_;  ///< the connection on which the states were asked for and haven't come
  std::optional<Pair> pair_;
  bool showing_before_ = false;
  std::string told_;
};

}  // namespace prismesh::kiosk
