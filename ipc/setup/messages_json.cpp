#include "ipc/setup/messages_json.h"

#include <utility>

#include "ipc/setup/checks.h"
#include "ipc/wire/json_message.h"

namespace prismesh::json {

PRISMESH_MESSAGE(ipc::GetSetup, "get_setup", );
PRISMESH_MESSAGE(ipc::SetName, "set_name", f.required("name", m.name));
PRISMESH_MESSAGE(ipc::SetNetwork, "set_network", f.required("dhcp", m.dhcp), f("address", m.address), f("gateway", m.gateway),
                 f("dns", m.dns));
PRISMESH_MESSAGE(ipc::SetProfile, "set_profile", f.required("profile", m.profile));
PRISMESH_MESSAGE(ipc::SetCalibration, "set_calibration", f.required("profile", m.profile));
PRISMESH_MESSAGE(ipc::SetPairing, "set_pairing", f.required("on", m.on));
PRISMESH_MESSAGE(ipc::SetZone, "set_zone", f.required("zone", m.zone));
PRISMESH_MESSAGE(ipc::SetClock, "set_clock", f.required("date", m.date), f.required("time", m.time));
PRISMESH_MESSAGE(ipc::KeepPage, "keep_page", f.required("page", m.page));
PRISMESH_MESSAGE(ipc::FinishSetup, "finish_setup", );
PRISMESH_MESSAGE(ipc::StationSetup, "setup", f("due", m.due), f("page", m.page), f("name", m.name), f("network", m.network),
                 f("profile", m.profile), f("pairing", m.pairing), f("zone", m.zone), f("zones", m.zones),
                 f("clock_is_kept", m.clock_is_kept), f("date", m.date), f("time", m.time));

}  // namespace prismesh::json

namespace prismesh::ipc {

Result<std::string> encode_setup_request(const SetupRequest& request) { return json_message::encode_request(1, request); }

std::string encode_setup_answer(const SetupAnswer& answer) { return json_message::encode_answer(1, answer, 0); }

Result<SetupRequest> decode_setup_request(std::string_view line) {
  auto decoded = json_message::decode_request<SetupRequest>(line);
  if (!decoded) return fail("request", decoded.error().message);
  if (Result<void> checked = check_setup(decoded->request); !checked) return fail(checked.error());
  return std::move(decoded->request);
}

Result<SetupAnswer> decode_setup_answer(std::string_view line) {
  auto said = json_message::decode_said<SetupAnswer, std::variant<Done>>(line);
  if (!said) return fail(said.error());
  if (auto* answer = std::get_if<SetupAnswer>(&said->message)) return std::move(*answer);
  return fail("message from prismesh-setup", "it is an event, and an answer was expected");
}

}  // namespace prismesh::ipc
