#include "mesh/batch/store.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/file.h"
#include "mesh/batch/records.h"

namespace prismesh::mesh::batch {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kWork = "work-";

std::string machine() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string text = name.data();
  for (char& c : text)
    if (c == '-' || c == '/') c = '_';
  return text;
}

/// Flushes a file or a folder.
Result<void> flush(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return fail(path.string(), std::string("can't be opened to be flushed: ") + std::strerror(errno));
  const int failed = fsync(descriptor) != 0 ? errno : 0;
  close(descriptor);
  if (failed != 0) return fail(path.string(), std::string("can't be flushed to disk: ") + std::strerror(failed));
  return {};
}

Result<void> flush_all_in(const fs::path& folder) {
  std::error_code failed;
  std::vector<fs::path> all{folder};
  for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) all.push_back(it->path());
  if (failed) return fail(folder.string(), "can't be listed: " + failed.message());
  for (const fs::path& each : all)
    if (Result<void> done = flush(each); !done) return done;
  return {};
}

}  // namespace

WorkFolder::WorkFolder(WorkFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), descriptor_(std::exchange(other.descriptor_, -1)) {}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (descriptor_ >= 0) close(descriptor_);
}

bool Store::has(const std::string& key) const {
  std::error_code failed;
  return fs::exists(folder_of(key) / "result.json", failed);
}

Result<VariantResult> Store::result_of(const std::string& key) const {
  Result<VariantResult> result = read_result(folder_of(key) / "result.json");
  std::error_code failed;
  if (result && !result->written.empty() && !fs::is_regular_file(folder_of(key) / result->written, failed))
    return fail((folder_of(key) / result->written).string(), "the variant's deck is gone");
  return result;
}

Result<void> Store::set_aside(const std::string& key) const {
  const fs::path target = folder_ / "damaged" / key;
  if (Result<void> made = make_folders(target.parent_path()); !made) return made;
  std::error_code failed;
  fs::remove_all(target, failed);
  fs::rename(folder_of(key), target, failed);
  if (failed) return fail(folder_of(key).string(), "this damaged result can't be moved out of the way: " + failed.message());
  return {};
}

fs::path Store::work_folder(const std::string& key, std::int64_t process) const {
  return folder_ / "variants" / (std::string(kWork) + key + "-" + machine() + "-" + std::to_string(process));
}

Result<WorkFolder> Store::begin(const std::string& key) const {
  const fs::path variants = folder_ / "variants";
  if (Result<void> made = make_folders(variants); !made) return fail(made.error());
  const fs::path path = work_folder(key, getpid());
  std::error_code failed;
  fs::remove_all(path, failed);  // of a process that had our number
  if (!fs::create_directory(path, failed) || failed) return fail(path.string(), "can't be made: " + failed.message());
  // tells remove_left_work() that somebody works there; where folders can't be locked, nobody removes it
  const int descriptor = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return fail(path.string(), std::string("can't be opened: ") + std::strerror(errno));
  [[maybe_unused]] const int locked = flock(descriptor, LOCK_EX | LOCK_NB);
  return WorkFolder(path, descriptor);
}

Result<bool> Store::accept(WorkFolder folder, const VariantResult& result) const {
  const std::string text = result_json(result);
  const PendingFile file{folder.path() / "result.json", {text}};
  if (Result<void> written = replace_files({&file, 1}); !written) return fail(written.error());
  if (Result<void> done = flush_all_in(folder.path()); !done) return fail(done.error());
  const fs::path target = folder_of(result.key);
  // a folder never takes the place of one that holds something, so the first result stays
  if (std::rename(folder.path().c_str(), target.c_str()) != 0) {
    if (errno == EEXIST || errno == ENOTEMPTY) return false;
    return fail(target.string(), std::string("the result can't be put in place: ") + std::strerror(errno));
  }
  folder.path_.clear();
  if (Result<void> done = flush(target.parent_path()); !done) return fail(done.error());
  forget_failure(result.key);
  return true;
}

Result<void> Store::note(const Failure& failure) const {
  const fs::path target = failure_file(failure.key);
  if (Result<void> made = make_folders(target.parent_path()); !made) return made;
  const std::string text = failure_json(failure);
  const PendingFile file{target, {text}};
  return replace_files({&file, 1});
}

void Store::forget_failure(const std::string& key) const {
  std::error_code ignored;
  fs::remove(failure_file(key), ignored);
}

std::optional<Failure> Store::failure_of(const std::string& key) const {
  std::error_code failed;
  if (!fs::exists(failure_file(key), failed)) return std::nullopt;
  Result<Failure> read = read_failure(failure_file(key));
  if (!read) return Failure{key, read.error().text(), 0};
  return *read;
}

void Store::remove_work(const std::string& key, std::int64_t process) const {
  std::error_code ignored;
  fs::remove_all(work_folder(key, process), ignored);
}

std::size_t Store::remove_left_work() const {
  std::size_t removed = 0;
  std::error_code failed;
  const std::string here = machine();
  for (fs::directory_iterator it(folder_ / "variants", failed), end; !failed && it != end; it.increment(failed)) {
    const std::string name = it->path().filename().string();
    const std::size_t dash = name.rfind('-'), before = dash == std::string::npos ? dash : name.rfind('-', dash - 1);
    if (!name.starts_with(kWork) || before == std::string::npos || name.substr(before + 1, dash - before - 1) != here) continue;
    const int descriptor = open(it->path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) continue;
    const bool is_left = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    close(descriptor);
    if (!is_left) continue;
    std::error_code ignored;
    fs::remove_all(it->path(), ignored);
    ++removed;
  }
  return removed;
}

}  // namespace prismesh::mesh::batch
