// A save in two steps: files are written and flushed beside their targets first, and put in place later. In between, the caller can prepare
// and keep what follows from the save.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/hash.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save_record.h"
#include "mesh/deck/save_report.h"

namespace prismesh::mesh::deck {

class StagedSave {
 public:
  struct File {
    std::size_t index = 0;  ///< in Deck::files; from its size on, in Deck::companions
    Hash128 before;         ///< content of the file that will be replaced; zero: there is none
    Hash128 after;
    bool as_read = false;               ///< the save gives the file the content that was read
    std::optional<FileIdentity> found;  ///< of the file that will be replaced, before anything was written; nothing: there is none
  };

  /// The first step of save (mesh/deck/save.h): everything but replacing files. Before it, a save of the target that was cut off is
  /// settled. The deck must outlive this. Errors: those of save and of `make_text`.
  static Result<StagedSave> write(const Deck& deck, const Model& original, const Model& model, const std::filesystem::path& target,
                                  const Progress& progress = {}, const TextMaker& make_text = text_changes);

  /// The paths that such a save would write. Errors: those of save, without those of writing.
  static Result<std::vector<std::filesystem::path>> targets(const Deck& deck, const Model& original, const Model& model,
                                                            const std::filesystem::path& target, const TextMaker& make_text = text_changes);

  const SaveReport& report() const { return report_; }
  void add_note(std::string note) { report_.notes.push_back(std::move(note)); }
  const Rounding& rounding() const { return text_.rounding; }
  const std::vector<File>& files() const { return files_; }
  /// The same files, with their places.
  const std::vector<StagedFiles::File>& places() const { return staged_.files(); }
  bool has_begun() const { return staged_.in_place() > 0; }  ///< to replace files
  /// Keeps the files that aren't in place yet on disk, with the record of the save, so that it can be finished later.
  void leave();

  /// The files that aren't in place yet, by the paths of those that they will replace.
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> waiting() const;
  /// Opens the deck as it will be once the files are in place. Only for a save to the deck's own path. Errors: those of open.
  Result<OpenedDeck> open(const Progress& progress = {}) const;
  /// The deck as `open` would give it, without reading it: only if some nodes' coordinates are all that changes and no card gets longer or
  /// shorter. The nodes' places are read from their new cards. `original`, `model`: those of `write`. Only for a save to the deck's own
  /// path.
  std::optional<OpenedDeck> with_moved_nodes(const Model& original, const Model& model) const;
  /// Tells a deck that `open` or `with_moved_nodes` gave that its files are in place, so that the next save needn't read them to know them.
  void tell_in_place(const Deck& saved) const;
  /// Replaces the files. While there are several, a record of the save is beside the main file. After an error, another call continues.
  /// Errors: those of StagedFiles::put_in_place and of SaveRecord::begin; another program has written one of the files since the save
  /// began, which is checked before the first is replaced, and again right before each.
  Result<void> put_in_place();
  /// Replaces the files. After an error the replaced files are given back what they held; where that can't be, the rest and the record of
  /// the save stay on disk, and the next opening of the deck finishes it. Errors: those of put_in_place.
  Result<void> put_in_place_or_leave();
  /// After an error of put_in_place: restores the files that were replaced. Only for a save to the deck's own path. Errors: a file can't be
  /// written, or isn't the one that this save wrote.
  Result<void> take_back();

 private:
  void remember_written();
  Result<void> begin_record();
  Result<void> check_all() const;
  Result<void> check_target(std::size_t at) const;

  const Deck* deck_ = nullptr;
  std::filesystem::path target_;
  bool in_place_ = false;
  SaveReport report_;
  TextChanges text_;
  std::vector<File> files_;
  StagedFiles staged_;
  std::optional<SaveRecord> record_;  ///< while files are replaced
};

}  // namespace prismesh::mesh::deck
