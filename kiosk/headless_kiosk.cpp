#include "kiosk/headless_kiosk.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "kiosk/render/picture_file.h"

namespace prismesh::kiosk {

namespace {

constexpr std::int64_t kPatienceNs = 10'000'000'000;  ///< for a document, and for eyes
constexpr std::int64_t kRememberedNs = 2'000'000'000;
constexpr std::int64_t kTurnNs = 4'000'000;

}  // namespace

HeadlessKiosk::HeadlessKiosk(const AppOptions& options, Station& station, const render::Offscreen& target)
    : options_(options), station_(station), target_(target) {
  station_.screen.set_size(options.size);
}

/// Whether the picture shows what was asked for, or nothing more will come.
bool HeadlessKiosk::settled() const {
  const link::ModelLink& link = station_.link;
  if (!link.connection.connected() || !link.document.state() || !link.connection.progress().words().empty() || !link.document.up_to_date())
    return false;
  if ((options_.deck || link.document.state()->open) && link.document.snapshot() == nullptr) return false;
  // Without a daemon, or with a tracker that sees nobody, a picture in mono is all there is.
  return !station_.eyes.follows() || !station_.devices.connected() || station_.eyes.seen().depth_share >= 1;
}

Result<void> HeadlessKiosk::run() {
  if (Result<void> laid_out = station_.screen.lay_out(); !laid_out) return laid_out;  // so that the panels' width is known
  std::error_code ignored;
  std::filesystem::create_directories(options_.shots, ignored);
  const std::int64_t started = station_.clock.now_ns();
  std::int64_t due = started;
  bool begun = false;
  while (taken_ < options_.headless_frames || !shots_.empty()) {
    if (Result<void> turned = station_.turn(); !turned) return turned;
    remember();
    tell_seen();
    const std::int64_t now = station_.clock.now_ns();
    if (now >= station_.eyes.next_look_ns()) {
      station_.look();
      begun = begun || settled() || now - started >= kPatienceNs;
      if (const auto& model = station_.link.document.snapshot()) watch_.draws(model->shell_count());
      if (begun && now >= due && taken_ < options_.headless_frames) {
        if (Result<void> shot = shoot(); !shot) return shot;
        watch_.shown();
        due = now + std::llround(options_.pace_seconds * 1e9);
      }
    }
    watch_.turn(now, begun && now > due);
    std::this_thread::sleep_for(std::chrono::nanoseconds(kTurnNs));
  }
  return {};
}

Result<void> HeadlessKiosk::shoot() {
  const stereo::SeenFrom seen = station_.eyes.seen();
  if (Result<void> drawn = station_.screen.draw(target_.framebuffer(), std::nullopt, Screen::Pace::rest); !drawn) return drawn;
  const std::int64_t lit = station_.eyes.lit_ns();
  station_.eyes.taken();
  const std::filesystem::path file = options_.shots / fmt::format("frame-{:04}.png", ++taken_);
  if (Result<void> written = render::write_png(file, target_.read()); !written) return written;
  const mesh::Vec3& eyes = seen.between_eyes_mm;
  station_.trace.line("shot " + file.string());
  station_.trace.line(fmt::format("drawn_for {} lit {} share {:.3f} eyes {:.2f} {:.2f} {:.2f} mask {}", file.filename().string(), lit,
                                  seen.depth_share, eyes.x(), eyes.y(), eyes.z(),
                                  seen.mask_mm ? fmt::format("{:.4f}", *seen.mask_mm) : "none"));
  if (station_.eyes.follows() && station_.devices.connected()) shots_.push_back({file, lit});
  return {};
}

void HeadlessKiosk::remember() {
  const stereo::DeviceReading reading = station_.devices.read();
  if (!reading.eyes || !reading.prism) return;
  const std::array<double, 3>& place = reading.eyes->between_eyes_mm;
  measured_.push_back({reading.eyes->measured_ns, {place[0], place[1], place[2]}, reading.prism->measured_ns, reading.prism->position_mm});
  while (station_.clock.now_ns() - measured_.front().eyes_ns > kRememberedNs && measured_.size() > 1) measured_.pop_front();
}

void HeadlessKiosk::tell_seen() {
  constexpr std::int64_t kWaitedNs = 500'000'000;  ///< for a measurement that may never come
  while (!shots_.empty()) {
    const Shot& shot = shots_.front();
    const bool known = !measured_.empty() && measured_.back().eyes_ns >= shot.lit_ns && measured_.back().mask_ns >= shot.lit_ns;
    if (!known && station_.clock.now_ns() - shot.lit_ns < kWaitedNs) return;
    if (known) {
      const auto nearest = [&](auto time_of) {
        return *std::min_element(measured_.begin(), measured_.end(), [&](const Measured& a, const Measured& b) {
          return std::abs(time_of(a) - shot.lit_ns) < std::abs(time_of(b) - shot.lit_ns);
        });
      };
      const Measured eyes = nearest([](const Measured&m) { return m.eyes_ns; }), mask = nearest([](const Measured&m) { return m.mask_ns; });
      station_.trace.line(fmt::format("seen_from {} eyes {:.2f} {:.2f} {:.2f} mask {:.4f}", shot.file.filename().string(), eyes.eyes_mm.x(),
                                      eyes.eyes_mm.y(), eyes.eyes_mm.z(), mask.mask_mm));
    }
    shots_.pop_front();
  }
}

}  // namespace prismesh::kiosk
