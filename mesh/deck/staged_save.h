// A save whose files are written and flushed beside their targets, and wait to be put in place: so that what follows from the save can be
// made and kept before the first file is replaced.
#pragma once

#include <filesystem>
#include <vector>

#include "base/file.h"
#include "base/hash.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/rounding.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save_report.h"

namespace prismesh::mesh::deck {

class StagedSave {
 public:
  struct File {
    std::size_t index = 0;  ///< in Deck::files
    Hash128 before;         ///< what is to be replaced; of a save elsewhere nothing
    Hash128 after;
    bool as_read = false;  ///< it gets back what it held when it was read
  };

  /// As save (mesh/deck/save.h), up to the point where files are replaced. The deck must outlive this. Errors: the same.
  static Result<StagedSave> write(const Deck& deck, const Model& original, const Model& model, const std::filesystem::path& target,
                                  const Progress& progress = {});

  /// Where the files of such a save would be put. Errors: the same, but those of writing.
  static Result<std::vector<std::filesystem::path>> targets(const Deck& deck, const Model& original, const Model& model,
                                                            const std::filesystem::path& target);

  const SaveReport& report() const { return report_; }
  void add_note(std::string note) { report_.notes.push_back(std::move(note)); }
  const Rounding& rounding() const { return rounding_; }
  const std::vector<File>& files() const { return files_; }
  /// The same files, with their places.
  const std::vector<StagedFiles::File>& places() const { return staged_.files(); }
  bool has_begun() const { return staged_.in_place() > 0; }  ///< to replace files
  /// Leaves on disk what isn't in place yet: whoever finishes the save later needs it.
  void leave() { staged_.leave(); }

  /// Reads the deck as it will be once the files are in place. Of a save in place. Errors: those of opening.
  Result<OpenedDeck> open(const Progress& progress = {}) const;
  /// Replaces the files; after an error it may be called again and goes on. Errors: those of StagedFiles::put_in_place.
  Result<void> put_in_place();
  /// After an error: gives the files that were replaced what they held before. Of a save in place. Errors: a file can't be written, or
  /// isn't what this has written.
  Result<void> take_back();

 private:
  void remember_written();

  const Deck* deck_ = nullptr;
  bool in_place_ = false;
  SaveReport report_;
  Rounding rounding_;
  std::vector<File> files_;
  StagedFiles staged_;
};

}  // namespace prismesh::mesh::deck
