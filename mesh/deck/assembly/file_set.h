// Reads the files of a deck, each once, whatever names lead to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/assembly/bounded_files.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

inline constexpr int kMaxIncludeDepth = 64;

class FileSet {
 public:
  static constexpr std::uint32_t kNoFile = 0xffffffffu;

  /// Reads the main file. Where a file has a stand-in (StagedSave), the stand-in is read under the file's name. `reading` must outlive
  /// the set. Errors: the file can't be read or unpacked, a limit is exceeded, cancelled.
  static Result<FileSet> begin(std::filesystem::path main, BoundedFiles& reading, const StandIns& stand_ins, const Progress& progress);
  /// Keeps the main file only, for another walk over the deck.
  static FileSet again(FileSet files);

  /// Finds the file that an include in file `from` names: in the folders, in their order, or at its absolute name; with backslashes as
  /// slashes if it isn't found otherwise. Reads it if it wasn't read before. kNoFile: it can't be found or read; `reason` gets why ("isn't
  /// there") and `missing` the name.
  std::uint32_t include(std::uint32_t from, const std::string& name, std::span<const std::filesystem::path> folders, std::string& reason);

  /// As include, for a file that `keyword` names and whose text isn't read (Deck::unread_files): it belongs to the deck all the same.
  std::uint32_t include_unread(std::uint32_t from, const std::string& name, std::span<const std::filesystem::path> folders,
                               const std::string& keyword, std::string& reason);
  /// Notes a companion file (Deck::companions). False: it can't be found; `reason` gets why.
  bool accompany(const std::string& name, std::span<const std::filesystem::path> folders, std::string& reason);

  std::filesystem::path folder_of(std::uint32_t file) const { return files[file].path.parent_path(); }

  std::vector<SourceFile> files;          ///< main file first, includes in the order they are first named
  std::vector<std::string> missing;       ///< names of includes that weren't found, as written
  std::vector<UnreadFile> unread;         ///< each once
  std::vector<CompanionFile> companions;  ///< each once

 private:
  FileSet(std::filesystem::path main, FileBytes bytes, BoundedFiles& reading, StandIns stand_ins);
  std::optional<std::filesystem::path> find(const std::string& name, std::span<const std::filesystem::path> folders,
                                            std::string& reason) const;
  std::filesystem::path relative_name(const std::filesystem::path& found, const std::string& name) const;
  std::uint32_t open(const std::filesystem::path& found, const std::string& name, std::string& reason);

  BoundedFiles* reading_;  ///< never null
  StandIns stand_ins_;
  std::filesystem::path main_folder_;
  std::map<std::string, std::uint32_t> by_canonical_;
  std::set<std::string> accompanying_;                                                            ///< canonical names of companions
  std::map<std::pair<std::uint32_t, std::string>, std::pair<std::uint32_t, std::string>> known_;  ///< file or reason, by who names it
};

/// One name for a file, whatever links lead to it. The key of StandIns.
std::string canonical_name(const std::filesystem::path& path);

/// How often a file is used, and what it includes itself.
struct FileUse {
  int uses = 0;
  std::vector<std::uint32_t> includes;
};

/// By file: whether its content stands for more than one place. True: it, or a file that includes it, is used more than once.
std::vector<bool> repeated_files(std::span<const FileUse* const> uses);

}  // namespace prismesh::mesh::deck
