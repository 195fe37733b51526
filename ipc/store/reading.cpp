#include "ipc/store/reading.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>

#include "ipc/store/record_text.h"

namespace prismesh::ipc::store {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr std::size_t kMaxRecordBytes = std::size_t{64} << 10;

/// Reads a file to its end, piece by piece.
template <class Take>
Result<void> for_each_piece(const Descriptor& file, const fs::path& shown, const Take& take) {
  std::string piece(kPiece, '\0');
  for (std::uint64_t offset = 0;;) {
    const Result<std::size_t> got = read_at(file, piece.data(), piece.size(), offset, shown);
    if (!got) return fail(got.error());
    if (*got == 0) return {};
    if (Result<void> taken = take(std::string_view(piece).substr(0, *got), offset); !taken) return taken;
    offset += *got;
  }
}

/// The folder that a path of a set is in, made where it is missing; the path's last part.
Result<std::pair<Folder, std::string>> folder_for(const fs::path& into, std::string_view path) {
  Result<Folder> folder = Folder::open(into);
  for (std::size_t slash = path.find('/'); folder && slash != std::string_view::npos; slash = path.find('/')) {
    folder = folder->make_folder(std::string(path.substr(0, slash)), 0700);
    path.remove_prefix(slash + 1);
  }
  if (!folder) return fail(folder.error());
  return std::pair(std::move(*folder), std::string(path));
}

}  // namespace

std::string shard_of(const ContentHash& hash) { return hash.hex().substr(0, 2); }

Result<ContentHash> hash_file(const Descriptor& file, const fs::path& shown) {
  Sha256 hash;
  const Result<void> read = for_each_piece(file, shown, [&](std::string_view piece, std::uint64_t) -> Result<void> {
    hash.add(piece);
    return {};
  });
  if (!read) return fail(read.error());
  return hash.hash();
}

Result<Reader> Reader::open(const fs::path& store) {
  Result<Folder> root = Folder::open(store);
  if (!root) return fail(root.error());
  return Reader(std::move(*root));
}

Result<Descriptor> Reader::open_content(const ContentHash& hash) const {
  const Result<Folder> damaged = root_.folder(kDamagedFolder);
  if (damaged && damaged->has(hash.hex())) return fail((root_.path() / hash.hex()).string(), "is damaged in the store; send it again");
  const Result<Folder> all = root_.folder(kContentFolder);
  if (!all) return fail(all.error());
  const Result<Folder> shard = all->folder(shard_of(hash));
  if (!shard) return fail(shard.error());
  return shard->read(hash.hex());
}

Result<std::vector<ModelRecord>> Reader::records(std::size_t limit) const {
  const Result<Folder> models = root_.folder(kModelsFolder);
  if (!models) return fail(models.error());
  const Result<std::vector<std::string>> names = models->names();
  if (!names) return fail(names.error());
  std::vector<ModelRecord> all;
  for (const std::string& name : *names) {
    const Result<std::string> text = models->content(name, kMaxRecordBytes);
    if (!text) continue;
    if (Result<ModelRecord> record = decode_record(*text, name); record && record->model.hex() == name) all.push_back(std::move(*record));
  }
  std::sort(all.begin(), all.end(),
            [](const ModelRecord& a, const ModelRecord& b) { return a.when_s != b.when_s ? a.when_s > b.when_s : a.model < b.model; });
  if (all.size() > limit) all.resize(limit);
  return all;
}

Result<FoundModel> Reader::find(const ContentHash& model) const {
  const Result<Folder> models = root_.folder(kModelsFolder);
  if (!models) return fail(models.error());
  if (!models->has(model.hex())) return fail(root_.path().string(), "holds no model " + model.hex());
  const Result<std::string> text = models->content(model.hex(), kMaxRecordBytes);
  if (!text) return fail(text.error());
  FoundModel found;
  if (Result<ModelRecord> record = decode_record(*text, (models->path() / model.hex()).string()); record)
    found.record = std::move(*record);
  else
    return fail(record.error());
  const auto damaged = [&] { return fail(root_.path().string(), "the manifest of the model " + model.hex() + " is damaged"); };
  const Result<Descriptor> file = open_content(model);
  if (!file) return fail(file.error());
  std::string manifest(kMaxManifestBytes + 1, '\0');
  const Result<std::size_t> got = read_at(*file, manifest.data(), manifest.size(), 0, root_.path());
  if (!got) return fail(got.error());
  manifest.resize(*got);
  if (found.record.model != model || model_hash(manifest) != model) return damaged();
  Result<Manifest> decoded = decode_manifest(manifest);
  if (!decoded) return damaged();
  found.manifest = std::move(*decoded);
  return found;
}

Result<Descriptor> Reader::open_file(const SetFile& file) const {
  Result<Descriptor> opened = open_content(file.hash);
  if (!opened) return fail(file.path, "can't be read from the store: " + opened.error().text());
  struct stat status {};
  if (::fstat(opened->get(), &status) != 0 || static_cast<std::uint64_t>(status.st_size) != file.bytes)
    return fail(file.path, "is damaged in the store: it has another length");
  return opened;
}

Result<void> Reader::lay_out(const Manifest& manifest, const fs::path& into, const Stop& stop) const {
  for (const SetFile& file : manifest.files) {
    if (const std::string fault = path_fault(file.path); !fault.empty()) return fail(file.path, "the path " + fault);
    const Result<Descriptor> source = open_file(file);
    if (!source) return fail(source.error());
    const Result<std::pair<Folder, std::string>> place = folder_for(into, file.path);
    if (!place) return fail(place.error());
    const Result<Descriptor> target = place->first.create(place->second);
    if (!target) return fail(target.error());
    Sha256 hash;
    const Result<void> copied = for_each_piece(*source, file.path, [&](std::string_view piece, std::uint64_t offset) -> Result<void> {
      if (stop && stop()) return fail(cancelled());
      hash.add(piece);
      return write_at(*target, piece, offset, into / file.path);
    });
    if (!copied) return copied;
    if (hash.hash() != file.hash) return fail(file.path, "is damaged in the store: its bytes aren't those that were sent");
  }
  return {};
}

}  // namespace prismesh::ipc::store
