#include "kiosk/display/link_check.h"

#include <fmt/format.h>

namespace prismesh::kiosk::display {
namespace {

using drivers::display::Weave;

/// Whether the weave puts the two eyes on neighbouring pixels.
bool needs_each_pixel(const drivers::display::Profile& profile) { return profile.has_mask() || profile.weave == Weave::rows; }

std::string text_of(PixelSize size) { return fmt::format("{} x {}", size.width, size.height); }

void check_pixels(const Monitor& monitor, const std::string& who, LinkReport& report) {
  const bool mode_known = monitor.mode.width > 0, native_known = monitor.native.width > 0;
  if (mode_known && native_known && monitor.mode != monitor.native)
    report.refusals.push_back(
        fmt::format("{} is sent {} pixels and has {}: set its own resolution", who, text_of(monitor.mode), text_of(monitor.native)));
  if (monitor.transformed || (mode_known && monitor.shown.width > 0 && !monitor.turned && monitor.shown != monitor.mode))
    report.refusals.push_back(fmt::format("the desktop on {} is scaled from {} to {} pixels: set its scale to 100 %", who,
                                          text_of(monitor.shown), text_of(monitor.mode)));
  if (monitor.turned) report.refusals.push_back(fmt::format("the picture on {} is turned or mirrored: set it upright", who));
  if (!native_known) report.doubts.push_back(fmt::format("{} doesn't say how many pixels it has", who));
}

void check_panel(const drivers::display::Profile& profile, const Monitor& monitor, const std::string& who, LinkReport& report) {
  const auto [columns, rows] = profile.monitor.pixels;
  if (columns > 0 && monitor.native.width > 0 && PixelSize{columns, rows} != monitor.native)
    report.refusals.push_back(fmt::format("the profile \"{}\" was calibrated for a panel of {} x {} pixels, {} has {}: calibrate it here",
                                          profile.name, columns, rows, who, text_of(monitor.native)));
  if (!monitor.edid) return;
  const drivers::display::MonitorIdentity& is = monitor.edid->identity;
  const bool other_name = !profile.monitor.name.empty() && profile.monitor.name != is.maker + " " + is.model;
  const bool other_serial = !profile.monitor.serial.empty() && profile.monitor.serial != is.serial;
  if (other_name || other_serial)
    report.refusals.push_back(fmt::format("the profile \"{}\" was calibrated on {} {}, this is {}: calibrate it here", profile.name,
                                          profile.monitor.name, profile.monitor.serial, is.text()));
}

void check_colour(const Monitor& monitor, const std::string& who, LinkReport& report) {
  if (monitor.colour == LinkColour::halved)
    report.refusals.push_back(
        fmt::format("colours reach {} at half width (YCbCr 4:2:2 or 4:2:0): set RGB or 4:4:4, or a lower refresh rate", who));
  const bool may_be_halved = !monitor.edid || !monitor.edid->digital || monitor.edid->takes_ycbcr_422;
  if (monitor.colour == LinkColour::unknown && may_be_halved)
    report.doubts.push_back(
        fmt::format("the computer can't find out how colours reach {}: only the striped fields of the calibration tell", who));
}

}  // namespace

LinkReport check_link(const drivers::display::Profile& profile, const std::optional<Monitor>& monitor) {
  LinkReport report;
  if (!needs_each_pixel(profile)) return report;
  if (!monitor) {
    report.doubts.emplace_back("which monitor shows the picture isn't known");
    return report;
  }
  const std::string who = monitor->connector.empty() ? "the monitor" : monitor->connector;
  check_pixels(*monitor, who, report);
  check_panel(profile, *monitor, who, report);
  check_colour(*monitor, who, report);
  return report;
}

}  // namespace prismesh::kiosk::display
