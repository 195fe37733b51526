#include "daemon/intake/access/token_text.h"

#include "ipc/store/record_definition.h"
#include "ipc/store/record_text.h"

namespace prismesh::json {

template <>
struct Definition<intake::Scopes> {
  static void write(Json& json, const intake::Scopes& scopes) { json = intake::scope_names(scopes); }
  static Problem read(const Json& json, intake::Scopes& scopes, Author author) {
    std::vector<std::string> names;
    if (Problem problem = json::read(json, names, author)) return problem;
    const Result<intake::Scopes> read = intake::scopes_named(names);
    if (!read) return read.error().message;
    scopes = *read;
    return std::nullopt;
  }
};
PRISMESH_JSON_OBJECT(intake::TokenRecord, f.required("name", m.name), f.required("sha256", m.hash), f.required("scopes", m.scopes),
                     f.required("made_s", m.made_s), f.required("expires_s", m.expires_s));
PRISMESH_JSON_OBJECT(intake::TokenFile, f.required("tokens", m.tokens), f.required("latest_s", m.latest_s));

}  // namespace prismesh::json

namespace prismesh::intake {

std::vector<std::string> scope_names(const Scopes& scopes) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kScopeNames.size(); ++i)
    if (scopes.has(static_cast<Scope>(i))) names.emplace_back(kScopeNames[i]);
  return names;
}

Result<Scopes> scopes_named(const std::vector<std::string>& names) {
  Scopes scopes;
  for (const std::string& name : names) {
    bool known = false;
    for (std::size_t i = 0; i < kScopeNames.size(); ++i)
      if (kScopeNames[i] == name) {
        scopes.add(static_cast<Scope>(i));
        known = true;
      }
    if (!known) return fail("scope", "'" + name + "' is none of read, upload, remove, metrics");
  }
  return scopes;
}

std::string encode_tokens(const TokenFile& file) { return ipc::store::with_checksum(json::to_line(json::to_json(file))); }

Result<TokenFile> decode_tokens(std::string_view text, const std::string& name) {
  const std::optional<std::string_view> inner = ipc::store::without_checksum(text);
  if (!inner) return fail(name, "the list of tokens is damaged; remove it and pair all clients anew");
  TokenFile file;
  if (const json::Problem problem = json::read(json::Json::parse(*inner, nullptr, false), file, json::Author::program))
    return fail(name, "the list of tokens " + *problem);
  return file;
}

}  // namespace prismesh::intake
