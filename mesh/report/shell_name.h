// The name of a shell as expressions write it.
#pragma once

#include <string>

#include "mesh/model/model.h"

namespace prismesh::mesh::report {

/// "shell:12".
inline std::string shell_name(const mesh::Model& model, mesh::ShellIndex shell) {
  return "shell:" + std::to_string(model.shell_ids[shell.value]);
}

}  // namespace prismesh::mesh::report
