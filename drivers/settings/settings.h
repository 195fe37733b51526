// Reads prismesh.toml, the settings of a station: first /etc/prismesh/prismesh.toml, then the user's ($XDG_CONFIG_HOME or
// ~/.config)/prismesh/prismesh.toml, then --config FILE. A later file overrides only the keys that it contains. docs/settings.md lists the
// keys.
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
enum class TrackerDialect : std::uint8_t { dynasight, d4d };  ///< the command that starts streaming: `V` or `0`
enum class ServoDriver : std::uint8_t { none, dynamixel };
enum class PenDriver : std::uint8_t { none, simulated, falcon, inverse3 };

struct EyeTrackerSettings {
  TrackerDriver driver = TrackerDriver::none;
  bool simulated = false;  ///< deviced simulates the device over a pseudo-terminal or loopback UDP
  std::string port;        ///< for example /dev/serial/by-id/..; a pseudo-terminal works too
  int baud = 19200;
  TrackerDialect dialect = TrackerDialect::d4d;
  bool polled = false;
  std::uint16_t udp_port = 4242;  ///< for opentrack
  double latency_ms = 20;         ///< from the head's position to the last byte of its record
  double noise_mm = 1;
  Eigen::Vector3d offset_mm{0, 0, 0};  ///< the tracker's origin in screen coordinates
  double eye_separation_mm = 63;       ///< 50..75; the calibrated value in the profile overrides it
  std::string motion = "tour";         ///< of a simulated tracker: still, sway, lean, turn, tour
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
  int zero_ticks = 2048;   ///< position register when the mask is in its middle
  double travel_mm = 2.0;  ///< to either side of the middle
  double speed_mm_s = 5.0;
  double lag_ms = 15;
  bool operator==(const PrismServoSettings&) const = default;
};

/// The figures are starting values: nobody has felt them.
struct HapticPenSettings {
  PenDriver driver = PenDriver::none;
  std::string port;                 ///< a pseudo-terminal of a program that simulates a pen; empty: the daemon simulates it
  double max_newton = 8;            ///< at most what the device holds, which is also the default for it
  double stiffness_newton_m = 600;  ///< of contact; the loop lowers it to what the device allows
  double friction = 0.2;            ///< Coulomb's coefficient on shells
  double damping_newton_s_m = 0.3;
  std::string firmware;                 ///< of a Falcon: its file
  std::uint16_t service_port = 10001;   ///< of an Inverse3: where its service listens on this machine
  double force_scale = 1;               ///< true newtons of the device for one that was asked for, from weighing
  double own_damping_newton_s_m = 0.5;  ///< of the device itself; with its friction it bounds the stiffness
  double own_friction_newton = 0.1;
  /// What the simulated hand does: a file of a HandScript; empty: it wanders about.
  std::string hand_script;
  double workspace_scale = 1;  ///< millimetres of the pen's motion for one of the model's length unit
  bool left_handed = false;
  bool operator==(const HapticPenSettings&) const = default;
};

/// What the kiosk shows its picture on.
enum class ScreenKind : std::uint8_t {
  usual,  ///< an X11 session where there is one, else the bare screen
  x11,
  bare,  ///< kernel mode setting, without a display server
};

/// A monitor's mode; 0: its own.
struct ModeSetting {
  int width = 0;
  int height = 0;
  double refresh_hz = 0;
  bool operator==(const ModeSetting&) const = default;
};

struct DisplaySettings {
  std::string profile = "prism-mask";  ///< a built-in name, or a profile file (relative to the settings file)
  double latency_ms = 10;              ///< from a row's scan-out to its light, in the panel's electronics and pixels
  ScreenKind screen = ScreenKind::usual;
  std::string connector;             ///< of the bare screen, "DP-1"; empty: the first with a monitor
  ModeSetting mode;                  ///< of the bare screen
  std::int64_t video_memory_mb = 0;  ///< max. memory of the graphics card that the kiosk's picture of the model takes; 0: no limit
  bool console_switching = false;    ///< on the bare screen Ctrl+Alt+F1 and so on show a text console
};

/// How the user works with the kiosk.
struct HandSettings {
  std::string mouse = "default";  ///< a built-in mouse layout's name, or a file (relative to the settings file)
};

/// Limits of the model server.
struct DocumentSettings {
  std::int64_t history_mb = 2048;  ///< max. memory for the states kept for undo and redo
  std::int64_t hang_s = 60;        ///< the server ends itself, to be restarted, after so long without a heartbeat; 0: never
};

/// What prismesh-intake lets in from the network.
struct RemoteSettings {
  std::string address;             ///< where it listens
  std::uint16_t port = 0;          ///< 0: it serves nobody
  std::vector<std::string> hosts;  ///< names by which clients call the station, beside its addresses
  std::int64_t quota_gb = 50;      ///< models and uploads of one client
  std::int64_t file_gb = 8;        ///< one file
  std::int64_t reserved_gb = 2;    ///< stay free on the disk, for the journals
  std::int64_t upload_hours = 24;  ///< an upload that gets no bytes for so long is removed
};

/// A kiosk that visitors use (docs/exhibition.md).
struct ExhibitionSettings {
  std::string deck;             ///< what is shown, a path (relative to the settings file); empty: no exhibition
  std::string show;             ///< a file of steps, likewise; empty: the model stands there until somebody comes
  std::int64_t idle_s = 90;     ///< of a visit without input, until the warning
  std::int64_t warning_s = 15;  ///< until it ends
  std::string pin;              ///< a hash of crypt(3)
};

struct StationSettings {
  DisplaySettings display;
  HandSettings hand;
  DocumentSettings document;
  EyeTrackerSettings eye_tracker;
  PrismServoSettings prism_servo;
  HapticPenSettings haptic_pen;
  RemoteSettings remote;
  ExhibitionSettings exhibition;
  std::vector<std::filesystem::path> files;  ///< the files that were read, in order
};

/// Reads the usual files and `named_file`. Errors, with file and line: a missing named file, text that isn't TOML, an unknown key or
/// section (with the nearest known one), a value out of range, a real device without a port, one port for two devices.
Result<StationSettings> read_settings(const std::optional<std::filesystem::path>& named_file);

/// Returns the files that every station reads, in order: the system's and the user's. Without $XDG_CONFIG_HOME and $HOME only the system's.
std::vector<std::filesystem::path> usual_files();

/// As read_settings, with `usual` as the usual files; skips those that don't exist.
Result<StationSettings> read_settings(const std::vector<std::filesystem::path>& usual,
                                      const std::optional<std::filesystem::path>& named_file);

/// Parses one file's text on top of the defaults. `file` is named in errors, and profile files are relative to its folder.
Result<StationSettings> parse_settings(std::string_view text, const std::filesystem::path& file);
/// As parse_settings, for one of several files: a port that is missing here may be set in another file, so this isn't an error.
Result<StationSettings> parse_settings_part(std::string_view text, const std::filesystem::path& file);

}  // namespace prismesh::drivers::settings
