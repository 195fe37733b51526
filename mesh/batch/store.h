// The folder of a study's results. Each result appears whole or not at all, and is never replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/error.h"
#include "mesh/batch/result.h"

namespace prismesh::mesh::batch {

/// A folder in which one process works one variant; it goes, with all that is in it, when this object does, unless it was accepted. It is
/// locked for as long.
class WorkFolder {
 public:
  WorkFolder(WorkFolder&& other) noexcept;
  WorkFolder& operator=(WorkFolder&&) = delete;
  ~WorkFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  friend class Store;
  WorkFolder(std::filesystem::path path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  std::filesystem::path path_;  ///< empty: nothing to remove
  int descriptor_ = -1;         ///< holds the lock; -1: moved from
};

class Store {
 public:
  explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path folder_of(const std::string& key) const { return folder_ / "variants" / key; }
  bool has(const std::string& key) const;
  /// Errors: there is none; it can't be read; its deck is gone.
  Result<VariantResult> result_of(const std::string& key) const;
  /// Moves a result that can't be used into the folder `damaged`, so that the variant is worked again. Errors: the disk's.
  Result<void> set_aside(const std::string& key) const;

  /// Makes a folder for work on a variant, on the file system of the results. Errors: it can't be made.
  Result<WorkFolder> begin(const std::string& key) const;
  /// Writes the result beside what is in the folder, flushes everything to disk and gives the folder its final name. False: another process
  /// has been first, its result stays, and this one goes. Errors: the disk's.
  Result<bool> accept(WorkFolder folder, const VariantResult& result) const;
  /// Keeps why a variant has no result, for people; a result removes it. Errors: the disk's.
  Result<void> note(const Failure& failure) const;
  /// Before another try.
  void forget_failure(const std::string& key) const;
  std::optional<Failure> failure_of(const std::string& key) const;
  /// Removes folders of work that processes of this machine left when they were killed. Returns how many.
  std::size_t remove_left_work() const;
  /// Removes the folder of work that one process of this machine, which has ended, left of one variant. Lists nothing.
  void remove_work(const std::string& key, std::int64_t process) const;

 private:
  std::filesystem::path work_folder(const std::string& key, std::int64_t process) const;
  std::filesystem::path failure_file(const std::string& key) const { return folder_ / "failed" / (key + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace prismesh::mesh::batch
