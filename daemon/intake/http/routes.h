// The one table of what prismesh-intake answers. Tests go through it and expect a refusal for everybody who has no right.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/intake/access/token.h"

namespace prismesh::intake {

enum class Operation : std::uint8_t {
  show_page,
  health,
  pair,
  describe_uploads,
  begin_upload,
  show_upload,
  continue_upload,
  end_upload,
  list_models,
  publish_model,
  show_model,
  remove_model,
  fetch_manifest,
  fetch_file,
  fetch_thumbnail,
  follow_events,
  show_token,
  give_token_up,
  show_metrics,
  describe_api,
};

struct Route {
  Operation operation;
  std::string_view method;
  std::string_view path;       ///< parts in braces stand for anything without a slash
  std::optional<Scope> scope;  ///< the right it needs; nothing: see `access`
  enum class Access : std::uint8_t {
    everybody,  ///< without a token: the page's own files, pairing and health only
    token,      ///< any token, or one with the right `scope`
  } access;
  std::uint64_t max_body;      ///< bytes; 0: no body. Uploads have their own limit
  std::string_view body_type;  ///< that the body must have
};

std::span<const Route> routes();

struct FoundRoute {
  const Route* route = nullptr;         ///< null: the path has no such method
  std::vector<std::string_view> parts;  ///< of the path, that stand for the braces
  std::string allowed;                  ///< methods of the path, for the header Allow; empty: no such path
};
/// A GET route answers HEAD too.
FoundRoute find_route(std::string_view method, std::string_view path);

}  // namespace prismesh::intake
