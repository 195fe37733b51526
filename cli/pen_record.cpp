#include "cli/pen_record.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/file.h"
#include "cli/report_text.h"
#include "drivers/haptics/replay.h"
#include "drivers/haptics/safety_words.h"
#include "ipc/pen/client.h"

namespace prismesh::cli {

namespace {

using drivers::haptics::PenTick;
using drivers::haptics::ReplayReport;

/// Far shorter than the ring's four seconds.
constexpr std::chrono::milliseconds kReadPeriod{50};

class RingCopy {
 public:
  explicit RingCopy(const ipc::PenTickRing& ring) : ring_(ring) {
    const std::uint64_t count = ring.count();
    next_ = count > ipc::PenTickRing::kTicks ? count - ipc::PenTickRing::kTicks + 1 : 0;
  }
  /// Appends what has come since the last call.
  void write(std::ostream& out) {
    for (const std::uint64_t count = ring_.count(); next_ < count; ++next_) {
      const std::optional<PenTick> tick = ring_.read(next_);
      if (!tick) {
        ++missed_;
        continue;
      }
      out << drivers::haptics::pen_record_line(*tick);
      if (written_++ == 0) first_ns_ = tick->now_ns;
      last_ns_ = tick->now_ns;
    }
  }
  std::string text(const std::filesystem::path& file) const {
    std::string text = fmt::format("recorded {} ({:.1f} s) to {}\n", counted(written_, "tick"),
                                   static_cast<double>(last_ns_ - first_ns_) * 1e-9, printable(file.string()));
    if (missed_ > 0)
      text += fmt::format("{} missing: this program was too slow to read them\n",
                          missed_ == 1 ? "1 tick is" : counted(missed_, "tick") + " are");
    return text;
  }

 private:
  const ipc::PenTickRing& ring_;
  std::uint64_t next_ = 0, written_ = 0, missed_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
};

std::string replay_text(const drivers::haptics::PenRecord& record, const ReplayReport& report) {
  std::string text = fmt::format(
      "{}, {:.3f} s: at most {:.3f} N and {:.0f} mm/s; the longest gap between ticks {:.2f} ms; {} lost; the energy limit shortened {}\n",
      counted(record.ticks.size(), "tick"), report.seconds, report.max_newton, report.max_speed_mm_s,
      static_cast<double>(report.worst_gap_ns) * 1e-6,
      report.lost_replies == 1 ? "1 reply" : fmt::format("{} replies", report.lost_replies), counted(report.limited_ticks, "force"));
  for (const ReplayReport::Change& change : report.changes) {
    const double s = (static_cast<double>(record.ticks[change.tick].now_ns) - static_cast<double>(record.ticks.front().now_ns)) * 1e-9;
    text += fmt::format("  {:9.3f} s  tick {:<7} {}", s, change.tick, drivers::haptics::phase_name(change.phase));
    if (change.fault != drivers::haptics::SafetyFault::none) text += fmt::format(": {}", drivers::haptics::fault_words(change.fault));
    text += '\n';
  }
  text += fmt::format("this version's safety: {} and {} compared, ", counted(report.decisions_compared, "decision"),
                      counted(report.forces_compared, "force"));
  if (!report.first_difference) return text + "all the same\n";
  return text + fmt::format("{} different, first in tick {}\n", report.differing, *report.first_difference);
}

std::string replay_json(const drivers::haptics::PenRecord& record, const ReplayReport& report) {
  nlohmann::ordered_json json;
  json["ticks"] = record.ticks.size();
  json["seconds"] = report.seconds;
  json["max_newton"] = report.max_newton;
  json["max_speed_mm_s"] = report.max_speed_mm_s;
  json["worst_gap_ms"] = static_cast<double>(report.worst_gap_ns) * 1e-6;
  json["lost_replies"] = report.lost_replies;
  json["changes"] = nlohmann::ordered_json::array();
  for (const ReplayReport::Change& change : report.changes)
    json["changes"].push_back({{"tick", change.tick},
                               {"phase", drivers::haptics::phase_name(change.phase)},
                               {"fault", drivers::haptics::fault_name(change.fault)}});
  json["decisions_compared"] = report.decisions_compared;
  json["forces_compared"] = report.forces_compared;
  json["differing"] = report.differing;
  json["first_difference"] = report.first_difference ? nlohmann::ordered_json(*report.first_difference) : nlohmann::ordered_json();
  return json.dump() + "\n";
}

}  // namespace

Result<std::string> record_pen(const DevicesOptions& options, const Context& context) {
  const std::filesystem::path& file = *options.record;
  Result<ipc::PenClient> client = ipc::PenClient::connect(ipc::pen_socket_path(options.runtime_directory), "prismesh devices");
  if (!client) return fail(std::move(client.error()));
  const auto limits = client->page().limits();
  if (!limits) return fail("", "there is nothing to record: no pen has answered yet");
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << drivers::haptics::pen_record_header(*limits);
  RingCopy ring(client->page().ticks());
  ring.write(out);
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  bool ended = false;
  while (out && !ended && !context.stop() && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(kReadPeriod);
    ended = !client->poll();  // its page stays, with its last ticks
    ring.write(out);
  }
  out.close();
  if (!out) return fail(file.string(), "it can't be written");
  return ring.text(file) + (ended ? "the pen's process has ended\n" : "");
}

Result<ReplayedPen> replay_pen(const std::filesystem::path& file, bool as_json) {
  const Result<FileBytes> bytes = read_file(file);
  if (!bytes) return fail(bytes.error());
  const Result<drivers::haptics::PenRecord> record = drivers::haptics::parse_pen_record(bytes->text(), file.string());
  if (!record) return fail(record.error());
  const ReplayReport report = drivers::haptics::replay(*record);
  return ReplayedPen{as_json ? replay_json(*record, report) : replay_text(*record, report), report.differing == 0};
}

}  // namespace prismesh::cli
