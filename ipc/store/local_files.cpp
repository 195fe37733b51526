#include "ipc/store/local_files.h"

#include <algorithm>
#include <set>

#include <fcntl.h>
#include <sys/stat.h>

#include "base/progress.h"
#include "ipc/store/folder.h"

namespace prismesh::ipc::store {

namespace {

/// Another name or other rights make no other version.
bool is_same_version(const FileIdentity& a, const FileIdentity& b) {
  return a.device == b.device && a.inode == b.inode && a.size == b.size && a.modified_ns == b.modified_ns;
}

}  // namespace

Result<OpenedFile> open_local(const std::filesystem::path& path) {
  OpenedFile opened{Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC)), 0};
  struct stat status {};
  if (!opened.file || ::fstat(opened.file.get(), &status) != 0) return fail(path.string(), "can't be read");
  if (!S_ISREG(status.st_mode)) return fail(path.string(), "is no file");
  opened.bytes = static_cast<std::uint64_t>(status.st_size);
  return opened;
}

Result<LocalSet> hash_local(const std::vector<LocalFile>& files, const std::string& main, const std::function<bool()>& told,
                            const std::function<void(std::size_t, std::string_view)>& seen) {
  LocalSet set;
  set.manifest.main = main;
  std::set<ContentHash> known;
  std::string piece(kLocalPiece, '\0');
  for (std::size_t which = 0; which < files.size(); ++which) {
    const LocalFile& file = files[which];
    const Result<OpenedFile> opened = open_local(file.disk);
    if (!opened) return fail(opened.error());
    Sha256 sum;
    std::uint64_t at = 0;
    for (;;) {
      const Result<std::size_t> got = read_at(opened->file, piece.data(), piece.size(), at, file.disk);
      if (!got) return fail(got.error());
      if (!told()) return fail(cancelled());
      const std::string_view bytes(piece.data(), *got);
      sum.add(bytes);
      if (seen && !bytes.empty()) seen(which, bytes);
      at += *got;
      if (*got < piece.size()) break;
    }
    // The deck's other files are known from what was read, so nothing of another version may come beside them.
    if (file.as_read) {
      const Result<FileIdentity> now = identify_file(file.disk);
      if (!now || !is_same_version(*now, *file.as_read)) return fail(file.disk.string(), "changed while it was read; push it again");
    }
    set.manifest.files.push_back({sum.hash(), at, file.path});
    if (known.insert(sum.hash()).second) set.contents.push_back({file.disk, set.manifest.files.back()});
  }
  std::sort(set.manifest.files.begin(), set.manifest.files.end(), [](const SetFile& a, const SetFile& b) { return a.path < b.path; });
  set.text = encode_manifest(set.manifest);
  if (const Result<Manifest> sound = decode_manifest(set.text); !sound) return fail(main, "can't be a model: " + sound.error().message);
  return set;
}

}  // namespace prismesh::ipc::store
