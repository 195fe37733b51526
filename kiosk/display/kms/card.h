// Interface to the kernel's mode setting (DRM/KMS, atomic) of one graphics card. There is one implementation for real cards (drm_card.h);
// tests have one in virtual time. Source: the kernel's "DRM Driver uAPI" and "KMS Properties".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk::display::kms {

/// Of a connector, CRTC, plane, framebuffer, property or blob; 0: none.
using ObjectId = std::uint32_t;

struct Mode {
  std::string name;
  PixelSize size;
  double refresh_hz = 0;
  bool preferred = false;
  bool interlaced = false;
  std::array<std::byte, 68> timings{};  ///< the kernel's drm_mode_modeinfo
  /// "1920x1080 at 60.00 Hz".
  std::string text() const;
};

struct Property {
  ObjectId id = 0;
  std::uint64_t value = 0;
  bool fixed = false;  ///< can't be set
  /// Names of an enumeration's values, or of a bit mask's bits.
  std::vector<std::pair<std::string, std::uint64_t>> names;
  std::uint64_t low = 0, high = 0;  ///< of a range; equal: not a range

  std::optional<std::uint64_t> value_named(const std::string& name) const;
  /// The value's name, or else its digits.
  std::string value_text() const;
};
using Properties = std::map<std::string, Property, std::less<>>;

struct Connector {
  ObjectId id = 0;
  std::string name;  ///< "DP-1"
  bool connected = false;
  std::vector<Mode> modes;
  std::vector<std::byte> edid;
  std::vector<ObjectId> crtcs;  ///< that can feed it
  Properties properties;
};

struct Crtc {
  ObjectId id = 0;
  Properties properties;
};

struct Plane {
  ObjectId id = 0;
  bool primary = false;
  bool takes_xrgb8888 = false;
  std::vector<ObjectId> crtcs;  ///< that it can be on
  Properties properties;
};

struct CardState {
  std::vector<Connector> connectors;
  std::vector<Crtc> crtcs;
  std::vector<Plane> planes;
};

struct Setting {
  ObjectId object = 0;
  ObjectId property = 0;
  std::uint64_t value = 0;
  bool operator==(const Setting&) const = default;
};

/// One atomic change: all settings or none.
struct Change {
  std::vector<Setting> settings;
  bool may_set_mode = false;
  bool only_test = false;
  /// The flip that ends this change carries it. Without it the change is done when `commit` returns.
  std::optional<std::uint64_t> flip_token;
};

/// A picture has begun to be shown.
struct Flip {
  std::uint64_t token = 0;
  std::uint32_t refresh = 0;  ///< number of the refresh; drivers without a vertical blank count 0
  std::int64_t time_ns = 0;   ///< CLOCK_MONOTONIC
};

class Card {
 public:
  virtual ~Card() = default;
  virtual const std::string& name() const = 0;
  /// Reads connectors, modes and properties as they are now. `probe`: asks the monitors again, which may take a second. Errors: the card is
  /// gone.
  virtual Result<CardState> read(bool probe) = 0;
  /// Applies a change, or begins it if it has a flip token. Returns 0 or an errno: EBUSY (the last flip hasn't ended), EINVAL (refused),
  /// EACCES or EPERM (another program shows its pictures), ENODEV (the card is gone).
  virtual int commit(const Change& change) = 0;
  /// A blob's id; 0: the kernel refuses it.
  virtual ObjectId make_blob(std::span<const std::byte> bytes) = 0;
  virtual void drop_blob(ObjectId blob) = 0;
  /// The flips since the last call, oldest first.
  virtual std::vector<Flip> take_flips() = 0;
  /// For poll(2): readable if there are flips.
  virtual int descriptor() const = 0;
};

}  // namespace prismesh::kiosk::display::kms
