#include "ipc/store/record_text.h"

#include <span>

#include "base/hash.h"
#include "ipc/store/record_definition.h"

namespace prismesh::ipc::store {

namespace {

constexpr std::size_t kChecksumDigits = 32;

std::string checksum_of(std::string_view text) { return hash128(std::as_bytes(std::span(text.data(), text.size()))).hex(); }

}  // namespace

std::string with_checksum(std::string_view text) { return checksum_of(text) + "\n" + std::string(text); }

std::optional<std::string_view> without_checksum(std::string_view checked) {
  if (checked.size() <= kChecksumDigits || checked[kChecksumDigits] != '\n') return std::nullopt;
  const std::string_view text = checked.substr(kChecksumDigits + 1);
  if (checksum_of(text) != checked.substr(0, kChecksumDigits)) return std::nullopt;
  return text;
}

std::string record_json(const ModelRecord& record) { return json::to_line(json::to_json(record)); }

std::string encode_record(const ModelRecord& record) { return with_checksum(record_json(record)); }

Result<ModelRecord> decode_record(std::string_view text, const std::string& file) {
  const std::optional<std::string_view> inner = without_checksum(text);
  if (!inner) return fail(file, "the record of a stored model is damaged");
  const json::Json read = json::Json::parse(*inner, nullptr, false);
  ModelRecord record;
  if (const json::Problem problem = json::read(read, record, json::Author::program))
    return fail(file, "the record of a stored model " + *problem);
  return record;
}

}  // namespace prismesh::ipc::store
