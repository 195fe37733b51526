// Shows pictures on an output, one at each refresh of the display, and never waits: a picture given while the last one hasn't appeared yet
// waits for it, and takes the place of one that waits already. Copes with what drivers do: a card that is busy, a mode that was taken away,
// an event that is late or never comes, another program that owns the display for a while.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "kiosk/display/kms/card.h"
#include "kiosk/display/kms/link.h"
#include "kiosk/display/kms/output.h"

namespace prismesh::kiosk::display::kms {

struct FlipCounts {
  std::uint64_t shown = 0;     ///< pictures that have appeared
  std::uint64_t replaced = 0;  ///< pictures that a newer one replaced before they appeared
  std::uint64_t missed = 0;    ///< refreshes that a picture given in time had to wait beyond the next
  std::uint64_t busy = 0;      ///< times that the card was still busy
  std::uint64_t lost = 0;      ///< pictures whose event never came
  std::uint64_t modes = 0;     ///< times that the mode was set
};

class Flipper {
 public:
  /// The event of a picture counts as lost after this time, or ten refreshes if they take longer.
  static constexpr std::int64_t kLostNs = 1'000'000'000;
  /// A card that is busy so long without an event has hung.
  static constexpr std::int64_t kHungNs = 10'000'000'000;

  Flipper(Card& card, Clock& clock) : card_(card), clock_(clock) {}
  ~Flipper();
  Flipper(const Flipper&) = delete;
  Flipper& operator=(const Flipper&) = delete;

  /// Shows on this output from the next picture on, with its mode set anew. The pictures of the output before are released.
  void set_output(Output output);
  const Output& output() const { return output_; }

  /// Gives a picture to be shown. Errors: the card is gone, or refuses the mode.
  Result<void> show(ObjectId framebuffer);
  /// Takes the card's events and goes on; call it when `Card::descriptor` is readable, and at `next_ns`.
  Result<void> turn();
  /// When `turn` must be called although nothing happens; nothing: never.
  std::optional<std::int64_t> next_ns() const;
  /// The pictures that the display doesn't use any more; each is returned once.
  std::vector<ObjectId> take_released();

  /// Another program shows its pictures from now on. The events of ours may never come.
  void pause();
  /// The display is ours again: the mode is set anew with the last picture.
  Result<void> resume();

  /// When the newest picture began to be shown; nothing: none has been, or the card's times are none.
  std::optional<std::int64_t> shown_ns() const { return shown_ns_; }
  const FlipCounts& counts() const { return counts_; }
  /// What the driver refused to set, a sentence each.
  const std::vector<std::string>& refused() const { return refused_; }

 private:
  Result<void> advance();
  void give_up_event();
  void replace_shown();
  Result<void> commit(ObjectId framebuffer);
  Result<void> prepare_mode(ObjectId framebuffer);
  Result<void> judge(int error, bool sets_mode);
  Change change(ObjectId framebuffer, bool sets_mode, const std::vector<LinkWish>& wishes) const;
  void release(std::optional<ObjectId>& picture);
  void take(const Flip& flip);
  std::int64_t period_ns() const;

  Card& card_;
  Clock& clock_;
  CardState state_;
  Output output_;
  std::vector<LinkWish> wishes_;
  std::vector<std::string> refused_;
  ObjectId mode_blob_ = 0;
  bool mode_set_ = false;  ///< and nobody has changed it since, as far as is known
  bool paused_ = false;
  std::optional<ObjectId> shown_, pending_, next_;
  bool again_ = false;             ///< the shown picture may not be on the display: it is shown again, unless a newer one is there
  std::uint64_t token_ = 0;        ///< of the newest change
  std::int64_t committed_ns_ = 0;  ///< when `pending_` was given to the card
  std::optional<std::int64_t> retry_ns_, busy_since_ns_;
  std::optional<std::int64_t> shown_ns_;
  std::vector<ObjectId> released_;
  FlipCounts counts_;
};

}  // namespace prismesh::kiosk::display::kms
