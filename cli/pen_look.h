// Asks the process that drives the haptic pen. Inner to cli.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/device_figures.h"

namespace prismesh::cli {

/// The pen's state; nothing if nobody drives one. Errors: of a process that is there.
Result<std::optional<PenFigures>> look_at_pen(const DevicesOptions& options);
/// Arms or disarms as the options say. Errors: nobody drives a pen, a refusal with its reason.
Result<void> act_on_pen(const DevicesOptions& options);
/// "haptic pen: .." and lines with its figures.
std::string pen_text(const PenFigures& pen, std::int64_t now_ns);
/// Watches the pen for three seconds and says what was measured. Errors: nobody drives a pen.
Result<std::string> pen_self_test(const DevicesOptions& options);

}  // namespace prismesh::cli
