// Gives the catalogue of the station's store what is in its models. Inner to cli.
#pragma once

#include <string>

#include "cli/commands.h"
#include "ipc/intake/client.h"

namespace prismesh::cli {

/// Reads the model of that name or hash, or all that lack figures or a picture, in the sandbox, and tells prismesh-intake. Says of each
/// what was found, or why not. Returns the exit status.
int describe_models(ipc::IntakeClient& intake, const std::string& model, const Common& common, const Context& context);

}  // namespace prismesh::cli
