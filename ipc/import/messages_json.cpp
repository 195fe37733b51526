#include "ipc/import/messages_json.h"

#include "ipc/wire/json_message.h"

namespace prismesh::json {

PRISMESH_JSON_OBJECT(ipc::ImportLimits, f("memory_bytes", m.memory_bytes), f("cpu_s", m.cpu_s), f("files", m.files),
                     f("text_bytes", m.text_bytes), f("nodes", m.nodes), f("elements", m.elements));
PRISMESH_JSON_OBJECT(ipc::StandIn, f.required("of", m.of), f.required("file", m.file));
PRISMESH_MESSAGE(ipc::Import, "import", f("protocol", m.protocol), f.required("main", m.main), f("shown_folder", m.shown_folder),
                 f("limits", m.limits), f("stand_ins", m.stand_ins));
PRISMESH_MESSAGE(ipc::Rewrite, "rewrite", f("protocol", m.protocol), f.required("main", m.main), f("shown_folder", m.shown_folder),
                 f("limits", m.limits), f("stand_ins", m.stand_ins), f.required("content", m.content));
PRISMESH_MESSAGE(ipc::Rewritten, "rewritten", f("unguarded", m.unguarded));
PRISMESH_MESSAGE(ipc::Imported, "imported", f("unguarded", m.unguarded));
PRISMESH_MESSAGE(ipc::ImportProgress, "progress_made", f("fraction", m.fraction));

}  // namespace prismesh::json

namespace prismesh::ipc {

Result<std::string> encode_import_request(const ImportRequest& request) { return json_message::encode_request(1, request); }

std::string encode_import_answer(const ImportAnswer& answer, std::size_t descriptors) {
  return json_message::encode_answer(1, answer, descriptors);
}

std::string encode_import_event(const ImportEvent& event) { return json_message::encode_event(event); }

Result<ImportRequest> decode_import_request(std::string_view line) {
  auto decoded = json_message::decode_request<ImportRequest>(line);
  if (!decoded) return fail("request", decoded.error().message);
  return std::move(decoded->request);
}

Result<Said<ImportAnswer, ImportEvent>> decode_from_import(std::string_view line) {
  return json_message::decode_said<ImportAnswer, ImportEvent>(line);
}

}  // namespace prismesh::ipc
