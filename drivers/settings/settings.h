// prismesh.toml: what a station is made of. Read from /etc/prismesh/prismesh.toml, then the user's ($XDG_CONFIG_HOME or
// ~/.config)/prismesh/prismesh.toml, then --config FILE; a later file changes only the keys it has. docs/settings.md lists them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/error.h"

namespace prismesh::drivers::settings {

enum class TrackerDriver : std::uint8_t { none, dynasight, opentrack };
enum class TrackerDialect : std::uint8_t { dynasight, d4d };  ///< which command asks for a stream: `V` or `0`
enum class ServoDriver : std::uint8_t { none, dynamixel };

struct EyeTrackerSettings {
  TrackerDriver driver = TrackerDriver::none;
  bool simulated = false;  ///< the device's side is played by deviced, over a pseudo-terminal or loopback UDP
  std::string port;        ///< /dev/serial/by-id/..; a pseudo-terminal works too
  int baud = 19200;
  TrackerDialect dialect = TrackerDialect::d4d;
  bool polled = false;
  std::uint16_t udp_port = 4242;  ///< opentrack
  double latency_ms = 20;         ///< from the head being there to the record's last byte
  double noise_mm = 1;
  Eigen::Vector3d offset_mm{0, 0, 0};  ///< the tracker's origin in screen coordinates
  double eye_separation_mm = 63;       ///< 50..75; the calibration's value in the profile goes before it
  std::string motion = "tour";         ///< simulated: still, sway, lean, turn, tour
  bool operator==(const EyeTrackerSettings&) const = default;
};

struct PrismServoSettings {
  ServoDriver driver = ServoDriver::none;
  bool simulated = false;
  std::string port;
  int baud = 1'000'000;
  int id = 1;
  double travel_mm_per_turn = 5.0;
  bool reversed = false;
  int zero_ticks = 2048;   ///< of the position register when the mask stands in its middle
  double travel_mm = 2.0;  ///< to either side of the middle
  double speed_mm_s = 5.0;
  double lag_ms = 15;
  bool operator==(const PrismServoSettings&) const = default;
};

struct DisplaySettings {
  std::string profile = "prism-mask";  ///< a built-in name, or a profile file (relative to the settings file)
  double latency_ms = 10;              ///< from a row's scan-out to its light: what the panel's electronics and pixels take
};

/// What the kiosk's hand works with.
struct HandSettings {
  std::string mouse = "default";  ///< a built-in layout's name, or a file (relative to the settings file)
};

/// What the model server keeps.
struct DocumentSettings {
  std::int64_t history_mb = 2048;  ///< of states kept for undo and redo
  std::int64_t hang_s = 60;        ///< without a sign of life for so long the server ends itself, to be started anew; 0: never
};

struct Settings {
  DisplaySettings display;
  HandSettings hand;
  DocumentSettings document;
  EyeTrackerSettings eye_tracker;
  PrismServoSettings prism_servo;
  std::vector<std::filesystem::path> files;  ///< those that were read, in order
};

/// Errors: a named file that isn't there, text that isn't TOML, an unknown key or section (with the nearest known one), a value out of its
/// range, a real device without its port, one port for two devices: each with file and line.
Result<Settings> read_settings(const std::optional<std::filesystem::path>& named_file);

/// The files that every station looks for, in order: the system's and the user's. Without $XDG_CONFIG_HOME and $HOME the system's only.
std::vector<std::filesystem::path> usual_files();

/// As read_settings, with the usual files given: those that aren't there are passed over.
Result<Settings> read_settings(const std::vector<std::filesystem::path>& usual, const std::optional<std::filesystem::path>& named_file);

/// One file's text on its own, on top of the defaults; `file` stands in errors, and profile files are sought beside it.
Result<Settings> parse_settings(std::string_view text, const std::filesystem::path& file);
/// As parse_settings, of one file among several: a port that is missing in it may stand in another one.
Result<Settings> parse_part(std::string_view text, const std::filesystem::path& file);

}  // namespace prismesh::drivers::settings
