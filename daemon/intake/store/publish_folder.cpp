#include "daemon/intake/store/publish_folder.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace prismesh::intake {

namespace {

using ipc::store::Folder;
using ipc::store::SetFile;

constexpr std::size_t kCopiedAtOnce = std::size_t{1} << 20;

/// Beneath the folder, part by part.
Result<ipc::Descriptor> open_beneath(const Folder& root, std::string_view path) {
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos) return root.read(std::string(path));
  const Result<Folder> inner = root.folder(std::string(path.substr(0, slash)));
  if (!inner) return fail(inner.error());
  return open_beneath(*inner, path.substr(slash + 1));
}

/// Sends a file into the store as an upload. Returns its size and hash as it was read.
Outcome<SetFile> take_in(Store& store, const ipc::Descriptor& file, const std::filesystem::path& shown, const EditedFolder& edited,
                         const SetFile& was) {
  const Result<ipc::store::ContentHash> hash = ipc::store::hash_file(file, shown);
  if (!hash) return disk_refusal(hash.error());
  if (*hash == was.hash) return was;
  std::string piece(kCopiedAtOnce, '\0');
  std::uint64_t size = 0;
  for (;;) {
    const Result<std::size_t> got = ipc::store::read_at(file, piece.data(), piece.size(), size, shown);
    if (!got) return disk_refusal(got.error());
    if (*got == 0) break;
    size += *got;
  }
  const Outcome<UploadStatus> upload = store.begin_upload({edited.who, size, "", *hash});
  if (!upload) return tl::unexpected(upload.error());
  const auto give_up = [&](const Refused& why) {
    (void)store.uploads().terminate(edited.who, upload->id);
    return tl::unexpected(why);
  };
  const Outcome<std::uint64_t> chunk = store.uploads().begin_chunk(edited.who, upload->id, 0, std::nullopt);
  if (!chunk) return give_up(chunk.error());
  for (std::uint64_t at = 0; at < size;) {
    const Result<std::size_t> got = ipc::store::read_at(file, piece.data(), std::min<std::uint64_t>(piece.size(), size - at), at, shown);
    if (!got || *got == 0)
      return give_up({Refusal::failed, got ? Error{shown.string(), 0, "became shorter while it was read"} : got.error()});
    if (const Outcome<void> added = store.uploads().add(upload->id, *chunk, std::string_view(piece).substr(0, *got)); !added)
      return give_up(added.error());
    at += *got;
  }
  // A file that another program changed meanwhile has another hash than was announced.
  if (const Outcome<UploadStatus> ended = store.uploads().end_chunk(upload->id, *chunk); !ended) return tl::unexpected(ended.error());
  return SetFile{*hash, size, was.path};
}

}  // namespace

Outcome<ipc::store::ModelRecord> publish_folder(Store& store, const EditedFolder& edited) {
  const Outcome<ipc::store::FoundModel> origin = store.find(edited.derived_from);
  if (!origin) return tl::unexpected(origin.error());
  const Result<Folder> root = Folder::open(edited.folder);
  if (!root) return disk_refusal(root.error());
  ipc::store::Manifest manifest = origin->manifest;
  for (SetFile& file : manifest.files) {
    const std::filesystem::path shown = edited.folder / file.path;
    const Result<ipc::Descriptor> opened = open_beneath(*root, file.path);
    if (!opened) return refuse(Refusal::missing, opened.error());
    Outcome<SetFile> taken = take_in(store, *opened, shown, edited, file);
    if (!taken) return tl::unexpected(taken.error());
    file = std::move(*taken);
  }
  const std::string text = ipc::store::encode_manifest(manifest);
  if (ipc::store::model_hash(text) == edited.derived_from) return origin->record;
  return store.publish({edited.who, text, origin->record.name, edited.derived_from, true, edited.when_s});
}

}  // namespace prismesh::intake
