// How an expression names a file of the deck.
#pragma once

#include <string>

namespace prismesh::kiosk::tools::parts {

/// `file:"NAME"`, in the quotes that the name doesn't hold itself.
inline std::string file_expression(const std::string& name) {
  const char quote = name.find('"') == std::string::npos ? '"' : '\'';
  return "file:" + std::string(1, quote) + name + quote;
}

}  // namespace prismesh::kiosk::tools::parts
