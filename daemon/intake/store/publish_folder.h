// Publishes what became of a stored model on this machine.
#pragma once

#include <filesystem>
#include <string>

#include "daemon/intake/store/store.h"

namespace prismesh::intake {

/// A folder in which another program has edited a model of the store.
struct EditedFolder {
  std::filesystem::path folder;
  ipc::store::ContentHash derived_from;  ///< its files, under the same paths, are published
  std::string who;
  std::int64_t when_s = 0;
};

/// Publishes the folder's files as a model with that lineage and name; those that are as they were aren't stored again. If none changed, it
/// is the model that it came from. Nothing is read through links. Errors: no such model; a file is gone or isn't one; quota, space, the
/// disk.
Outcome<ipc::store::ModelRecord> publish_folder(Store& store, const EditedFolder& edited);

}  // namespace prismesh::intake
