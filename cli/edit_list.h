// The edits that a user gives as arguments and as a script: reads them before the first one is applied. Inner to cli.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/context.h"
#include "mesh/document/edit.h"

namespace prismesh::cli {

/// An edit and where the user wrote it.
struct WantedEdit {
  mesh::document::Edit edit;
  std::string file;
  long line = 0;
};

/// A reason and the exit status for it.
struct Refusal {
  Error error;
  int status = kFailed;
};

/// Parses the arguments (named `argument` in errors), then the script's lines, and appends them to `wanted`; skips empty lines.
/// Returns nothing if all were read.
std::optional<Refusal> read_edits(const std::vector<std::string>& edits, const std::string& argument,
                                  const std::optional<std::filesystem::path>& script, std::vector<WantedEdit>& wanted);

/// Whether the edit keeps what it has reached when it is cancelled.
bool is_kept_on_cancel(const mesh::document::Edit& edit);
/// Makes every repair among the edits keep what it has reached when it is cancelled.
void keep_on_cancel(std::vector<WantedEdit>& wanted);

}  // namespace prismesh::cli
