#include "ipc/device/messages_json.h"

#include "ipc/wire/json_message.h"

// --- the definitions: each message's kind and its fields ---

namespace prismesh::json {

PRISMESH_MESSAGE(ipc::DeviceHello, "hello", f("protocol", m.protocol), f("program", m.program));
PRISMESH_MESSAGE(ipc::GetDevices, "get_devices", );
PRISMESH_MESSAGE(ipc::PictureShown, "picture_shown", f("mono", m.mono));
PRISMESH_MESSAGE(ipc::HoldMask, "hold_mask", f("position_mm", m.position_mm));
PRISMESH_MESSAGE(ipc::ReleaseMask, "release_mask", );
PRISMESH_MESSAGE(ipc::Rearm, "rearm", );
PRISMESH_MESSAGE(ipc::Reload, "reload", );
PRISMESH_MESSAGE(ipc::DeviceWelcome, "welcome", f("protocol", m.protocol), f("version", m.version));
PRISMESH_MESSAGE(ipc::Devices, "devices", f("devices", m.devices), f("profile", m.profile));
PRISMESH_MESSAGE(ipc::DeviceChanged, "device_changed", f("device", m.device));
PRISMESH_JSON_OBJECT(ipc::DeviceInfo, f("role", m.role), f("kind", m.kind), f("where", m.where), f("simulated", m.simulated),
                     f("state", m.state), f("trouble", m.trouble));

}  // namespace prismesh::json

namespace prismesh::ipc {

Result<std::string> encode_device_request(std::uint64_t number, const DeviceRequest& request) {
  return json_message::encode_request(number, request);
}

std::string encode_device_answer(std::uint64_t to, const DeviceAnswer& answer, std::size_t descriptors) {
  return json_message::encode_answer(to, answer, descriptors);
}

std::string encode_device_event(const DeviceEvent& event) { return json_message::encode_event(event); }

std::string device_answer_fields(const DeviceAnswer& answer) { return json_message::answer_fields(answer); }

tl::expected<Numbered<DeviceRequest>, BadRequest> decode_device_request(std::string_view line) {
  return json_message::decode_request<DeviceRequest>(line);
}

Result<Said<DeviceAnswer, DeviceEvent>> decode_from_deviced(std::string_view line) {
  return json_message::decode_said<DeviceAnswer, DeviceEvent>(line);
}

}  // namespace prismesh::ipc
