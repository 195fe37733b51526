#include "daemon/intake/http/routes.h"

#include <array>

#include "ipc/store/manifest.h"

namespace prismesh::intake {

namespace {

constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};  // an upload's length is known
constexpr auto kEverybody = Route::Access::everybody;
constexpr auto kToken = Route::Access::token;
constexpr std::nullopt_t kAny = std::nullopt;

constexpr std::array kRoutes{
    Route{Operation::show_page, "GET", "/", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/style.css", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/icon.svg", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/asking.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/catalogue.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/elements.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/fetching.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/main.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/memory.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/pairing.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/sending.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/sha256.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/upload.js", kAny, kEverybody, 0, ""},
    Route{Operation::show_page, "GET", "/page/zip.js", kAny, kEverybody, 0, ""},
    Route{Operation::health, "GET", "/health", kAny, kEverybody, 0, ""},
    Route{Operation::pair, "POST", "/pair", kAny, kEverybody, 4096, "application/json"},
    Route{Operation::describe_uploads, "OPTIONS", "/uploads", Scope::upload, kToken, 0, ""},
    Route{Operation::begin_upload, "POST", "/uploads", Scope::upload, kToken, 0, ""},
    Route{Operation::show_upload, "HEAD", "/uploads/{upload}", Scope::upload, kToken, 0, ""},
    Route{Operation::continue_upload, "PATCH", "/uploads/{upload}", Scope::upload, kToken, kUnlimited, "application/offset+octet-stream"},
    Route{Operation::end_upload, "DELETE", "/uploads/{upload}", Scope::upload, kToken, 0, ""},
    Route{Operation::list_models, "GET", "/models", Scope::read, kToken, 0, ""},
    Route{Operation::publish_model, "POST", "/models", Scope::upload, kToken, ipc::store::kMaxManifestBytes, "application/x-prismesh-set"},
    Route{Operation::show_model, "GET", "/models/{model}", Scope::read, kToken, 0, ""},
    Route{Operation::remove_model, "DELETE", "/models/{model}", Scope::remove, kToken, 0, ""},
    Route{Operation::fetch_manifest, "GET", "/models/{model}/manifest", Scope::read, kToken, 0, ""},
    Route{Operation::fetch_file, "GET", "/models/{model}/files/{file}", Scope::read, kToken, 0, ""},
    Route{Operation::fetch_thumbnail, "GET", "/models/{model}/thumbnail", Scope::read, kToken, 0, ""},
    Route{Operation::follow_events, "GET", "/events", Scope::read, kToken, 0, ""},
    Route{Operation::show_token, "GET", "/token", kAny, kToken, 0, ""},
    Route{Operation::give_token_up, "DELETE", "/token", kAny, kToken, 0, ""},
    Route{Operation::show_metrics, "GET", "/metrics", Scope::metrics, kToken, 0, ""},
    Route{Operation::describe_api, "GET", "/openapi.json", kAny, kToken, 0, ""},
};

/// Whether the path fits; the parts that stand for braces.
std::optional<std::vector<std::string_view>> fit(std::string_view pattern, std::string_view path) {
  std::vector<std::string_view> parts;
  while (!pattern.empty() && !path.empty()) {
    if (pattern.front() != '{') {
      if (pattern.front() != path.front()) return std::nullopt;
      pattern.remove_prefix(1);
      path.remove_prefix(1);
      continue;
    }
    pattern.remove_prefix(pattern.find('}') + 1);
    const std::string_view part = path.substr(0, path.find('/'));
    if (part.empty()) return std::nullopt;
    parts.push_back(part);
    path.remove_prefix(part.size());
  }
  if (!pattern.empty() || !path.empty()) return std::nullopt;
  return parts;
}

}  // namespace

std::span<const Route> routes() { return kRoutes; }

FoundRoute find_route(std::string_view method, std::string_view path) {
  FoundRoute found;
  for (const Route& route : kRoutes) {
    std::optional<std::vector<std::string_view>> parts = fit(route.path, path);
    if (!parts) continue;
    for (const std::string_view each : {route.method, std::string_view(route.method == "GET" ? "HEAD" : "")})
      if (!each.empty()) found.allowed += (found.allowed.empty() ? "" : ", ") + std::string(each);
    const bool fits = route.method == method || (route.method == "GET" && method == "HEAD");
    if (!fits) continue;
    found.route = &route;
    found.parts = std::move(*parts);
  }
  return found;
}

}  // namespace prismesh::intake
