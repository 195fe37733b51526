#include "ipc/intake/messages_json.h"

#include "ipc/wire/json_message.h"

namespace prismesh::json {

PRISMESH_MESSAGE(ipc::IntakeHello, "hello", f("protocol", m.protocol), f("program", m.program));
PRISMESH_MESSAGE(ipc::GetIntake, "get_intake", );
PRISMESH_MESSAGE(ipc::MakePairingCode, "make_pairing_code", f("name", m.name), f.required("scopes", m.scopes));
PRISMESH_MESSAGE(ipc::GetTokens, "get_tokens", );
PRISMESH_MESSAGE(ipc::RevokeToken, "revoke_token", f.required("name", m.name));
PRISMESH_MESSAGE(ipc::IntakeWelcome, "welcome", f("protocol", m.protocol), f("version", m.version));
PRISMESH_MESSAGE(ipc::IntakeInfo, "intake", f("address", m.address), f("fingerprint", m.fingerprint), f("store", m.store),
                 f("work", m.work));
PRISMESH_MESSAGE(ipc::PublishWork, "publish_work", f.required("work", m.work), f.required("derived_from", m.derived_from));
PRISMESH_MESSAGE(ipc::DescribeModel, "describe_model", f.required("model", m.model), f.required("nodes", m.nodes),
                 f.required("elements", m.elements), f.required("parts", m.parts), f.required("warn", m.warn), f.required("fail", m.fail),
                 f("thumbnail", m.thumbnail));
PRISMESH_MESSAGE(ipc::PublishedWork, "published_work", f("model", m.model));
PRISMESH_MESSAGE(ipc::MadePairingCode, "pairing_code", f("code", m.code), f("lifetime_s", m.lifetime_s));
PRISMESH_JSON_OBJECT(ipc::TokenInfo, f("name", m.name), f("scopes", m.scopes), f("made_s", m.made_s), f("expires_s", m.expires_s));
PRISMESH_MESSAGE(ipc::Tokens, "tokens", f("tokens", m.tokens));
PRISMESH_MESSAGE(ipc::CatalogueChanged, "catalogue_changed", f("model", m.model));

}  // namespace prismesh::json

namespace prismesh::ipc {

Result<std::string> encode_intake_request(std::uint64_t number, const IntakeRequest& request) {
  return json_message::encode_request(number, request);
}

std::string encode_intake_answer(std::uint64_t to, const IntakeAnswer& answer, std::size_t descriptors) {
  return json_message::encode_answer(to, answer, descriptors);
}

std::string encode_intake_event(const IntakeEvent& event) { return json_message::encode_event(event); }

tl::expected<Numbered<IntakeRequest>, BadRequest> decode_intake_request(std::string_view line) {
  return json_message::decode_request<IntakeRequest>(line);
}

Result<Said<IntakeAnswer, IntakeEvent>> decode_from_intake(std::string_view line) {
  return json_message::decode_said<IntakeAnswer, IntakeEvent>(line);
}

}  // namespace prismesh::ipc
