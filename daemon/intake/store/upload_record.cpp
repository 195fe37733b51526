#include "daemon/intake/store/upload_record.h"

#include <charconv>

#include "ipc/store/record_definition.h"
#include "ipc/store/record_text.h"

namespace prismesh::json {

PRISMESH_JSON_OBJECT(intake::NewUpload, f.required("who", m.who), f.required("length", m.length), f("metadata", m.metadata),
                     f("expected", m.expected));

}  // namespace prismesh::json

namespace prismesh::intake {

std::string encode_upload(const NewUpload& upload) { return ipc::store::with_checksum(json::to_line(json::to_json(upload))); }

Result<NewUpload> decode_upload(std::string_view text, const std::string& file) {
  const std::optional<std::string_view> inner = ipc::store::without_checksum(text);
  if (!inner) return fail(file, "is damaged");
  NewUpload upload;
  if (const json::Problem problem = json::read(json::Json::parse(*inner, nullptr, false), upload, json::Author::program))
    return fail(file, *problem);
  return upload;
}

std::string encode_offset(std::uint64_t offset) { return ipc::store::with_checksum(std::to_string(offset)); }

std::optional<std::uint64_t> decode_offset(std::string_view text) {
  const std::optional<std::string_view> inner = ipc::store::without_checksum(text);
  std::uint64_t offset = 0;
  if (!inner || std::from_chars(inner->data(), inner->data() + inner->size(), offset).ptr != inner->data() + inner->size())
    return std::nullopt;
  return offset;
}

}  // namespace prismesh::intake
