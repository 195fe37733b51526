#include "kiosk/display/x11/x11_monitor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>

#include <X11/Xatom.h>
#include <X11/extensions/Xrandr.h>

namespace prismesh::kiosk::display::x11 {
namespace {

struct ScreenResources {
  explicit ScreenResources(XRRScreenResources* made) : data(made, XRRFreeScreenResources) {}
  std::unique_ptr<XRRScreenResources, void (*)(XRRScreenResources*)> data;

  const XRRModeInfo* mode(RRMode id) const {
    const std::span modes(data->modes, static_cast<std::size_t>(data->nmode));
    const auto found = std::find_if(modes.begin(), modes.end(), [&](const XRRModeInfo& mode) { return mode.id == id; });
    return found == modes.end() ? nullptr : &*found;
  }
};

using CrtcInfo = std::unique_ptr<XRRCrtcInfo, void (*)(XRRCrtcInfo*)>;
using OutputInfo = std::unique_ptr<XRROutputInfo, void (*)(XRROutputInfo*)>;

PixelSize size_of(const XRRModeInfo& mode) { return {static_cast<int>(mode.width), static_cast<int>(mode.height)}; }

double refresh_of(const XRRModeInfo& mode) {
  const double pixels = static_cast<double>(mode.hTotal) * mode.vTotal;
  return pixels > 0 ? static_cast<double>(mode.dotClock) / pixels : 0;
}

/// A property's bytes; if its value is an atom, the bytes of the atom's name.
std::vector<std::byte> property(Display* display, RROutput output, Atom name) {
  Atom type = 0;
  int format = 0;
  unsigned long count = 0, rest = 0;
  unsigned char* data = nullptr;
  constexpr long kMaxLength = 4096;
  if (XRRGetOutputProperty(display, output, name, 0, kMaxLength, False, False, AnyPropertyType, &type, &format, &count, &rest, &data) !=
          Success ||
      data == nullptr)
    return {};
  std::vector<std::byte> bytes;
  if (format == 8) {
    bytes.resize(count);
    std::memcpy(bytes.data(), data, count);
  } else if (format == 32 && type == XA_ATOM && count == 1) {
    Atom value = 0;
    std::memcpy(&value, data, sizeof value);
    if (char* text = value != 0 ? XGetAtomName(display, value) : nullptr; text != nullptr) {
      const std::span letters(text, std::strlen(text));
      std::transform(letters.begin(), letters.end(), std::back_inserter(bytes), [](char c) { return static_cast<std::byte>(c); });
      XFree(text);
    }
  }
  XFree(data);
  return bytes;
}

/// The colour format, from the names that graphics drivers give this property; not every driver has one.
LinkColour colour_of(Display* display, RROutput output) {
  for (const char* name : {"color format", "Color Format", "output_csc", "ColorSpace", "Output Color Format"}) {
    const Atom atom = XInternAtom(display, name, True);
    if (atom == 0) continue;
    const std::vector<std::byte> bytes = property(display, output, atom);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (const LinkColour colour = link_colour_from(text); colour != LinkColour::unknown) return colour;
  }
  return LinkColour::unknown;
}

bool is_identity(const XTransform& transform) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      if (transform.matrix[row][column] != (row == column ? XDoubleToFixed(1) : 0)) return false;
  return true;
}

bool is_transformed(Display* display, RRCrtc crtc) {
  XRRCrtcTransformAttributes* attributes = nullptr;
  if (XRRGetCrtcTransform(display, crtc, &attributes) == 0 || attributes == nullptr) return false;
  const bool transformed = !is_identity(attributes->currentTransform);
  XFree(attributes);
  return transformed;
}

Monitor describe(Display* display, const ScreenResources& resources, RRCrtc crtc, const XRRCrtcInfo& shown) {
  Monitor monitor;
  monitor.x = shown.x;
  monitor.y = shown.y;
  monitor.shown = {static_cast<int>(shown.width), static_cast<int>(shown.height)};
  monitor.turned = shown.rotation != RR_Rotate_0;
  monitor.transformed = is_transformed(display, crtc);
  if (const XRRModeInfo* mode = resources.mode(shown.mode); mode != nullptr) {
    monitor.mode = size_of(*mode);
    monitor.refresh_hz = refresh_of(*mode);
  }
  if (shown.noutput < 1) return monitor;
  const RROutput output = shown.outputs[0];
  const OutputInfo info(XRRGetOutputInfo(display, resources.data.get(), output), XRRFreeOutputInfo);
  if (info) {
    monitor.connector.assign(info->name, static_cast<std::size_t>(info->nameLen));
    if (info->npreferred > 0)
      if (const XRRModeInfo* preferred = resources.mode(info->modes[0]); preferred != nullptr) monitor.native = size_of(*preferred);
  }
  if (const Atom edid = XInternAtom(display, "EDID", True); edid != 0)
    if (Result<drivers::display::Edid> read = drivers::display::decode_edid(property(display, output, edid))) {
      if (read->native_width > 0) monitor.native = {read->native_width, read->native_height};
      monitor.edid = std::move(*read);
    }
  monitor.colour = colour_of(display, output);
  return monitor;
}

long overlap(const XRRCrtcInfo& crtc, int x, int y, PixelSize size) {
  const long width = std::min<long>(crtc.x + static_cast<long>(crtc.width), x + size.width) - std::max(crtc.x, x);
  const long height = std::min<long>(crtc.y + static_cast<long>(crtc.height), y + size.height) - std::max(crtc.y, y);
  return std::max(0L, width) * std::max(0L, height);
}

}  // namespace

std::optional<Monitor> monitor_at(Display* display, ::Window root, int x, int y, PixelSize size) {
  int first_event = 0, first_error = 0, major = 0, minor = 0;
  if (XRRQueryExtension(display, &first_event, &first_error) == 0 || XRRQueryVersion(display, &major, &minor) == 0) return std::nullopt;
  if (major < 1 || (major == 1 && minor < 3)) return std::nullopt;
  const ScreenResources resources(XRRGetScreenResourcesCurrent(display, root));
  if (!resources.data) return std::nullopt;
  long max_overlap = 0;
  std::optional<Monitor> best;
  for (const RRCrtc crtc : std::span(resources.data->crtcs, static_cast<std::size_t>(resources.data->ncrtc))) {
    const CrtcInfo info(XRRGetCrtcInfo(display, resources.data.get(), crtc), XRRFreeCrtcInfo);
    if (!info || info->mode == 0) continue;
    if (const long shared = overlap(*info, x, y, size); shared > max_overlap) {
      max_overlap = shared;
      best = describe(display, resources, crtc, *info);
    }
  }
  return best;
}

}  // namespace prismesh::kiosk::display::x11
