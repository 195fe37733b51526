// Fetches a model from a station: each file is hashed, and the folder appears whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/progress.h"
#include "ipc/remote/remote_station.h"
#include "ipc/store/manifest.h"

namespace prismesh::ipc::remote {

/// The model that is meant. `wanted`: its hash, at least six digits of the beginning of its hash, or its whole name. Errors: there is none,
/// or several.
Result<ListedModel> find_model(RemoteStation& remote, const std::string& wanted);

struct PullOptions {
  RemoteOptions remote;
  std::optional<std::filesystem::path> folder;  ///< nothing: a new one in the current folder, named by main file and hash
  Progress progress;
};

struct Pulled {
  ListedModel model;
  std::filesystem::path folder;
  std::filesystem::path main;        ///< the main file, in the folder
  std::uint64_t received_bytes = 0;  ///< of files
};

/// Errors: as find_model; the folder is there and not empty; what the station gives has another hash or a path that leads out of the
/// folder; the line stays cut: then what came lies beside the folder, and another call goes on with it.
Result<Pulled> pull(const PairedStation& station, const std::string& wanted, const PullOptions& options);

}  // namespace prismesh::ipc::remote
