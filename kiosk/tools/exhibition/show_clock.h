// The stages of an exhibition: a show until somebody comes, a visit, a warning when nothing is done any more, and then the show again.
// Pure: times are passed in.
#pragma once

#include <cstdint>

namespace prismesh::kiosk::tools::exhibition {

enum class Stage : std::uint8_t {
  show,      ///< the program edits by itself, and nothing that is done reaches it
  visit,     ///< a visitor works
  warning,   ///< the visit is about to end
  over,      ///< it has ended: everything is to be made anew
  unlocked,  ///< somebody who knows the PIN works: nothing is closed
};

struct ShowTimes {
  std::int64_t idle_ns = 90'000'000'000;       ///< of a visit without any input, until the warning
  std::int64_t warning_ns = 15'000'000'000;    ///< of the warning
  std::int64_t unlocked_ns = 600'000'000'000;  ///< without any input, until it is locked again
};

class ShowClock {
 public:
  explicit ShowClock(const ShowTimes& times) : times_(times) {}

  Stage stage() const { return stage_; }
  /// Somebody did something. Ends the show and the warning. Returns whether that is all it does: it was no work on the model.
  bool touched(std::int64_t now_ns);
  /// Whether a face is before the display. One that comes ends the show; one that stays does nothing more.
  void face(bool there, std::int64_t now_ns);
  void turn(std::int64_t now_ns);
  void unlock(std::int64_t now_ns);
  /// Ends a visit or an unlocked time at once.
  void end();
  /// Of the warning, rounded up.
  int seconds_left(std::int64_t now_ns) const;
  /// When `turn` must be called at the latest; negative: never.
  std::int64_t next_ns(std::int64_t now_ns) const;

  static constexpr std::int64_t kFaceNs = 700'000'000;  ///< so long a face must stay to count: nobody who walks by
  static constexpr std::int64_t kGoneNs =
      2'000'000'000;  ///< so long it must be away to be another one when it comes back: trackers lose a face for a moment

 private:
  void become(Stage stage, std::int64_t now_ns);

  ShowTimes times_;
  Stage stage_ = Stage::show;
  std::int64_t since_ns_ = 0;        ///< the last input, or the warning's beginning
  std::int64_t face_since_ns_ = -1;  ///< negative: none is there
  std::int64_t gone_since_ns_ = -1;  ///< negative: one is there
  bool face_counted_ = true;         ///< a face that is there at the beginning has seen the last visit
};

}  // namespace prismesh::kiosk::tools::exhibition
