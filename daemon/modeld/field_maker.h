// Makes the fields (a value per node or shell) that clients ask for, in sealed shared memory.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/progress.h"
#include "ipc/model/field_page.h"
#include "ipc/model/messages.h"
#include "mesh/document/document.h"
#include "mesh/document/generation.h"

namespace prismesh::modeld {

class FieldMaker {
 public:
  struct MadeField {
    ipc::FieldMade answer;
    ipc::Descriptor values;
  };
  /// Errors: of the field and of the other deck; the state is no longer in the history; cancelled.
  Result<MadeField> make(const mesh::document::Document& document, const ipc::GetField& request, const Progress& progress);
  /// Lets go of the deck of the last comparison.
  void forget() { other_.reset(); }

 private:
  struct ComparedModel {
    const mesh::Model* model = nullptr;
    std::string description;  ///< for the legend
  };
  Result<ComparedModel> compared_model(const mesh::document::Document& document, const mesh::document::Generation& of,
                                       const ipc::GetField& request, const Progress& progress);

  /// The deck of the last comparison, kept because reading it is expensive, and the files it was read from.
  struct OtherDeck {
    std::filesystem::path path;
    std::vector<std::pair<std::filesystem::path, FileIdentity>> files;
    bool whole = true;  ///< no include was missing; a missing one may exist the next time
    mesh::Model model;
    bool is_current() const;
  };
  std::optional<OtherDeck> other_;
  std::uint64_t next_ = 1;
};

}  // namespace prismesh::modeld
