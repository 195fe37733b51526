// The JSON definitions of the store's types. Includes nlohmann's heavy header.
#pragma once

#include "base/json/read.h"
#include "base/json/write.h"
#include "ipc/store/record.h"

namespace prismesh::json {

template <>
struct Definition<ipc::store::ContentHash> {
  static void write(Json& json, const ipc::store::ContentHash& hash) { json = hash.hex(); }
  static Problem read(const Json& json, ipc::store::ContentHash& hash, Author author) {
    if (json.is_string())
      if (const auto parsed = ipc::store::parse_content_hash(json.get_ref<const std::string&>())) {
        hash = *parsed;
        return std::nullopt;
      }
    return must_be("a SHA-256 of 64 hexadecimal digits", json, author);
  }
};

PRISMESH_JSON_OBJECT(ipc::store::ModelFigures, f("nodes", m.nodes), f("elements", m.elements), f("parts", m.parts), f("warn", m.warn),
                     f("fail", m.fail));
PRISMESH_JSON_OBJECT(ipc::store::ModelRecord, f.required("model", m.model), f.required("name", m.name), f.required("who", m.who),
                     f.required("when_s", m.when_s), f.required("bytes", m.bytes), f.required("files", m.files),
                     f("derived_from", m.derived_from), f("figures", m.figures), f("thumbnail", m.thumbnail));

}  // namespace prismesh::json
