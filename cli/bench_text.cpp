#include "cli/bench_text.h"

#include <array>
#include <ostream>

#include <fmt/format.h>

#include "base/counted.h"
#include "cli/report_text.h"

namespace prismesh::cli {

namespace {

constexpr double kBytesPerMegabyte = 1e6;

std::string size_text(const BenchFigure& figure) {
  if (figure.unit == SizeUnit::bytes) return fmt::format("{:.3f} MB", static_cast<double>(figure.size) / kBytesPerMegabyte);
  return fmt::format("{} {}", figure.size, name(figure.unit));
}

/// "1.26 M" of 1,260,000: at least three digits.
std::string with_prefix(double value) {
  constexpr std::array<const char*, 4> kPrefixes{"", " k", " M", " G"};
  std::size_t prefix = 0;
  for (; value >= 1000 && prefix + 1 < kPrefixes.size(); ++prefix) value /= 1000;
  return fmt::format("{:.{}f}{}", value, value < 10 ? 2 : value < 100 ? 1 : 0, kPrefixes[prefix]);
}

std::string rate_text(const BenchFigure& figure) {
  const double rate = rate_per_s(figure);
  if (figure.unit == SizeUnit::bytes) return fmt::format("{:.1f} MB/s", rate / kBytesPerMegabyte);
  return fmt::format("{} {}/s", with_prefix(rate), name(figure.unit));
}

void print_heads(std::ostream& out, const BenchReport& report) {
  out << "prismesh " PRISMESH_VERSION ", " << counted(report.machine.threads, "thread");
  if (!report.machine.processor.empty()) out << " (" << printable(report.machine.processor) << ')';
  out << '\n' << (report.is_sample ? "generated sample" : printable(report.deck));
  out << fmt::format(": {}, {}, {}, {:.3f} MB\n", report.format, counted(report.shells, "shell"), counted(report.nodes, "node"),
                     static_cast<double>(report.bytes) / kBytesPerMegabyte);
  if (report.patch_nodes > 0)
    out << "patch for drag, lift, relax and repair: " << counted(report.patch_nodes, "node") << " around node:" << report.patch_centre
        << ", " << counted(report.patch_shells, "shell") << '\n';
}

void print_figure(std::ostream& out, const BenchFigure& figure) {
  out << fmt::format("{:<14}", figure.name);
  if (!figure.timing) {
    out << " not measured: " << printable(figure.note) << '\n';
    return;
  }
  const Timing& timing = *figure.timing;
  out << fmt::format(" {:>11.3f} {:>11.3f} {:>11.3f} {:>5} {:>15} {:>17}  {}", timing.median_ms, timing.min_ms, timing.cpu_ms, timing.runs,
                     size_text(figure), rate_text(figure), figure.what);
  if (!figure.note.empty()) out << " (" << printable(figure.note) << ')';
  out << '\n';
}

}  // namespace

void print_bench(std::ostream& out, const BenchReport& report) {
  print_heads(out, report);
  out << fmt::format("{:<14} {:>11} {:>11} {:>11} {:>5} {:>15} {:>17}  {}\n", "figure", "median ms", "min ms", "CPU ms", "runs", "size",
                     "rate", "what is measured");
  for (const BenchFigure& figure : report.figures) print_figure(out, figure);
}

}  // namespace prismesh::cli
