#include "ipc/pen/messages_json.h"

#include "ipc/wire/json_message.h"

// --- the definitions: each message's kind and its fields ---

namespace prismesh::json {

PRISMESH_MESSAGE(ipc::PenHello, "hello", f("protocol", m.protocol), f("program", m.program));
PRISMESH_MESSAGE(ipc::GetPen, "get_pen", );
PRISMESH_MESSAGE(ipc::ArmPen, "arm", );
PRISMESH_MESSAGE(ipc::DisarmPen, "disarm", );
PRISMESH_MESSAGE(ipc::SetFeel, "set_feel", f("stiffness_newton_m", m.stiffness_newton_m), f("friction", m.friction),
                 f("damping_newton_s_m", m.damping_newton_s_m));
PRISMESH_MESSAGE(ipc::AttachField, "attach_field", );
PRISMESH_MESSAGE(ipc::PenWelcome, "welcome", f("protocol", m.protocol), f("version", m.version));
PRISMESH_MESSAGE(ipc::Pen, "pen", f("pen", m.pen));
PRISMESH_MESSAGE(ipc::PenChanged, "pen_changed", f("pen", m.pen));
PRISMESH_JSON_OBJECT(ipc::PenInfo, f("kind", m.kind), f("where", m.where), f("simulated", m.simulated), f("state", m.state),
                     f("trouble", m.trouble), f("max_newton", m.max_newton), f("stiffness_newton_m", m.stiffness_newton_m),
                     f("friction", m.friction), f("damping_newton_s_m", m.damping_newton_s_m), f("workspace_scale", m.workspace_scale),
                     f("left_handed", m.left_handed));

}  // namespace prismesh::json

namespace prismesh::ipc {

Result<std::string> encode_pen_request(std::uint64_t number, const PenRequest& request) {
  return json_message::encode_request(number, request);
}

std::string encode_pen_answer(std::uint64_t to, const PenAnswer& answer, std::size_t descriptors) {
  return json_message::encode_answer(to, answer, descriptors);
}

std::string encode_pen_event(const PenEvent& event) { return json_message::encode_event(event); }

tl::expected<Numbered<PenRequest>, BadRequest> decode_pen_request(std::string_view line) {
  return json_message::decode_request<PenRequest>(line);
}

Result<Said<PenAnswer, PenEvent>> decode_from_pen(std::string_view line) { return json_message::decode_said<PenAnswer, PenEvent>(line); }

}  // namespace prismesh::ipc
