#include "kiosk/tools/quality/set_limit.h"

#include <optional>

#include <fmt/format.h>

#include "kiosk/input/typed_numbers.h"

namespace prismesh::kiosk::tools::quality {
namespace {

std::optional<double>& number_of(MendLimits& limits, MendLimit which) {
  switch (which) {
    case MendLimit::line: return limits.max_move.line;
    case MendLimit::threshold: return limits.threshold;
    case MendLimit::sheet: break;
  }
  return limits.max_move.free;
}

}  // namespace

Result<MendLimits> with_limit(const MendLimits& now, MendLimit which, std::string_view text) {
  MendLimits wanted = now;
  std::optional<double>& number = number_of(wanted, which);
  number.reset();
  if (input::is_blank(text)) return wanted;
  const Result<std::vector<double>> numbers = input::parse_numbers(text);
  if (!numbers) return fail(numbers.error());
  const bool zero_too = which == MendLimit::line;
  const double typed = numbers->front();
  if (numbers->size() != 1 || !(zero_too ? typed >= 0 : typed > 0))
    return fail("", zero_too ? "type one number, 0 or greater, or nothing" : "type one number greater than 0, or nothing");
  number = typed;
  return wanted;
}

std::string typed_limit(const MendLimits& now, MendLimit which) {
  MendLimits limits = now;
  const std::optional<double>& number = number_of(limits, which);
  return number ? fmt::format("{}", *number) : std::string();
}

std::string title_of(MendLimit which) {
  switch (which) {
    case MendLimit::line: return "Nodes on feature lines move by at most";
    case MendLimit::threshold: return "Relaxing from a node: neighbours join beyond";
    case MendLimit::sheet: break;
  }
  return "Nodes within sheets move by at most";
}

std::string hint_of(MendLimit which) {
  switch (which) {
    case MendLimit::line: return "a length, 0: they stay, nothing: no limit";
    case MendLimit::threshold: return "a length, nothing: the default";
    case MendLimit::sheet: break;
  }
  return "a length, nothing: no limit";
}

}  // namespace prismesh::kiosk::tools::quality
