#include "drivers/settings/settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <span>
#include <utility>

#include <toml++/toml.h>

#include "base/file.h"
#include "base/nearest_name.h"
#include "drivers/haptic_pen/device_limits.h"

namespace prismesh::drivers::settings {

namespace {

namespace fs = std::filesystem;

/// What is wrong with a value, as the rest of a sentence that begins with the key's name; empty if the value is valid.
using Problem = std::string;

struct Key {
  std::string_view name;
  std::function<Problem(const toml::node&)> read;
};

struct Section {
  std::string_view name;
  std::vector<Key> keys;
};

template <class Named>
const Named* find(std::span<const Named> all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

struct SourceLine {
  std::string file;
  long line = 0;
};

/// Where values were last set that don't fit by themselves, for errors about missing or conflicting ports and forces.
struct DeviceLines {
  SourceLine tracker_driver, tracker_port, servo_driver, servo_port, pen_max_newton;
};

constexpr std::array<std::string_view, 4> kPenDrivers{"none", "simulated", "falcon", "inverse3"};

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.10g", value);
  return text.data();
}

Key flag(std::string_view name, bool& to) {
  return {name, [&to](const toml::node& node) -> Problem {
            const auto* value = node.as_boolean();
            if (value == nullptr) return "must be true or false";
            to = value->get();
            return {};
          }};
}

Problem outside(double value, double low, double high, std::string_view unit) {
  return "is " + number_text(value) + "; it must be from " + number_text(low) + " to " + number_text(high) + std::string(unit);
}

template <class Whole>
Key whole(std::string_view name, Whole& to, std::int64_t low, std::int64_t high, std::string_view unit = "") {
  return {name, [&to, low, high, unit](const toml::node& node) -> Problem {
            const auto* value = node.as_integer();
            if (value == nullptr) return "must be a whole number";
            if (value->get() < low || value->get() > high)
              return outside(static_cast<double>(value->get()), static_cast<double>(low), static_cast<double>(high), unit);
            to = static_cast<Whole>(value->get());
            return {};
          }};
}

/// Returns the number of an integer or floating-point node; nothing for other nodes and for numbers that aren't finite.
std::optional<double> number_of(const toml::node& node) {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

Key number(std::string_view name, double& to, double low, double high, std::string_view unit) {
  return {name, [&to, low, high, unit](const toml::node& node) -> Problem {
            const std::optional<double> value = number_of(node);
            if (!value) return "must be a number";
            if (*value < low || *value > high) return outside(*value, low, high, unit);
            to = *value;
            return {};
          }};
}

Key vector(std::string_view name, Eigen::Vector3d& to, double max_mm) {
  return {name, [&to, max_mm](const toml::node& node) -> Problem {
            const toml::array* values = node.as_array();
            if (values == nullptr || values->size() != 3) return "must be three numbers, like [0, 210, -15]";
            Eigen::Vector3d read;
            for (std::size_t i = 0; i < 3; ++i) {
              const std::optional<double> value = number_of(*values->get(i));
              if (!value) return "must be three numbers, like [0, 210, -15]";
              if (std::abs(*value) > max_mm) return "holds " + outside(*value, -max_mm, max_mm, " mm").substr(3);
              read[static_cast<Eigen::Index>(i)] = *value;
            }
            to = read;
            return {};
          }};
}

/// One of `names`; `to` receives the index.
Key choice(std::string_view name, std::vector<std::string_view> names, std::function<void(std::size_t)> to) {
  return {name, [names = std::move(names), to = std::move(to)](const toml::node& node) -> Problem {
            const auto* value = node.as_string();
            std::string all;
            for (const std::string_view one : names) all += (all.empty() ? "" : ", ") + std::string(one);
            if (value == nullptr) return "must be one of " + all;
            const auto found = std::find(names.begin(), names.end(), value->get());
            if (found == names.end())
              return "has no \"" + value->get() + "\"; the nearest is \"" + std::string(nearest_name(value->get(), names)) + "\" of " + all;
            to(static_cast<std::size_t>(found - names.begin()));
            return {};
          }};
}

/// The path of a device's file, or "" for none.
Key device_file(std::string_view name, std::string& to) {
  return {name, [&to](const toml::node& node) -> Problem {
            const auto* value = node.as_string();
            if (value == nullptr) return "must be a device's file in quotes, like \"/dev/serial/by-id/..\"";
            const std::string& path = value->get();
            if (!path.empty() && (path.front() != '/' || path.find('\0') != std::string::npos))
              return "must be a device's whole path, like \"/dev/serial/by-id/..\"";
            to = path;
            return {};
          }};
}

/// The name of a built-in item, or a file (a text with a slash, or one that ends in .toml). `what`: for the error, for example "a profile's
/// name or file in quotes, like ..".
Key name_or_file(std::string_view name, std::string& to, const fs::path& folder, std::string what) {
  return {name, [&to, &folder, what = std::move(what)](const toml::node& node) -> Problem {
            const auto* value = node.as_string();
            if (value == nullptr || value->get().empty() || value->get().find('\0') != std::string::npos) return "must be " + what;
            const std::string& text = value->get();
            const bool is_file = text.find('/') != std::string::npos || text.ends_with(".toml");
            to = is_file ? (folder / text).lexically_normal().string() : text;
            return {};
          }};
}

/// A file; a name that isn't absolute is looked for beside the settings. Empty: none.
Key file_beside(std::string_view name, std::string& to, const fs::path& folder) {
  return {name, [&to, &folder](const toml::node& node) -> Problem {
            const auto* value = node.as_string();
            if (value == nullptr || value->get().find('\0') != std::string::npos) return "must be a file's name in quotes";
            to = value->get().empty() ? std::string() : (folder / value->get()).lexically_normal().string();
            return {};
          }};
}

/// A mode like "1920x1080" or "1920x1080@60"; empty: the monitor's own.
Key mode(std::string_view name, ModeSetting& to) {
  return {name, [&to](const toml::node& node) -> Problem {
            const Problem wrong = "must be a mode in quotes, like \"1920x1080\" or \"1920x1080@60\"";
            const auto* value = node.as_string();
            if (value == nullptr) return wrong;
            ModeSetting read;
            const std::string& text = value->get();
            const char* const end = text.data() + text.size();
            if (!text.empty()) {
              const auto [x, width_error] = std::from_chars(text.data(), end, read.width);
              if (width_error != std::errc() || x == end || *x != 'x') return wrong;
              const auto [at, height_error] = std::from_chars(x + 1, end, read.height);
              if (height_error != std::errc() || read.width < 1 || read.height < 1) return wrong;
              if (at != end) {
                const auto [rest, rate_error] = std::from_chars(at + 1, end, read.refresh_hz);
                if (*at != '@' || rate_error != std::errc() || rest != end || !(read.refresh_hz >= 1 && read.refresh_hz <= 1000))
                  return wrong;
              }
            }
            to = read;
            return {};
          }};
}

/// An address and a port, like "0.0.0.0:7443" or "[::]:7443"; empty: none. Port 0: any free one.
Key address_and_port(std::string_view name, std::string& address, std::uint16_t& port) {
  return {name, [&address, &port](const toml::node& node) -> Problem {
            const Problem wrong = "must be an address and a port in quotes, like \"0.0.0.0:7443\" or \"[::]:7443\"";
            const auto* value = node.as_string();
            if (value == nullptr) return wrong;
            const std::string_view text = value->get();
            address.clear();
            port = 0;
            if (text.empty()) return {};
            const std::size_t colon = text.rfind(':');
            if (colon == std::string_view::npos) return wrong;
            std::string_view host = text.substr(0, colon);
            const bool in_brackets = host.starts_with('[') && host.ends_with(']') && host.size() > 2;
            if (in_brackets) host = host.substr(1, host.size() - 2);
            const bool plain = host.find_first_not_of(in_brackets ? "0123456789abcdefABCDEF:." : "0123456789.") == std::string_view::npos;
            std::uint16_t number = 0;
            const auto [end, error] = std::from_chars(text.data() + colon + 1, text.data() + text.size(), number);
            if (!plain || host.empty() || error != std::errc() || end != text.data() + text.size()) return wrong;
            address = host;
            port = number;
            return {};
          }};
}

/// Names of hosts, in small letters afterwards.
Key host_names(std::string_view name, std::vector<std::string>& to) {
  return {name, [&to](const toml::node& node) -> Problem {
            const Problem wrong = "must be a list of names in quotes, like [\"station.example.com\"]";
            const toml::array* list = node.as_array();
            if (list == nullptr) return wrong;
            std::vector<std::string> names;
            for (const toml::node& each : *list) {
              const auto* value = each.as_string();
              if (value == nullptr || value->get().empty()) return wrong;
              std::string& host = names.emplace_back(value->get());
              for (char& c : host) {
                if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
                if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '.')) return wrong;
              }
            }
            to = std::move(names);
            return {};
          }};
}

/// The name of a socket of the graphics card.
Key connector_name(std::string_view name, std::string& to) {
  return {name, [&to](const toml::node& node) -> Problem {
            const auto* value = node.as_string();
            if (value == nullptr || value->get().find('\0') != std::string::npos)
              return "must be a connector's name in quotes, like \"DP-1\" (prismesh doctor lists them)";
            to = value->get();
            return {};
          }};
}

Key remember(Key key, SourceLine& place, const std::string& file) {
  return {key.name, [read = std::move(key.read), &place, &file](const toml::node& node) {
            place = {file, static_cast<long>(node.source().begin.line)};
            return read(node);
          }};
}

Section tracker_section(EyeTrackerSettings& tracker, DeviceLines& places, const std::string& file) {
  return {"eye_tracker",
          {remember(choice("driver", {"none", "dynasight", "opentrack"}, [&](std::size_t i) { tracker.driver = TrackerDriver(i); }),
                    places.tracker_driver, file),
           flag("simulated", tracker.simulated), remember(device_file("port", tracker.port), places.tracker_port, file),
           whole("baud", tracker.baud, 300, 4'000'000),
           choice("dialect", {"dynasight", "d4d"}, [&](std::size_t i) { tracker.dialect = TrackerDialect(i); }),
           flag("polled", tracker.polled), whole("udp_port", tracker.udp_port, 1, 65535),
           number("latency_ms", tracker.latency_ms, 0, 500, " ms"), number("noise_mm", tracker.noise_mm, 0, 50, " mm"),
           vector("offset_mm", tracker.offset_mm, 2000), number("eye_separation_mm", tracker.eye_separation_mm, 50, 75, " mm"),
           choice("motion", {"still", "sway", "lean", "turn", "tour"}, [&tracker](std::size_t i) {
             constexpr std::array kMotions{"still", "sway", "lean", "turn", "tour"};
             tracker.motion = kMotions[i];
           })}};
}

Section servo_section(PrismServoSettings& servo, DeviceLines& places, const std::string& file) {
  return {
      "prism_servo",
      {remember(choice("driver", {"none", "dynamixel"}, [&](std::size_t i) { servo.driver = ServoDriver(i); }), places.servo_driver, file),
       flag("simulated", servo.simulated), remember(device_file("port", servo.port), places.servo_port, file),
       whole("baud", servo.baud, 9600, 4'500'000), whole("id", servo.id, 0, 252),
       number("travel_mm_per_turn", servo.travel_mm_per_turn, 0.1, 100, " mm"), flag("reversed", servo.reversed),
       whole("zero_ticks", servo.zero_ticks, -1'048'575, 1'048'575), number("travel_mm", servo.travel_mm, 0.01, 100, " mm"),
       number("speed_mm_s", servo.speed_mm_s, 0.01, 1000, " mm/s"), number("lag_ms", servo.lag_ms, 0, 200, " ms")}};
}

Section pen_section(HapticPenSettings& pen, DeviceLines& places, const std::string& file, const fs::path& folder) {
  return {
      "haptic_pen",
      {choice("driver", {kPenDrivers.begin(), kPenDrivers.end()}, [&pen](std::size_t i) { pen.driver = PenDriver(i); }),
       device_file("port", pen.port), whole("service_port", pen.service_port, 1, 65535),
       file_beside("hand_script", pen.hand_script, folder),
       remember(number("max_newton", pen.max_newton, 0.1, 8, " N"), places.pen_max_newton, file),
       number("stiffness_newton_m", pen.stiffness_newton_m, 0, 5000, " N/m"), number("friction", pen.friction, 0, 1, ""),
       number("damping_newton_s_m", pen.damping_newton_s_m, 0, 5, " N s/m"), file_beside("firmware", pen.firmware, folder),
       number("force_scale", pen.force_scale, 0.2, 5, ""), number("own_damping_newton_s_m", pen.own_damping_newton_s_m, 0, 10, " N s/m"),
       number("own_friction_newton", pen.own_friction_newton, 0, 2, " N"),
       number("workspace_scale", pen.workspace_scale, 0.0001, 10000, " mm per length unit"),
       choice("hand", {"right", "left"}, [&pen](std::size_t i) { pen.left_handed = i == 1; })}};
}

Section remote_section(RemoteSettings& remote) {
  return {"remote",
          {address_and_port("listen", remote.address, remote.port), host_names("hosts", remote.hosts),
           whole("quota_gb", remote.quota_gb, 1, 1'000'000, " GB"), whole("file_gb", remote.file_gb, 1, 1000, " GB"),
           whole("reserved_gb", remote.reserved_gb, 0, 1'000'000, " GB"), whole("upload_hours", remote.upload_hours, 1, 8760, " h")}};
}

/// A hash of crypt(3), or nothing.
Key crypt_hash(std::string_view name, std::string& to) {
  return {name, [&to](const toml::node& node) -> Problem {
            const auto* value = node.as_string();
            const bool good = value != nullptr && (value->get().empty() || (value->get().starts_with('$') && value->get().size() > 20)) &&
                              value->get().find_first_of(std::string("\0\n", 2)) == std::string::npos;
            if (!good) return "must be a hash in quotes as `openssl passwd -6` writes it, like \"$6$..\": not the PIN itself";
            to = value->get();
            return {};
          }};
}

Section exhibition_section(ExhibitionSettings& exhibition, const fs::path& folder) {
  return {"exhibition",
          {file_beside("deck", exhibition.deck, folder), file_beside("show", exhibition.show, folder),
           whole("idle_s", exhibition.idle_s, 5, 86'400, " s"), whole("warning_s", exhibition.warning_s, 1, 600, " s"),
           crypt_hash("pin", exhibition.pin)}};
}

class Reader {
 public:
  Reader(std::string file, StationSettings& settings, DeviceLines& places)
      : file_(std::move(file)), folder_(fs::path(file_).parent_path()), settings_(settings), places_(places) {}

  Result<void> read(const toml::table& root) const {
    const std::array<Section, 8> sections{
        Section{"display",
                {name_or_file("profile", settings_.display.profile, folder_, "a profile's name or file in quotes, like \"prism-mask\""),
                 number("latency_ms", settings_.display.latency_ms, 0, 200, " ms"),
                 choice("screen", {"usual", "x11", "bare"}, [this](std::size_t i) { settings_.display.screen = ScreenKind(i); }),
                 connector_name("connector", settings_.display.connector), mode("mode", settings_.display.mode),
                 whole("video_memory_mb", settings_.display.video_memory_mb, 0, 1'048'576, " MB"),
                 flag("console_switching", settings_.display.console_switching)}},
        Section{"hand", {name_or_file("mouse", settings_.hand.mouse, folder_, "a layout's name or file in quotes, like \"right-orbit\"")}},
        Section{"document",
                {whole("history_mb", settings_.document.history_mb, 16, 1'048'576, " MB"),
                 whole("hang_s", settings_.document.hang_s, 0, 86'400, " s")}},
        tracker_section(settings_.eye_tracker, places_, file_),
        servo_section(settings_.prism_servo, places_, file_),
        pen_section(settings_.haptic_pen, places_, file_, folder_),
        remote_section(settings_.remote),
        exhibition_section(settings_.exhibition, folder_)};
    std::vector<std::string_view> names;
    for (const Section& section : sections) names.push_back(section.name);
    for (const auto& [key, node] : root) {
      const Section* section = find(std::span<const Section>(sections), key.str());
      if (section == nullptr)
        return wrong(node, "settings have no section [" + std::string(key.str()) + "]; the nearest known is [" +
                               std::string(nearest_name(key.str(), names)) + "]");
      if (auto read = read_section(*section, node); !read) return read;
    }
    return {};
  }

 private:
  tl::unexpected<Error> wrong(const toml::node& at, std::string message) const {
    return fail(file_, static_cast<long>(at.source().begin.line), std::move(message));
  }

  Result<void> read_section(const Section& section, const toml::node& node) const {
    const std::string section_name(section.name);
    const toml::table* table = node.as_table();
    if (table == nullptr) return wrong(node, section_name + " must be a section, like [" + section_name + "]");
    std::vector<std::string_view> names;
    for (const Key& key : section.keys) names.push_back(key.name);
    for (const auto& [name, value] : *table) {
      const Key* key = find(std::span<const Key>(section.keys), name.str());
      if (key == nullptr)
        return wrong(value, "[" + section_name + "] has no \"" + std::string(name.str()) + "\"; the nearest known is \"" +
                                std::string(nearest_name(name.str(), names)) + "\"");
      if (const Problem problem = key->read(value); !problem.empty())
        return wrong(value, section_name + "." + std::string(key->name) + " " + problem);
    }
    return {};
  }

  std::string file_;
  fs::path folder_;
  StationSettings& settings_;
  DeviceLines& places_;
};

Result<void> apply(std::string_view text, const fs::path& file, StationSettings& settings, DeviceLines& places) {
  try {
    const toml::table table = toml::parse(text, file.string());
    if (auto read = Reader(file.string(), settings, places).read(table); !read) return read;
  } catch (const toml::parse_error& error) {
    return fail(file.string(), static_cast<long>(error.source().begin.line), std::string(error.description()));
  }
  settings.files.push_back(file);
  return {};
}

tl::unexpected<Error> missing_port(const SourceLine& driver, const std::string& device) {
  return fail(driver.file, driver.line,
              device + " has a driver but no port; say port = \"/dev/serial/by-id/..\" (ls that folder), or simulated = true");
}

/// Keeps the pen's force to what its device holds. A force that was written may not be longer; the default is shortened.
Result<void> fit_to_device(HapticPenSettings& pen, const SourceLine& written) {
  const haptic_pen::DeviceFigures* device = haptic_pen::figures_of(kPenDrivers[static_cast<std::size_t>(pen.driver)]);
  if (device == nullptr || pen.max_newton <= device->max_newton) return {};
  if (written.line != 0)
    return fail(written.file, written.line,
                "haptic_pen.max_newton is " + number_text(pen.max_newton) + "; a " + std::string(device->device) + " holds at most " +
                    number_text(device->max_newton) + " N");
  pen.max_newton = device->max_newton;
  return {};
}

/// Checks conditions that involve several values.
Result<StationSettings> checked(StationSettings settings, const DeviceLines& places) {
  const EyeTrackerSettings& tracker = settings.eye_tracker;
  const PrismServoSettings& servo = settings.prism_servo;
  const bool tracker_has_line = tracker.driver == TrackerDriver::dynasight && !tracker.simulated;
  const bool servo_has_line = servo.driver == ServoDriver::dynamixel && !servo.simulated;
  if (tracker_has_line && tracker.port.empty()) return missing_port(places.tracker_driver, "eye_tracker");
  if (servo_has_line && servo.port.empty()) return missing_port(places.servo_driver, "prism_servo");
  if (tracker_has_line && servo_has_line && tracker.port == servo.port)
    return fail(places.servo_port.file, places.servo_port.line,
                "prism_servo.port is eye_tracker's as well (" + servo.port + "); each has a line of its own");
  if (auto fits = fit_to_device(settings.haptic_pen, places.pen_max_newton); !fits) return fail(std::move(fits.error()));
  return settings;
}

}  // namespace

Result<StationSettings> parse_settings(std::string_view text, const fs::path& file) {
  StationSettings settings;
  DeviceLines places;
  if (auto applied = apply(text, file, settings, places); !applied) return fail(applied.error());
  return checked(std::move(settings), places);
}

Result<StationSettings> parse_settings_part(std::string_view text, const fs::path& file) {
  StationSettings settings;
  DeviceLines places;
  if (auto applied = apply(text, file, settings, places); !applied) return fail(applied.error());
  return settings;
}

std::vector<fs::path> usual_files() {
  std::vector<fs::path> files{"/etc/prismesh/prismesh.toml"};
  const auto folder = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): read at a program's start
    return value != nullptr ? value : "";
  };
  if (const fs::path config = folder("XDG_CONFIG_HOME"); config.is_absolute())
    files.push_back(config / "prismesh" / "prismesh.toml");
  else if (const fs::path home = folder("HOME"); home.is_absolute())
    files.push_back(home / ".config" / "prismesh" / "prismesh.toml");
  return files;
}

Result<StationSettings> read_settings(const std::optional<fs::path>& named_file) { return read_settings(usual_files(), named_file); }

Result<StationSettings> read_settings(const std::vector<fs::path>& usual, const std::optional<fs::path>& named_file) {
  StationSettings settings;
  DeviceLines places;
  std::vector<fs::path> files;
  for (const fs::path& file : usual) {
    std::error_code error;
    if (const fs::file_status status = fs::status(file, error); status.type() != fs::file_type::not_found) files.push_back(file);
  }
  if (named_file) files.push_back(*named_file);
  for (const fs::path& file : files) {
    const Result<FileBytes> bytes = read_file(file);
    if (!bytes) return fail(bytes.error());
    if (auto applied = apply(bytes->text(), file, settings, places); !applied) return fail(applied.error());
  }
  return checked(std::move(settings), places);
}

}  // namespace prismesh::drivers::settings
