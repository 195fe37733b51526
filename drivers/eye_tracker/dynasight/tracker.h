// Reads a DynaSight or D4D eye tracker over a serial port: brings it to talk, keeps it talking, and turns its records into head samples.
// It gives one point; the eyes are half an eye separation to either side of it. docs/devices/eye-tracker.md describes the talk.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include "drivers/eye_tracker/dynasight/synchroniser.h"
#include "drivers/eye_tracker/eye_tracker.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::eye_tracker::dynasight {

inline constexpr std::byte kInterrupt{0x03};  ///< ^C; three in a row end whatever the device does
inline constexpr std::byte kPolled{'4'};      ///< from now on a record only when asked
inline constexpr std::byte kAsk{0x11};        ///< polled: one record, please
inline constexpr std::byte kStreamDynasight{'V'};
inline constexpr std::byte kStreamD4d{'0'};

/// Starting values; none has met the hardware.
struct TalkTimes {
  std::int64_t settle_ns = 50'000'000;    ///< after the interrupts, before the next command
  std::int64_t answer_ns = 100'000'000;   ///< polled: no answer for this long: ask again
  std::int64_t silence_ns = 500'000'000;  ///< no record for this long: begin the talk anew
};

class DynasightTracker final : public EyeTracker {
 public:
  struct Options {
    settings::TrackerDialect dialect = settings::TrackerDialect::d4d;
    bool polled = false;
    int baud = 19200;
    std::int64_t latency_ns = 20'000'000;  ///< from the head being there to the record's last byte
    Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();
    TalkTimes times = {};
  };
  /// `port` must outlive this.
  DynasightTracker(port::BytePort& port, const Options& options);

  Polled poll(std::int64_t now_ns) override;
  bool synchronised() const override { return synchroniser_.synchronised(); }
  const LineCounts& counts() const override { return counts_; }

 private:
  enum class Stage : std::uint8_t { begin, settle, listen };
  /// What a poll has read.
  struct Reading {
    std::uint64_t bytes = 0;
    std::uint64_t sample_end = 0;  ///< how many bytes were read when the newest sample was complete
    bool sampled = false;
    Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();
    bool doubtful = false;
  };

  port::PortStatus read(std::int64_t now_ns, Reading& reading);
  void take(std::byte byte, std::int64_t now_ns, Reading& reading);
  std::int64_t measured_ns(std::int64_t now_ns, const Reading& reading) const;
  void talk(std::int64_t now_ns);
  void ask(std::int64_t now_ns);
  void say(std::byte command);
  port::PortStatus send();
  void count();

  port::BytePort* port_;
  Options options_;
  Synchroniser synchroniser_;
  LineCounts counts_;
  Stage stage_ = Stage::begin;
  std::int64_t stage_ns_ = 0;   ///< when the stage began
  std::int64_t record_ns_ = 0;  ///< of the last record, or of the talk's begin
  std::int64_t asked_ns_ = 0;   ///< polled
  std::uint64_t bytes_since_asked_ = 0;
  std::int64_t last_measured_ns_ = std::numeric_limits<std::int64_t>::min();
  std::array<std::byte, 8> unsent_{};
  std::size_t unsent_count_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::dynasight
