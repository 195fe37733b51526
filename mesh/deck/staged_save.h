// A save in two steps: files are written and flushed beside their targets first, and put in place later. In between, the caller can prepare
// and keep what follows from the save.
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
    std::size_t index = 0;  ///< in Deck::files; from its size on, in Deck::companions
    Hash128 before;         ///< content of the file that will be replaced; empty for another path
    Hash128 after;
    bool as_read = false;  ///< the save gives the file the content that was read
  };

  /// The first step of save (mesh/deck/save.h): everything but replacing files. The deck must outlive this. Errors: those of save.
  static Result<StagedSave> write(const Deck& deck, const Model& original, const Model& model, const std::filesystem::path& target,
                                  const Progress& progress = {});

  /// The paths that such a save would write. Errors: those of save, without those of writing.
  static Result<std::vector<std::filesystem::path>> targets(const Deck& deck, const Model& original, const Model& model,
                                                            const std::filesystem::path& target);

  const SaveReport& report() const { return report_; }
  void add_note(std::string note) { report_.notes.push_back(std::move(note)); }
  const Rounding& rounding() const { return rounding_; }
  const std::vector<File>& files() const { return files_; }
  /// The same files, with their places.
  const std::vector<StagedFiles::File>& places() const { return staged_.files(); }
  bool has_begun() const { return staged_.in_place() > 0; }  ///< to replace files
  /// Keeps the files that aren't in place yet on disk, so that the save can be finished later.
  void leave() { staged_.leave(); }

  /// Opens the deck as it will be once the files are in place. Only for a save to the deck's own path. Errors: those of open.
  Result<OpenedDeck> open(const Progress& progress = {}) const;
  /// Replaces the files. After an error, another call continues. Errors: those of StagedFiles::put_in_place.
  Result<void> put_in_place();
  /// After an error of put_in_place: restores the files that were replaced. Only for a save to the deck's own path. Errors: a file can't be
  /// written, or isn't the one that this save wrote.
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
