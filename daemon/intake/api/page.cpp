#include "daemon/intake/api/page.h"

#include <string>

namespace prismesh::intake {

namespace {

// Nothing but the page's own files, no script or style within it, no text that becomes markup, no frame about it, no form that leaves it.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; "
    "form-action 'none'; require-trusted-types-for 'script'; trusted-types 'none'";

}  // namespace

HttpResponse page_response(std::string_view path) {
  for (const PageFile& file : page_files())
    if (file.path == path)
      return {200,
              {{"Content-Type", std::string(file.type)}, {"Cache-Control", "no-store"}, {"Content-Security-Policy", kPolicy}},
              std::string(file.text),
              std::nullopt,
              nullptr};
  return error_response(404, "there is no such file");
}

}  // namespace prismesh::intake
