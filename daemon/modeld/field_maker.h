// Makes the fields that clients ask for: finds what is compared with what, and seals the values.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/progress.h"
#include "ipc/field_page.h"
#include "ipc/messages.h"
#include "mesh/document/document.h"
#include "mesh/document/generation.h"

namespace prismesh::modeld {

class FieldMaker {
 public:
  struct MadeField {
    ipc::FieldMade answer;
    ipc::Descriptor values;
  };
  /// Errors: those of the field and of the other deck, a state that the history has no more, cancelled.
  Result<MadeField> make(const mesh::document::Document& document, const ipc::GetField& request, const Progress& progress);

 private:
  /// A state to compare with, and its name for people.
  struct ComparedState {
    const mesh::Model* model = nullptr;
    std::string words;
  };
  Result<ComparedState> other_state(const mesh::document::Document& document, const mesh::document::Generation& of,
                                    const ipc::GetField& request, const Progress& progress);

  /// The deck that was compared with last, and the files it was read from.
  struct OtherDeck {
    std::filesystem::path path;
    std::vector<std::pair<std::filesystem::path, FileIdentity>> files;
    bool whole = true;  ///< no include was missing, which may be there the next time
    mesh::Model model;
    bool is_current() const;
  };
  std::optional<OtherDeck> other_;
  std::uint64_t next_ = 1;
};

}  // namespace prismesh::modeld
