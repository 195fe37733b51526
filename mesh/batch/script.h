// A script of edits with parameters: JSON Lines, in whose texts ${name} stands for a value.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/batch/plan.h"
#include "mesh/document/edit.h"

namespace prismesh::mesh::batch {

struct Script {
  std::filesystem::path file;
  std::string text;
};

/// An edit with its values, and where it stands.
struct ScriptEdit {
  document::Edit edit;
  std::string json;
  long line = 0;
};

/// Puts values into a script. A text that is only "${height}" becomes the value itself, a number or a text; in a longer text, such as
/// "part:${part}", the value's words take its place. Values are never read as JSON. Names of fields aren't touched. Empty lines are
/// skipped. Errors, with file and line: text that isn't JSON, an unknown parameter (with the nearest known one), an unfinished ${, an edit
/// that parse_edit refuses.
Result<std::vector<ScriptEdit>> edits_with(const Script& script, const std::vector<Parameter>& parameters,
                                           const std::vector<ParameterValue>& values);

/// The parameters that a script names, ascending, each once. Errors: as above, but for what depends on values.
Result<std::vector<std::string>> parameters_named(const Script& script);

}  // namespace prismesh::mesh::batch
