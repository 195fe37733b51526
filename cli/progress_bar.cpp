#include "cli/progress_bar.h"

#include <algorithm>
#include <ostream>

namespace prismesh::cli {

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kPatienceNs = 300'000'000;
constexpr std::int64_t kPeriodNs = 100'000'000;
constexpr std::int64_t kLinePatienceNs = 2 * kSecondNs;
constexpr std::int64_t kLinePeriodNs = 5 * kSecondNs;
constexpr int kWidth = 30;
constexpr int kWidthBesideWords = 10;
constexpr std::size_t kMaxColumns = 79;  ///< a longer line would wrap, and could not be erased

}  // namespace

ProgressBar::ProgressBar(const Context& context, std::string what, Clock& clock)
    : context_(context),
      what_(std::move(what)),
      clock_(clock),
      begun_ns_(clock.now_ns()),
      next_draw_ns_(begun_ns_ + (context.terminal ? kPatienceNs : kLinePatienceNs)) {}

ProgressBar::~ProgressBar() {
  if (drawn_) context_.err << "\r\x1b[K" << std::flush;
}

Progress ProgressBar::progress() {
  return [this](double fraction, const Doing& doing) {
    if ((context_.terminal || doing) && clock_.now_ns() >= next_draw_ns_) {
      if (context_.terminal)
        draw(std::clamp(fraction, 0.0, 1.0), doing);
      else
        write_line(doing);
    }
    return !context_.stop();
  };
}

std::string ProgressBar::said(const Doing& doing) const {
  return doing() + ", " + std::to_string((clock_.now_ns() - begun_ns_) / kSecondNs) + " s";
}

void ProgressBar::draw(double fraction, const Doing& doing) {
  const int width = doing ? kWidthBesideWords : kWidth, filled = static_cast<int>(fraction * width);
  std::string line = what_ + " [" + std::string(static_cast<std::size_t>(filled), '#') +
                     std::string(static_cast<std::size_t>(width - filled), '.') + "] " + std::to_string(static_cast<int>(fraction * 100)) +
                     " %";
  if (doing) line = (line + "  " + said(doing)).substr(0, kMaxColumns);
  context_.err << '\r' << line << "\x1b[K" << std::flush;
  drawn_ = true;
  next_draw_ns_ = clock_.now_ns() + kPeriodNs;
}

void ProgressBar::write_line(const Doing& doing) {
  context_.err << what_ << ": " << said(doing) << std::endl;
  next_draw_ns_ = clock_.now_ns() + kLinePeriodNs;
}

}  // namespace prismesh::cli
