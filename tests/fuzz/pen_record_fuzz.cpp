// Records of a pen from anywhere: what is read is written and read again as the same text, and the safety can be run on it.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/haptics/replay.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::drivers::haptics;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto record = parse_pen_record(text, "fuzz");
  if (!record) {
    require(record.error().line > 0);
    return 0;
  }
  const auto text_of = [](const PenRecord& each) {
    std::string written = pen_record_header(each.limits);
    for (const PenTick& tick : each.ticks) written += pen_record_line(tick);
    return written;
  };
  const std::string written = text_of(*record);
  const auto again = parse_pen_record(written, "again");
  require(again && text_of(*again) == written);
  const ReplayReport report = replay(*record);
  require(report.forces_compared <= report.decisions_compared && report.decisions_compared <= record->ticks.size());
  return 0;
}
