// Answers that every daemon gives.
#pragma once

#include <optional>
#include <string>

namespace prismesh::ipc {

struct Failed {
  std::string file;
  long line = 0;
  std::string message;
  std::optional<bool> unsaved_edits{};  ///< true, of Open and Close: the open document has some, and what to do with them isn't said
};
struct Done {};

}  // namespace prismesh::ipc
