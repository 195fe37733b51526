// Simulates the device's side of the DynaSight/D4D protocol: executes the commands and sends records of a moving head, at the line's baud
// rate and with a real device's faults. For tests in virtual time (on a MemoryLine's device end) and for stations without hardware (on a
// pseudo-terminal's master).
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "drivers/eye_tracker/dynasight/record.h"
#include "drivers/eye_tracker/simulated_head.h"
#include "drivers/port/byte_port.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::eye_tracker::dynasight {

/// Probabilities per record unless stated otherwise.
struct Faults {
  double drop_out = 0;      ///< the head is lost for a while: `coast_s` of coast, then search
  double drop_out_s = 0.4;  ///< total duration
  double coast_s = 0.1;
  double caution = 0;       ///< the record is marked as caution
  double garbage = 0;       ///< one to seven noise bytes precede the record
  double damaged_byte = 0;  ///< per byte: one bit is inverted
  double lost_byte = 0;     ///< per byte: the byte is lost
};

class DynasightSimulator final : public TrackerSimulator {
 public:
  struct Options {
    settings::TrackerDialect dialect = settings::TrackerDialect::d4d;
    int baud = 19200;
    double rate_hz = 60;
    double noise_mm = 1;                   ///< standard deviation along each axis
    std::int64_t latency_ns = 20'000'000;  ///< from the head's position to its record's last byte
    std::int64_t power_up_ns = 0;          ///< after power-on, ignores commands and sends nothing for so long
    bool streams_at_power_up = false;
    Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();  ///< the tracker's origin in screen coordinates
    int target = 0;
    Faults faults = {};
    std::uint64_t seed = 1;
  };
  /// `line` is the device's end and must outlive this.
  DynasightSimulator(port::BytePort& line, HeadSource head, const Options& options);

  void run_until(std::int64_t now_ns) override;
  /// Off: sends nothing, ignores commands, and resets its mode. On: as after plugging it in.
  void set_power(bool on);
  void set_faults(const Faults& faults) { options_.faults = faults; }

  enum class Mode : std::uint8_t { waiting, streaming, polled };
  Mode mode() const { return mode_; }
  std::uint64_t records_sent() const { return records_sent_; }
  std::uint64_t unknown_commands() const { return unknown_commands_; }

 private:
  void read_commands();
  void handle_command(std::byte command);
  void begin_record();
  Record measure(std::int64_t at_ns);
  void queue(std::byte byte);
  void send_due();
  bool happens(double chance);
  std::int64_t byte_ns() const;

  port::BytePort* line_;
  HeadSource head_;
  Options options_;
  std::mt19937_64 random_;
  Mode mode_ = Mode::waiting;
  bool power_ = true;
  bool started_ = false;
  std::int64_t start_ns_ = 0;  ///< start of the simulator's time
  std::int64_t now_ns_ = 0;
  std::int64_t awake_ns_ = 0;       ///< end of power-up
  std::int64_t due_ns_ = 0;         ///< when the next record's first byte is sent
  bool requested_ = false;          ///< polled: a record was requested
  int interrupts_ = 0;              ///< number of consecutive ^C
  std::int64_t lost_until_ns_ = 0;  ///< end of a drop-out
  std::int64_t lost_since_ns_ = 0;
  Eigen::Vector3d last_seen_mm_ = Eigen::Vector3d::Zero();
  std::array<std::byte, 64> out_{};  ///< bytes of the record being sent
  std::size_t out_count_ = 0, out_sent_ = 0;
  std::int64_t out_ns_ = 0;  ///< when the next of them is sent
  std::uint64_t records_sent_ = 0, unknown_commands_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::dynasight
