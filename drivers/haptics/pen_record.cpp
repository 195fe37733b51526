#include "drivers/haptics/pen_record.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <system_error>

namespace prismesh::drivers::haptics {
namespace {

constexpr std::string_view kForm = "prismesh-pen-record 1";
constexpr std::string_view kLimitsName = "limits";

/// Calls `column(name, number)` for each column of a tick, in order. The one place that knows them.
template <class Tick, class Column>
void each_column(Tick& tick, Column&& column) {
  constexpr std::array<std::string_view, kForceKinds> kKinds{"contact", "friction", "damping", "pull", "resistance"};
  const auto vector = [&](std::string_view name, auto& numbers) {
    for (std::size_t axis = 0; axis < 3; ++axis) column(std::string(name) + "_" + "xyz"[axis], numbers[axis]);
  };
  column("now_ns", tick.now_ns);
  vector("position_mm", tick.position_mm);
  column("measured_ns", tick.measured_ns);
  for (std::size_t kind = 0; kind < kForceKinds; ++kind) {
    vector(kKinds[kind], tick.parts[kind].newton);
    column(std::string(kKinds[kind]) + "_from_ns", tick.parts[kind].from_ns);
  }
  column("lost_replies", tick.lost_replies);
  column("buttons", tick.buttons);
  column("element", tick.element);
  column("ready", tick.ready);
  column("io_error", tick.io_error);
  column("rearm", tick.rearm);
  column("begins", tick.begins);
  column("stored_phase", tick.stored_phase);
  column("stored_fault", tick.stored_fault);
  column("phase", tick.phase);
  column("fault", tick.fault);
  column("damping_only", tick.damping_only);
  column("tank_limited", tick.tank_limited);
  column("rearm_refused", tick.rearm_refused);
  vector("newton", tick.newton);
}

template <class Number>
void append(std::string& line, Number number) {
  std::array<char, 40> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  if (!line.empty()) line += ' ';
  line.append(text.data(), end);
}

/// Takes the next word of a line; empty at its end.
std::string_view take_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t end = std::min(line.find(' ', begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

template <class Number>
bool take_number(std::string_view& line, Number& number) {
  const std::string_view word = take_word(line);
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  return problem == std::errc() && end == word.data() + word.size() && !word.empty();
}

class Lines {
 public:
  explicit Lines(std::string_view text) : left_(text) {}
  /// False: no further line that is complete.
  bool next(std::string_view& line) {
    const std::size_t end = left_.find('\n');
    if (end == std::string_view::npos) return false;
    line = left_.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    left_.remove_prefix(end + 1);
    ++number_;
    return true;
  }
  long number() const { return number_; }

 private:
  std::string_view left_;
  long number_ = 0;
};

bool parse_limits(std::string_view line, PenRecordLimits& limits) {
  if (take_word(line) != kLimitsName || !take_number(line, limits.max_newton)) return false;
  for (double& axis : limits.max_axis_newton)
    if (!take_number(line, axis)) return false;
  return take_word(line).empty();
}

}  // namespace

std::string pen_record_header(const PenRecordLimits& limits) {
  std::string numbers(kLimitsName);
  append(numbers, limits.max_newton);
  for (const double axis : limits.max_axis_newton) append(numbers, axis);
  std::string names = "#";
  PenTick tick{};
  each_column(tick, [&names](const std::string& name, auto) { names += " " + name; });
  return std::string(kForm) + "\n" + numbers + "\n" + names + "\n";
}

std::string pen_record_line(const PenTick& tick) {
  std::string line;
  each_column(tick, [&line](const std::string&, auto number) { append(line, number); });
  return line + "\n";
}

Result<PenRecord> parse_pen_record(std::string_view text, const std::string& file) {
  Lines lines(text);
  std::string_view line;
  if (!lines.next(line) || line != kForm)
    return fail(file, 1, "this is no record of a pen: it doesn't begin with \"" + std::string(kForm) + "\"");
  PenRecord record;
  if (!lines.next(line) || !parse_limits(line, record.limits))
    return fail(file, 2, "the second line must give the limits: \"limits\", the largest force, and that of each motor, in newtons");
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;
    PenTick tick{};
    std::string wrong;
    each_column(tick, [&](const std::string& name, auto& number) {
      if (wrong.empty() && !take_number(line, number)) wrong = name;
    });
    if (!wrong.empty()) return fail(file, lines.number(), "the column " + wrong + " is missing or isn't a number that fits");
    if (!take_word(line).empty()) return fail(file, lines.number(), "the line has more columns than a tick");
    record.ticks.push_back(tick);
  }
  return record;
}

}  // namespace prismesh::drivers::haptics
