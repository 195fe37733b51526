// The files of a deck, each read once, whatever names lead to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

inline constexpr int kMaxIncludeDepth = 64;

class FileSet {
 public:
  static constexpr std::uint32_t kNoFile = 0xffffffffu;

  /// Reads the main file. Where a file has a stand-in (StagedSave), that is read under the file's name. Errors: it can't be read or
  /// unpacked, cancelled.
  static Result<FileSet> begin(std::filesystem::path main, const StandIns& stand_ins, const Progress& progress);
  /// The same with nothing but the main file, for another walk over it.
  static FileSet again(FileSet files);

  /// The file that an include in file `from` names, looked for in the folders in their order (an absolute name: only there), with
  /// backslashes as slashes where that helps; read now if it wasn't before. kNoFile with a reason ("isn't there") if it can't be had;
  /// its name is then in `missing`.
  std::uint32_t include(std::uint32_t from, const std::string& name, std::span<const std::filesystem::path> folders, std::string& reason);

  std::filesystem::path folder_of(std::uint32_t file) const { return files[file].path.parent_path(); }

  std::vector<SourceFile> files;     ///< main file first, includes in the order they are first named
  std::vector<std::string> missing;  ///< names of includes that weren't found, as written

 private:
  FileSet(std::filesystem::path main, FileBytes bytes, StandIns stand_ins);
  std::uint32_t open(const std::filesystem::path& found, const std::string& name, std::string& reason);

  StandIns stand_ins_;
  std::filesystem::path main_folder_;
  std::map<std::string, std::uint32_t> by_canonical_;
  std::map<std::pair<std::uint32_t, std::string>, std::pair<std::uint32_t, std::string>> known_;  ///< file or reason, by who names it
};

/// One name for a file, whatever links lead to it: what StandIns go by.
std::string canonical_name(const std::filesystem::path& path);

/// What is known of how a file is used: how often, and what it includes itself.
struct FileUse {
  int uses = 0;
  std::vector<std::uint32_t> includes;
};

/// Whether each file's content stands for more than one place: it is used more than once, or something that includes it is.
std::vector<bool> repeated_files(std::span<const FileUse* const> uses);

}  // namespace prismesh::mesh::deck
