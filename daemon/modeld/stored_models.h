// Opens models of the store, and gives what was saved of them back. The store is that of prismesh-intake; without it there is none.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "ipc/model/messages.h"
#include "mesh/document/model_counts.h"

namespace prismesh::modeld {

class StoredModels {
 public:
  StoredModels() = default;
  /// `intake`: the socket of prismesh-intake.
  explicit StoredModels(std::filesystem::path intake) : intake_(std::move(intake)) {}

  /// Copies the model that the request names by its hash (Open::stored) into a new folder, and returns the request to open it there,
  /// sandboxed. Errors: no intake, no such model, the disk.
  Result<ipc::Open> lay_out(const ipc::Open& request) const;
  /// Publishes a deck that was laid out and saved. Returns the new model's hash. Errors: no intake; why it can't be published.
  Result<std::string> give_back(const std::filesystem::path& deck, const std::string& derived_from) const;
  /// Tells the store's catalogue what was found in a model. Errors: no intake, no such model.
  Result<void> describe(const std::string& model, const mesh::document::ModelCounts& counts) const;

 private:
  std::filesystem::path intake_;
};

}  // namespace prismesh::modeld
