// Reads a DynaSight or D4D eye tracker over a serial port: starts the dialogue, keeps it running, and converts records to head samples. The
// device reports one point; the eyes are half an eye separation to either side of it. docs/devices/eye-tracker.md describes the dialogue.
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

inline constexpr std::byte kInterrupt{0x03};      ///< ^C; three in a row end the current mode
inline constexpr std::byte kPolled{'4'};          ///< starts polled mode: one record per request
inline constexpr std::byte kRequestRecord{0x11};  ///< polled: requests one record
inline constexpr std::byte kStreamDynasight{'V'};
inline constexpr std::byte kStreamD4d{'0'};

/// Initial values, not yet verified on hardware.
struct DialogueTimes {
  std::int64_t settle_ns = 50'000'000;    ///< pause between the interrupts and the next command
  std::int64_t answer_ns = 100'000'000;   ///< polled: repeats the request after so long without an answer
  std::int64_t silence_ns = 500'000'000;  ///< restarts the dialogue after so long without a record
};

class DynasightTracker final : public EyeTracker {
 public:
  struct Options {
    settings::TrackerDialect dialect = settings::TrackerDialect::d4d;
    bool polled = false;
    int baud = 19200;
    std::int64_t latency_ns = 20'000'000;  ///< from the head's position to the record's last byte
    Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();
    DialogueTimes times = {};
  };
  /// `port` must outlive this.
  DynasightTracker(port::BytePort& port, const Options& options);

  Polled poll(std::int64_t now_ns) override;
  bool synchronised() const override { return synchroniser_.synchronised(); }
  const LineCounts& counts() const override { return counts_; }

 private:
  enum class Stage : std::uint8_t { begin, settle, listen };
  /// Result of reading in one poll.
  struct Reading {
    std::uint64_t bytes = 0;
    std::uint64_t sample_end = 0;  ///< number of bytes read when the newest sample was complete
    bool sampled = false;
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
    bool doubtful = false;
  };

  port::PortStatus read(std::int64_t now_ns, Reading& reading);
  void take(std::byte byte, std::int64_t now_ns, Reading& reading);
  std::int64_t measured_ns(std::int64_t now_ns, const Reading& reading) const;
  void run_dialogue(std::int64_t now_ns);
  void request_record(std::int64_t now_ns);
  void queue_command(std::byte command);
  port::PortStatus send();
  void count();

  port::BytePort* port_;
  Options options_;
  Synchroniser synchroniser_;
  LineCounts counts_;
  Stage stage_ = Stage::begin;
  std::int64_t stage_ns_ = 0;      ///< start of the stage
  std::int64_t record_ns_ = 0;     ///< time of the last record, or of the dialogue's start
  std::int64_t requested_ns_ = 0;  ///< polled
  std::uint64_t bytes_since_request_ = 0;
  std::int64_t last_measured_ns_ = std::numeric_limits<std::int64_t>::min();
  std::array<std::byte, 8> unsent_{};
  std::size_t unsent_count_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::dynasight
