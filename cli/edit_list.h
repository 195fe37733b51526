// Edits as a user gives them: JSON arguments and a script, read before the first one is done. Inner to cli.
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

/// A reason and the exit status it leads to.
struct Refusal {
  Error error;
  int status = kFailed;
};

/// Parses the arguments (named `argument` in errors), then the script's lines, onto `wanted`; empty lines are passed over.
/// Nothing: all were read.
std::optional<Refusal> read_edits(const std::vector<std::string>& edits, const std::string& argument,
                                  const std::optional<std::filesystem::path>& script, std::vector<WantedEdit>& wanted);

}  // namespace prismesh::cli
