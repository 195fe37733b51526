#include "kiosk/picture_watch.h"

#include <chrono>

#include "base/supervisor.h"

namespace prismesh::kiosk {

PictureReports reports_to_supervisor() {
  PictureReports reports{{},
                         [] { supervisor::tell_ready("shows the model"); },
                         supervisor::tell_alive,
                         [](std::int64_t ns) { supervisor::set_max_silence(std::chrono::microseconds(ns / 1000)); }};
  if (const auto period = supervisor::period()) reports.period_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(*period).count();
  return reports;
}

void PictureWatch::turn(std::int64_t now_ns, bool asked) {
  if (!asked)
    asked_ns_.reset();
  else if (!asked_ns_)
    asked_ns_ = now_ns;
  if (!reports_.period_ns || now_ns - told_ns_ < *reports_.period_ns) return;
  if (asked_ns_ && now_ns - *asked_ns_ > kMaxWaitNs) return;
  told_ns_ = now_ns;
  reports_.alive();
}

void PictureWatch::draws(std::size_t shells) {
  if (!reports_.period_ns || shells <= shells_ + shells_ / 10) return;
  shells_ = shells;
  reports_.allow(2 * *reports_.period_ns + static_cast<std::int64_t>(shells) * kShellNs);
  reports_.alive();
}

void PictureWatch::shown() {
  asked_ns_.reset();
  if (ready_) return;
  ready_ = true;
  reports_.ready();
}

std::optional<std::int64_t> PictureWatch::next_ns() const {
  if (!reports_.period_ns) return std::nullopt;
  return told_ns_ + *reports_.period_ns;
}

}  // namespace prismesh::kiosk
