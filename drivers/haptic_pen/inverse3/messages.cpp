#include "drivers/haptic_pen/inverse3/messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/json/nesting.h"

namespace prismesh::drivers::haptic_pen::inverse3 {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 16;
constexpr double kMaxMetres = 10;
constexpr std::size_t kMaxDevices = 16, kMaxIdLetters = 32;

tl::unexpected<Error> unlike(const std::string& what) { return fail("", "doesn't talk like a Haply Inverse Service: " + what); }

/// The member, or null where it is missing or `from` is no object.
const Json* member(const Json* from, const char* name) {
  if (from == nullptr || !from->is_object()) return nullptr;
  const auto found = from->find(name);
  return found == from->end() ? nullptr : &*found;
}

bool flag(const Json* from, const char* name, bool otherwise) {
  const Json* value = member(from, name);
  return value != nullptr && value->is_boolean() ? value->get<bool>() : otherwise;
}

std::optional<double> number(const Json* from, const char* name) {
  const Json* value = member(from, name);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  const auto read = value->get<double>();
  return std::isfinite(read) ? std::optional(read) : std::nullopt;
}

std::optional<Eigen::Vector3d> vector(const Json* from) {
  const auto x = number(from, "x"), y = number(from, "y"), z = number(from, "z");
  if (!x || !y || !z) return std::nullopt;
  return Eigen::Vector3d(*x, *y, *z);
}

std::optional<Eigen::Quaterniond> rotation(const Json* from) {
  const auto part = vector(from);
  const auto w = number(from, "w");
  if (!part || !w) return std::nullopt;
  Eigen::Quaterniond turn(*w, part->x(), part->y(), part->z());
  const double length = turn.coeffs().stableNorm();
  // Sixteen-bit numbers make it a little longer or shorter. Another length is no rotation.
  if (!(length > 0.9 && length < 1.1)) return std::nullopt;
  turn.coeffs() /= length;
  return turn;
}

bool is_id(const std::string& text) {
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_';
  };
  return !text.empty() && text.size() <= kMaxIdLetters && std::all_of(text.begin(), text.end(), is_plain);
}

bool is_unit(const std::optional<Eigen::Vector3d>& scale) {
  return !scale || (*scale - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff() < 1e-6;
}
bool is_none(const std::optional<Eigen::Vector3d>& shift) { return !shift || shift->cwiseAbs().maxCoeff() < 1e-6; }

/// Whether a mount or a transform changes anything. Where its rotation can't be read, it does.
bool moves(const Json* placement) {
  if (placement == nullptr || !placement->is_object()) return false;
  if (!is_unit(vector(member(placement, "scale"))) || !is_none(vector(member(placement, "position")))) return true;
  const Json* written = member(placement, "rotation");
  if (written == nullptr) return false;
  const auto turn = rotation(written);
  return !turn || turn->vec().norm() > 1e-6;
}

bool has_other_axes(const Json* config) {
  const Json* permutation = member(member(config, "basis"), "permutation");
  return permutation != nullptr && (!permutation->is_string() || (*permutation != "XYZ" && *permutation != "+X+Y+Z"));
}

Result<DeviceState> read_device(const Json& one) {
  DeviceState device;
  const Json* id = member(&one, "device_id");
  if (id == nullptr || !id->is_string() || !is_id(id->get_ref<const std::string&>())) return unlike("a device has no usable \"device_id\"");
  device.id = id->get<std::string>();
  const Json* state = member(&one, "state");
  if (const Json* place = member(state, "cursor_position")) {
    device.position_m = vector(place);
    if (!device.position_m || device.position_m->cwiseAbs().maxCoeff() > kMaxMetres)
      return unlike("\"cursor_position\" isn't x, y and z in metres");
  }
  const Json* status = member(&one, "status");
  device.ready = flag(status, "ready", true);
  device.powered = flag(status, "power_supply", true);
  device.used_by_another = flag(status, "in_use", false);
  const Json* config = member(&one, "config");
  device.turned = has_other_axes(config) || moves(member(config, "mount")) || moves(member(state, "transform"));
  return device;
}

GripState read_grip(const Json& one) {
  GripState grip;
  const Json* state = member(&one, "state");
  grip.orientation = rotation(member(state, "orientation"));
  const Json* buttons = member(state, "buttons");
  constexpr std::array kNames{"a", "b", "c"};
  for (std::size_t bit = 0; bit < kNames.size(); ++bit)
    if (flag(buttons, kNames[bit], false)) grip.buttons |= 1U << bit;
  if (flag(state, "button", false)) grip.buttons |= 1;
  return grip;
}

/// Never longer than it was, so that it stays within its limit.
double shortened(double newton) { return std::isfinite(newton) && std::abs(newton) < 1000 ? std::trunc(newton * 1e4) / 1e4 + 0.0 : 0; }

}  // namespace

