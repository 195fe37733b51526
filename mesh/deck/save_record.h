// The record of a save that replaces several files, beside the deck's main file (".NAME.saving"). Files can't be replaced together: where
// the program ends in between, whoever opens the deck next finishes the save from this record, or says that it can't be finished.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// A file that a save replaces, and the new one that waits beside it.
struct ReplacedFile {
  std::filesystem::path target, temporary;
  Hash128 before;  ///< content of the target; zero: there is no file
  Hash128 after;   ///< content of the temporary file
};

enum class SaveOutcome : std::uint8_t {
  not_begun,  ///< no file was replaced
  complete,   ///< every file was replaced
  finished,   ///< some files were missing; they have been replaced now
  mixed,      ///< some files were replaced; the others were changed or removed by something else and can't be
};

/// The content of a file; zero: there is none; nothing: it can't be read.
std::optional<Hash128> content_now(const std::filesystem::path& file);

/// Compares the files with the record and finishes a save that was cut off between them. Uses only temporary files whose content has the
/// recorded hash. The temporary files stay. Errors: a file can't be replaced; then another call continues.
Result<SaveOutcome> finish_replacing(std::span<const ReplacedFile> files);

/// Keeps a record on disk while files are replaced, locked against other programs. The destructor unlocks it and leaves it there.
class SaveRecord {
 public:
  /// Where the record of a deck is. `deck`: its main file.
  static std::filesystem::path place_of(const std::filesystem::path& deck);
  /// Writes and flushes the record. One of an earlier save that couldn't be finished is removed. Errors: it can't be written; another
  /// program is saving the deck.
  static Result<SaveRecord> begin(const std::filesystem::path& deck, std::span<const ReplacedFile> files);
  /// Locks the record of a save that was cut off, if there is one. Waits a few seconds for one that is under way. Errors: that takes
  /// longer.
  static Result<SaveRecord> of_cut_off_save(const std::filesystem::path& deck);
  bool is_there() const { return fd_ >= 0; }
  /// Removes a record of an earlier save that couldn't be finished, if there is one. Errors: another program is saving the deck.
  static Result<void> remove_earlier(const std::filesystem::path& deck);

  SaveRecord(SaveRecord&& other) noexcept;
  SaveRecord& operator=(SaveRecord&& other) noexcept;
  ~SaveRecord();

  /// Removes the record and flushes its folder.
  void end();

 private:
  SaveRecord(std::filesystem::path path, int fd) : path_(std::move(path)), fd_(fd) {}

  std::filesystem::path path_;
  int fd_ = -1;
};

/// What was found of a save that was cut off.
struct CutOffSave {
  std::optional<SaveOutcome> outcome;  ///< nothing: there was none, or it is unknown what became of it
  std::vector<Warning> warnings;
  StandIns stand_ins;  ///< where the save can't be finished: the files that wait, so that the deck is read as it was saved
};

/// Settles a save of this deck that was cut off: finishes it, or removes what it has written if it hadn't begun. A record that is damaged
/// is moved aside. Where files have been changed since, or lie outside the main file's folder, nothing is touched, and the record stays
/// until the deck is saved. Errors: another program is saving the deck just now.
Result<CutOffSave> settle_cut_off_save(const std::filesystem::path& deck);

}  // namespace prismesh::mesh::deck
