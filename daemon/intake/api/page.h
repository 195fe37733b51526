// The page that people use in a browser. Its files are compiled in from daemon/intake/page; nothing of it is read at run time.
#pragma once

#include <span>
#include <string_view>

#include "daemon/intake/http/request.h"

namespace prismesh::intake {

struct PageFile {
  std::string_view path;  ///< of its route
  std::string_view type;  ///< for the header Content-Type
  std::string_view text;
};

std::span<const PageFile> page_files();

/// The file at that path.
HttpResponse page_response(std::string_view path);

}  // namespace prismesh::intake