Result<ServiceState> read_message(std::string_view text) {
  if (text.size() > kMaxMessageBytes) return unlike("a message is longer than 64 KiB");
  if (json::is_nested_deeper(text, kMaxDepth)) return unlike("a message is nested too deeply");
  const Json root = Json::parse(text, nullptr, false);
  if (root.is_discarded()) return unlike("a message isn't JSON");
  if (!root.is_object()) return unlike("a message isn't an object");
  ServiceState read;
  read.has_session = root.contains("session_id");
  if (const Json* devices = member(&root, "inverse3")) {
    if (!devices->is_array() || devices->size() > kMaxDevices) return unlike("\"inverse3\" isn't a list of devices");
    for (const Json& one : *devices) {
      Result<DeviceState> device = read_device(one);
      if (!device) return fail(std::move(device.error()));
      read.devices.push_back(std::move(*device));
    }
  }
  for (const char* kind : {"wireless_verse_grip", "verse_grip", "custom_verse_grip"}) {
    const Json* grips = member(&root, kind);
    if (grips == nullptr || !grips->is_array() || grips->size() > kMaxDevices) continue;
    for (const Json& one : *grips) read.grips.push_back(read_grip(one));
  }
  return read;
}

Result<std::string> choose_device(const ServiceState& state) {
  if (state.devices.empty()) return fail("", "the Haply Inverse Service runs, but knows no Inverse3: is it plugged in?");
  if (state.devices.size() > 1)
    return fail("", fmt::format("{} Inverse3 are plugged in: leave one, or nobody could say which is which", state.devices.size()));
  const DeviceState& device = state.devices.front();
  if (device.used_by_another) return fail("", "another program uses the Inverse3: end it");
  if (!device.powered) return fail("", "the Inverse3 has no power: plug in its supply");
  if (device.turned)
    return fail("",
                "the axes, the mount or the scale of the Inverse3 were changed in its service: set them back (basis XYZ), or its forces "
                "would go another way");
  return device.id;
}

std::string force_message(std::string_view device_id, const Eigen::Vector3d& newton, bool since_3_5) {
  const bool finite = newton.allFinite();
  const auto part = [&](Eigen::Index axis) { return finite ? shortened(newton[axis]) : 0.0; };
  return fmt::format(R"({{"inverse3":[{{"device_id":"{}","commands":{{"set_cursor_force":{{"{}":{{"x":{},"y":{},"z":{}}}}}}}}}]}})",
                     device_id, since_3_5 ? "vector" : "values", part(0), part(1), part(2));
}

std::vector<std::byte> text_frame(std::string_view text) {
  constexpr std::byte kWholeText{0x81}, kMasked{0x80};
  std::vector<std::byte> frame{kWholeText};
  if (text.size() < 126) {
    frame.push_back(kMasked | static_cast<std::byte>(text.size()));
  } else {
    frame.push_back(kMasked | std::byte{126});
    frame.push_back(static_cast<std::byte>(text.size() >> 8 & 0xFF));
    frame.push_back(static_cast<std::byte>(text.size() & 0xFF));
  }
  frame.insert(frame.end(), 4, std::byte{0});
  for (const char letter : text) frame.push_back(static_cast<std::byte>(letter));
  return frame;
}

Eigen::Vector3d to_pen_axes(const Eigen::Vector3d& service) { return {service.x(), service.z(), -service.y()}; }
Eigen::Vector3d to_service_axes(const Eigen::Vector3d& pen) { return {pen.x(), -pen.z(), pen.y()}; }

Eigen::Quaterniond to_pen_axes(const Eigen::Quaterniond& service) {
  const Eigen::Quaterniond axes(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  return axes * service * axes.conjugate();
}

Eigen::Vector3d workspace_middle_m() { return {0, -0.12, 0.15}; }

}  // namespace prismesh::drivers::haptic_pen::inverse3
