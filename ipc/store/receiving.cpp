#include "ipc/store/receiving.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/file.h"
#include "base/progress.h"
#include "ipc/store/reading.h"
#include "ipc/wire/server.h"

namespace prismesh::ipc::store {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShownHashDigits = 8;

Result<void> check_free(const fs::path& folder) {
  std::error_code error;
  const fs::path named = folder.has_filename() ? folder : folder.parent_path();
  // Its name is given last, by renaming, which none of these can take.
  if (named.filename() == "." || named.filename() == "..") return fail(folder.string(), "is no name for a new folder; name one with -o");
  if (fs::is_symlink(fs::symlink_status(named, error))) return fail(folder.string(), "is a link; name another folder with -o");
  if (!fs::exists(fs::symlink_status(folder, error))) return {};
  if (fs::is_directory(folder, error) && fs::is_empty(folder, error) && !error) return {};
  return fail(folder.string(), "is there already; name another folder with -o");
}

/// All files and folders beneath, and the folder itself.
Result<void> flush_tree(const fs::path& folder, const Stop& stop) {
  std::error_code error;
  const auto flush = [&stop](const fs::path& path) -> Result<void> {
    if (stop && stop()) return fail(cancelled());
    const Descriptor opened(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
    if (!opened) return fail(path.string(), std::string("can't be flushed to disk: ") + std::strerror(errno));
    return flush_file(opened, path);
  };
  for (fs::recursive_directory_iterator each(folder, error), end; !error && each != end; each.increment(error))
    if (const Result<void> flushed = flush(each->path()); !flushed) return flushed;
  if (error) return fail(folder.string(), "can't be flushed to disk: " + error.message());
  return flush(folder);
}

}  // namespace

std::string usual_folder(const Manifest& manifest, const ContentHash& model) {
  std::string stem = fs::path(manifest.main).filename().stem().string();
  if (stem.empty() || stem.front() == '.' || stem.front() == '-') stem = "model";
  return stem + "-" + model.hex().substr(0, kShownHashDigits);
}

Result<Receiving> Receiving::begin(fs::path folder, const std::string& ending) {
  if (const Result<void> is_free = check_free(folder); !is_free) return fail(is_free.error());
  fs::path unfinished = folder.has_filename() ? folder : folder.parent_path();
  unfinished += ending;
  if (const Result<void> made = make_private_folder(unfinished, false); !made) return fail(made.error());
  Result<Descriptor> lock = lock_folder(unfinished, "lock", "another prismesh that fetches");
  if (!lock) return fail(lock.error());
  const Result<Folder> root = Folder::open(unfinished);
  if (!root) return fail(root.error());
  Result<Folder> content = root->make_folder(kContentFolder, 0700);
  if (!content) return fail(content.error());
  return Receiving(std::move(folder), std::move(unfinished), std::move(*lock), std::move(*content));
}

Result<ReceivedFile> Receiving::file(const ContentHash& hash) const {
  const Result<Folder> shard = content_.make_folder(shard_of(hash), 0700);
  if (!shard) return fail(shard.error());
  const std::string name = hash.hex();
  const bool is_begun = shard->has(name);
  Result<Descriptor> disk = is_begun ? shard->read_and_write(name) : shard->create(name, 0600);
  if (!disk) return fail(disk.error());
  return ReceivedFile{std::move(*disk), shard->path() / name, is_begun};
}

Result<void> Receiving::finish(const Manifest& manifest, const Stop& stop) const {
  const Result<Reader> reader = Reader::open(unfinished_);
  if (!reader) return fail(reader.error());
  const fs::path whole = unfinished_ / "whole";
  std::error_code error;
  fs::remove_all(whole, error);
  fs::create_directory(whole, error);
  if (error) return fail(whole.string(), "can't be made: " + error.message());
  if (const Result<void> laid_out = reader->lay_out(manifest, whole, stop); !laid_out) return laid_out;
  fs::permissions(
      whole, fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec, error);
  if (const Result<void> flushed = flush_tree(whole, stop); !flushed) return flushed;
  fs::rename(whole, folder_, error);
  if (error) return fail(folder_.string(), "can't be made: " + error.message());
  const fs::path named = folder_.has_filename() ? folder_ : folder_.parent_path();
  if (const Result<void> flushed = flush_folder(folder_of(named), named); !flushed) return flushed;
  fs::remove_all(unfinished_, error);
  return {};
}

}  // namespace prismesh::ipc::store
