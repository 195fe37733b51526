// Tells systemd that the kiosk works: it is ready with its first picture, and alive as long as each picture that is asked for appears.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace prismesh::kiosk {

/// How the watch tells: base/supervisor.h, or a test.
struct PictureReports {
  std::optional<std::int64_t> period_ns;  ///< between two reports that the kiosk is alive; nothing: none are wanted
  std::function<void()> ready, alive;
  std::function<void(std::int64_t)> allow;  ///< so long (ns) without a report
};
PictureReports reports_to_supervisor();

class PictureWatch {
 public:
  /// A picture may take so long. Software drawing of millions of shells takes a few seconds.
  static constexpr std::int64_t kMaxWaitNs = 8'000'000'000;

  /// What a shell may add to the time of a picture: software draws a million in about a second, and loading them takes another.
  static constexpr std::int64_t kShellNs = 3'000;

  explicit PictureWatch(PictureReports reports) : reports_(std::move(reports)) {}

  /// Called before a model of so many shells is drawn, which may take longer than a report may be late.
  void draws(std::size_t shells);
  /// Called in each turn of the kiosk's loop. `asked`: what is shown is out of date.
  void turn(std::int64_t now_ns, bool asked);
  /// A piece of a picture was drawn: the wait for it begins anew.
  void draws_piece() { asked_ns_.reset(); }
  /// A picture has appeared.
  void shown();
  /// When `turn` must be called at the latest, so that the report isn't late; nothing: no report is wanted.
  std::optional<std::int64_t> next_ns() const;

 private:
  PictureReports reports_;
  bool ready_ = false;
  std::size_t shells_ = 0;
  std::optional<std::int64_t> asked_ns_;
  std::int64_t told_ns_ = 0;
};

}  // namespace prismesh::kiosk
