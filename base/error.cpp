#include "base/error.h"

namespace prismesh {

std::string Error::text() const {
  std::string where = file;
  if (!where.empty() && line > 0) where += ":" + std::to_string(line);
  return where.empty() ? message : where + ": " + message;
}

}  // namespace prismesh
