#include "cli/progress_bar.h"

#include <algorithm>
#include <ostream>

namespace prismesh::cli {

namespace {

constexpr std::int64_t kPatienceNs = 300'000'000;
constexpr std::int64_t kPeriodNs = 100'000'000;
constexpr int kWidth = 30;

}  // namespace

ProgressBar::ProgressBar(const Context& context, std::string what, Clock& clock)
    : context_(context), what_(std::move(what)), clock_(clock), next_draw_ns_(clock.now_ns() + kPatienceNs) {}

ProgressBar::~ProgressBar() {
  if (drawn_) context_.err << "\r\x1b[K" << std::flush;
}

Progress ProgressBar::progress() {
  return [this](double fraction) {
    if (context_.terminal && clock_.now_ns() >= next_draw_ns_) draw(std::clamp(fraction, 0.0, 1.0));
    return !context_.stop();
  };
}

void ProgressBar::draw(double fraction) {
  const int filled = static_cast<int>(fraction * kWidth);
  context_.err << '\r' << what_ << " [" << std::string(static_cast<std::size_t>(filled), '#')
               << std::string(static_cast<std::size_t>(kWidth - filled), '.') << "] " << static_cast<int>(fraction * 100) << " %\x1b[K"
               << std::flush;
  drawn_ = true;
  next_draw_ns_ = clock_.now_ns() + kPeriodNs;
}

}  // namespace prismesh::cli
