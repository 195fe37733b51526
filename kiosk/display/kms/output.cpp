#include "kiosk/display/kms/output.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

namespace prismesh::kiosk::display::kms {
namespace {

constexpr double kSameRateHz = 0.6;  ///< a setting says 60 for the 59.94 Hz of television

bool contains(const std::vector<ObjectId>& ids, ObjectId id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); }

std::string names_of(const CardState& card) {
  std::string names;
  for (const Connector& connector : card.connectors)
    names += fmt::format("{}{}{}", names.empty() ? "" : ", ", connector.name, connector.connected ? "" : " (nothing connected)");
  return names.empty() ? "none" : names;
}

std::string modes_of(const Connector& connector) {
  std::string names;
  for (const Mode& mode : connector.modes)
    if (!mode.interlaced) names += (names.empty() ? "" : ", ") + mode.text();
  return names.empty() ? "none" : names;
}

Result<const Connector*> choose_connector(const CardState& card, const std::string& wanted, std::vector<std::string>& notes) {
  if (!wanted.empty()) {
    const auto named =
        std::find_if(card.connectors.begin(), card.connectors.end(), [&](const Connector& one) { return one.name == wanted; });
    if (named == card.connectors.end())
      return fail("[display] connector", fmt::format("the graphics card has no \"{}\"; it has {}", wanted, names_of(card)));
    if (!named->connected) return fail(wanted, "no monitor is connected there, or it is off");
    return &*named;
  }
  const Connector* first = nullptr;
  std::size_t connected = 0;
  for (const Connector& connector : card.connectors) {
    const auto foreign = connector.properties.find("non-desktop");  // a headset
    if (!connector.connected || (foreign != connector.properties.end() && foreign->second.value != 0)) continue;
    ++connected;
    if (first == nullptr) first = &connector;
  }
  if (first == nullptr) return fail("", fmt::format("no monitor is connected to the graphics card, or all are off ({})", names_of(card)));
  if (connected > 1)
    notes.push_back(fmt::format("{} monitors are connected, and {} is used: [display] connector names another", connected, first->name));
  return first;
}

/// Of the modes that have this size, the one with the wanted rate; without a rate the preferred one, else the fastest.
const Mode* mode_of_size(const Connector& connector, PixelSize size, double refresh_hz) {
  const Mode* best = nullptr;
  for (const Mode& mode : connector.modes) {
    if (mode.interlaced || mode.size != size) continue;
    if (refresh_hz > 0 && std::abs(mode.refresh_hz - refresh_hz) > kSameRateHz) continue;
    const auto rank = [&](const Mode& one) {
      return std::tuple(refresh_hz > 0 ? -std::abs(one.refresh_hz - refresh_hz) : 0.0, one.preferred, one.refresh_hz);
    };
    if (best == nullptr || rank(mode) > rank(*best)) best = &mode;
  }
  return best;
}

const Mode* usual_mode(const Connector& connector) {
  const Mode* best = nullptr;
  const auto rank = [](const Mode& one) {
    return std::tuple(one.preferred, static_cast<long>(one.size.width) * one.size.height, one.refresh_hz);
  };
  for (const Mode& mode : connector.modes)
    if (!mode.interlaced && (best == nullptr || rank(mode) > rank(*best))) best = &mode;
  return best;
}

Result<Mode> choose_mode(const WantedOutput& wanted, Output& output) {
  const Connector& connector = output.connector;
  const Mode* mode = nullptr;
  if (wanted.size.width > 0) {
    mode = mode_of_size(connector, wanted.size, wanted.refresh_hz);
    if (mode == nullptr) {
      const std::string rate = wanted.refresh_hz > 0 ? fmt::format("@{:g}", wanted.refresh_hz) : "";
      return fail("[display] mode", fmt::format("{} offers no {}x{}{}; it offers {}", connector.name, wanted.size.width, wanted.size.height,
                                                rate, modes_of(connector)));
    }
  } else {
    if (output.native.width > 0) mode = mode_of_size(connector, output.native, 0);
    if (mode == nullptr) mode = usual_mode(connector);
    if (mode != nullptr && output.native.width > 0 && mode->size != output.native)
      output.notes.push_back(fmt::format("{} says that its panel has {}x{} pixels, and the graphics card offers no such mode: {} is used",
                                         connector.name, output.native.width, output.native.height, mode->text()));
  }
  if (mode == nullptr) return fail(connector.name, "the monitor offers no mode: check its cable and its source setting");
  if (mode->size.width < kMinPicture.width || mode->size.height < kMinPicture.height)
    return fail(connector.name, fmt::format("the monitor's mode is {}, and the picture needs at least {}x{} pixels: [display] mode names "
                                            "another of {}",
                                            mode->text(), kMinPicture.width, kMinPicture.height, modes_of(connector)));
  return *mode;
}

Result<void> choose_way(const CardState& card, Output& output) {
  for (const ObjectId crtc : output.connector.crtcs)
    for (const Plane& plane : card.planes)
      if (plane.primary && plane.takes_xrgb8888 && contains(plane.crtcs, crtc)) {
        output.crtc = crtc;
        output.plane = plane.id;
        return {};
      }
  return fail(output.connector.name, "the graphics card has no way to show 24-bit pictures there");
}

}  // namespace

Result<Output> choose_output(const CardState& card, const WantedOutput& wanted) {
  Output output;
  const Result<const Connector*> connector = choose_connector(card, wanted.connector, output.notes);
  if (!connector) return fail(connector.error());
  output.connector = **connector;
  if (output.connector.edid.empty()) {
    output.notes.push_back(
        fmt::format("{} doesn't describe itself (it has no EDID): its size and number of pixels aren't known", output.connector.name));
  } else if (Result<drivers::display::Edid> edid = drivers::display::decode_edid(output.connector.edid)) {
    output.native = {edid->native_width, edid->native_height};
    output.edid = std::move(*edid);
  } else {
    output.notes.push_back(
        fmt::format("{}: its description of itself (EDID) can't be read: {}", output.connector.name, edid.error().message));
  }
  Result<Mode> mode = choose_mode(wanted, output);
  if (!mode) return fail(mode.error());
  output.mode = std::move(*mode);
  if (Result<void> way = choose_way(card, output); !way) return fail(way.error());
  return output;
}

}  // namespace prismesh::kiosk::display::kms
