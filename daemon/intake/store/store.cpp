#include "daemon/intake/store/store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "base/file.h"
#include "base/log.h"
#include "ipc/store/record_text.h"
#include "ipc/store/utf8.h"

namespace prismesh::intake {

namespace {

namespace fs = std::filesystem;
using ipc::store::ContentHash;
using ipc::store::Folder;
using ipc::store::FoundModel;
using ipc::store::Manifest;
using ipc::store::ModelRecord;
using ipc::store::SetFile;

constexpr const char* kIncomingFolder = "incoming";
constexpr const char* kCatalogueFile = "catalogue.sqlite";
constexpr std::size_t kMaxPictureBytes = std::size_t{4} << 20;
constexpr mode_t kReadableMode = 0750;  // the group reads models
constexpr mode_t kPrivateMode = 0700;

/// Held as long as the process lives: two that take up what was left would remove each other's.
Result<ipc::Descriptor> lock_store(const Folder& root) {
  ipc::Descriptor lock(::openat(root.descriptor(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!lock || ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0)
    return fail(root.path().string(), errno == EWOULDBLOCK ? std::string("another process has this store")
                                                           : "can't be locked: " + std::generic_category().message(errno));
  return lock;
}

std::string last_part(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// Each content that a model needs, its manifest and thumbnail among them, once.
std::set<ContentHash> contents_of(const ModelRecord& record, const Manifest& manifest) {
  std::set<ContentHash> all{record.model};
  for (const SetFile& file : manifest.files) all.insert(file.hash);
  if (record.thumbnail) all.insert(*record.thumbnail);
  return all;
}

}  // namespace

Store::Store(ipc::Descriptor lock, Folder content, Folder models, Folder damaged, ipc::store::Reader reader, Uploads uploads,
             Catalogue catalogue, const StoreLimits& limits)
    : lock_(std::move(lock)),
      content_(std::move(content)),
      models_(std::move(models)),
      damaged_folder_(std::move(damaged)),
      reader_(std::move(reader)),
      uploads_(std::move(uploads)),
      catalogue_(std::move(catalogue)),
      limits_(limits) {}

Result<Store> Store::open(const fs::path& path, const StoreLimits& limits, Clock& clock, Randomness randomness,
                          std::vector<std::string>& notes) {
  if (const Result<void> made = make_folders(path); !made) return fail(made.error());
  Result<Folder> root = Folder::open(path);
  if (!root) return fail(root.error());
  Result<ipc::Descriptor> lock = lock_store(*root);
  if (!lock) return fail(lock.error());
  Result<Folder> content = root->make_folder(ipc::store::kContentFolder, kReadableMode);
  Result<Folder> models = root->make_folder(ipc::store::kModelsFolder, kReadableMode);
  Result<Folder> damaged = root->make_folder(ipc::store::kDamagedFolder, kReadableMode);
  Result<Folder> incoming = root->make_folder(kIncomingFolder, kPrivateMode);
  for (const Result<Folder>* each : {&content, &models, &damaged, &incoming})
    if (!*each) return fail(each->error());
  if (const Result<void> flushed = root->flush(); !flushed) return fail(flushed.error());
  Result<ipc::store::Reader> reader = ipc::store::Reader::open(path);
  if (!reader) return fail(reader.error());
  Result<Uploads> uploads = Uploads::open(std::move(*incoming), limits, clock, std::move(randomness), notes);
  if (!uploads) return fail(uploads.error());
  Result<Catalogue> catalogue = Catalogue::open(path / kCatalogueFile, notes);
  if (!catalogue) return fail(catalogue.error());
  Store store(std::move(*lock), std::move(*content), std::move(*models), std::move(*damaged), std::move(*reader), std::move(*uploads),
              std::move(*catalogue), limits);
  if (const Result<void> taken = store.take_up(notes); !taken) return fail(taken.error());
  return store;
}

Result<void> Store::take_up(std::vector<std::string>& notes) {
  const Result<std::vector<std::string>> marks = damaged_folder_.names();
  if (!marks) return fail(marks.error());
  for (const std::string& name : *marks)
    if (const auto hash = ipc::store::parse_content_hash(name)) damaged_.insert(*hash);
  const Result<std::vector<std::string>> names = models_.names();
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    const auto hash = ipc::store::parse_content_hash(name);
    if (!hash) {  // a record that was being written
      if (const Result<void> removed = models_.remove(name); !removed) notes.push_back(removed.error().text());
      continue;
    }
    const Result<FoundModel> found = reader_.find(*hash);
    if (!found) {
      notes.push_back(found.error().text());
      damaged_models_.insert(*hash);
      continue;
    }
    for (const ContentHash& content : contents_of(found->record, found->manifest)) ++references_[content];
    for (const SetFile& file : found->manifest.files)
      if (!has_content(file.hash, file.bytes)) {
        notes.push_back("'" + file.path + "' of the model " + hash->hex() + " is missing or damaged");
        mark_damaged(file.hash);
      }
  }
  collect_orphans(notes);
  return rebuild_catalogue();
}

/// Removes content that belongs to no model: a publication that didn't come to its end.
void Store::collect_orphans(std::vector<std::string>& notes) {
  if (!damaged_models_.empty()) return;
  const Result<std::vector<std::string>> shards = content_.names();
  if (!shards) return;
  for (const std::string& shard : *shards) {
    const Result<Folder> folder = content_.folder(shard);
    const Result<std::vector<std::string>> names = folder ? folder->names() : tl::unexpected(folder.error());
    if (!names) {
      notes.push_back(names.error().text());
      continue;
    }
    for (const std::string& name : *names) {
      const auto hash = ipc::store::parse_content_hash(name);
      if (hash && references_.contains(*hash)) continue;
      if (const Result<void> removed = folder->remove(name); !removed) notes.push_back(removed.error().text());
    }
  }
}

bool Store::is_damaged(const Manifest& manifest) const {
  return std::any_of(manifest.files.begin(), manifest.files.end(), [&](const SetFile& file) { return damaged_.contains(file.hash); });
}

Result<void> Store::rebuild_catalogue() {
  const Result<std::vector<std::string>> names = models_.names();
  if (!names) return fail(names.error());
  std::vector<CatalogueEntry> entries;
  for (const std::string& name : *names) {
    const auto hash = ipc::store::parse_content_hash(name);
    if (!hash) continue;
    if (const Result<FoundModel> found = reader_.find(*hash)) entries.push_back({found->record, is_damaged(found->manifest)});
  }
  Result<void> filled = catalogue_.fill(entries);
  catalogue_is_behind_ = !filled;
  return filled;
}

bool Store::has_content(const ContentHash& hash, std::uint64_t bytes) const {
  if (damaged_.contains(hash)) return false;
  const Result<Folder> shard = content_.folder(ipc::store::shard_of(hash));
  if (!shard) return false;
  const Result<std::uint64_t> size = shard->size_of(hash.hex());
  return size && *size == bytes;
}

// --- room ---

std::uint64_t Store::free_bytes() const {
  struct statvfs status {};
  if (::fstatvfs(content_.descriptor(), &status) != 0) return 0;
  const std::uint64_t free = static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
  const std::uint64_t taken = limits_.reserved_bytes + uploads_.missing_bytes();
  return free > taken ? free - taken : 0;
}

Outcome<void> Store::check_room(const std::string& who, std::uint64_t bytes) const {
  const Result<std::uint64_t> models = catalogue_.bytes_of(who);
  if (!models) return disk_refusal(models.error());
  const std::uint64_t used = *models + uploads_.announced_bytes(who);
  if (bytes > limits_.quota_bytes || used > limits_.quota_bytes - bytes)
    return refuse(Refusal::over_quota, "quota",
                  "this token may store " + std::to_string(limits_.quota_bytes) + " bytes and has " + std::to_string(used));
  if (bytes > free_bytes())
    return refuse(Refusal::no_space, reader_.path().string(),
                  "the station's disk has no room for " + std::to_string(bytes) + " bytes (some is kept free for its journals)");
  return {};
}

Outcome<UploadStatus> Store::begin_upload(const NewUpload& upload) {
  if (const Outcome<void> room = check_room(upload.who, upload.length); !room) return tl::unexpected(room.error());
  return uploads_.begin(upload);
}

// --- publishing ---

/// The uploads that are to become content, by hash.
Outcome<std::map<ContentHash, std::string>> Store::missing_content(const Publication& publication, const Manifest& manifest) {
  std::map<ContentHash, std::string> uploads;
  for (const SetFile& file : manifest.files) {
    if (uploads.contains(file.hash)) continue;
    const Outcome<std::optional<std::string>> upload = uploads_.find_complete(publication.who, file.hash, file.bytes);
    if (!upload) return tl::unexpected(upload.error());
    if (*upload)
      uploads.emplace(file.hash, **upload);
    else if (!publication.may_use_stored || !has_content(file.hash, file.bytes))
      return refuse(Refusal::unfinished, file.path,
                    "wasn't uploaded whole: no upload has its " + std::to_string(file.bytes) + " bytes and SHA-256");
  }
  return uploads;
}

/// Files that others have stored count as well.
Outcome<void> Store::check_quota(const Publication& publication, const Manifest& manifest,
                                 const std::map<ContentHash, std::string>& uploads) const {
  const Result<std::uint64_t> models = catalogue_.bytes_of(publication.who);
  if (!models) return disk_refusal(models.error());
  std::uint64_t used = *models + uploads_.announced_bytes(publication.who);
  std::set<ContentHash> counted;
  for (const SetFile& file : manifest.files)
    if (uploads.contains(file.hash) && counted.insert(file.hash).second) used -= file.bytes;
  const std::uint64_t bytes = manifest.bytes();
  if (bytes <= limits_.quota_bytes && used <= limits_.quota_bytes - bytes) return {};
  return refuse(Refusal::over_quota, "quota", "this token may store " + std::to_string(limits_.quota_bytes) + " bytes");
}

/// Gives a flushed file of `incoming` its place. A new folder above it is flushed with the manifest.
Result<void> Store::put_content(const std::string& incoming, const ContentHash& hash) {
  const Result<Folder> shard = content_.make_folder(ipc::store::shard_of(hash), kReadableMode);
  if (!shard) return fail(shard.error());
  // Over what is there, which may be damaged; this was just checked.
  const std::string name = uploads_.new_name();
  const Result<bool> linked = uploads_.folder().link(incoming, *shard, name);
  if (!linked) return fail(linked.error());
  const Result<void> renamed = shard->rename(name, *shard, hash.hex());
  // Two names of one file stay as they are.
  (void)shard->remove(name);
  if (!renamed) return renamed;
  if (const Result<void> flushed = shard->flush(); !flushed) return flushed;
  if (damaged_.erase(hash) == 0) return {};
  return damaged_folder_.remove(hash.hex());
}

Result<void> Store::put_new_content(std::string_view bytes, const ContentHash& hash) {
  const Result<Folder> shard = content_.make_folder(ipc::store::shard_of(hash), kReadableMode);
  if (!shard) return fail(shard.error());
  if (const Result<void> flushed = content_.flush(); !flushed) return flushed;
  if (const Result<void> put = shard->replace(hash.hex(), bytes, uploads_.new_name()); !put) return put;
  if (damaged_.erase(hash) == 0) return {};
  return damaged_folder_.remove(hash.hex());
}

/// From its rename on, the model is there.
Result<void> Store::put_record(const ModelRecord& record) {
  return models_.replace(record.model.hex(), ipc::store::encode_record(record), uploads_.new_name());
}

void Store::catalogue_put(const ModelRecord& record) {
  const Result<FoundModel> found = reader_.find(record.model);
  const Result<void> put = found ? catalogue_.put({record, is_damaged(found->manifest)}) : tl::unexpected(found.error());
  if (put) return;
  logging::warn("{}; it is made anew when it is asked next", put.error().text());
  catalogue_is_behind_ = true;
}

Outcome<ModelRecord> Store::publish(const Publication& publication) {
  const Result<Manifest> manifest = ipc::store::decode_manifest(publication.manifest);
  if (!manifest) return refuse(Refusal::malformed, manifest.error());
  const std::string& name = publication.name.empty() ? last_part(manifest->main) : publication.name;
  if (name.size() > 2 * ipc::store::kMaxNameBytes || !ipc::store::is_plain_utf8(name))
    return refuse(Refusal::malformed, "name",
                  "must be a line of text of at most " + std::to_string(2 * ipc::store::kMaxNameBytes) + " bytes");
  const ContentHash model = ipc::store::model_hash(publication.manifest);
  const Result<FoundModel> there = reader_.find(model);
  const bool may_be_told = publication.may_use_stored || (there && there->record.who == publication.who);
  if (there && may_be_told && !is_damaged(there->manifest)) return there->record;
  const Outcome<std::map<ContentHash, std::string>> uploads = missing_content(publication, *manifest);
  if (!uploads) return tl::unexpected(uploads.error());
  if (const Outcome<void> fits = check_quota(publication, *manifest, *uploads); !fits) return tl::unexpected(fits.error());
  for (const auto& [hash, upload] : *uploads)
    if (const Result<void> put = put_content(upload, hash); !put) return disk_refusal(put.error());
  if (const Result<void> put = put_new_content(publication.manifest, model); !put) return disk_refusal(put.error());
  ModelRecord record{model, name, publication.who, publication.when_s, manifest->bytes(), manifest->files.size(), publication.derived_from,
                     {},    {}};
  if (there) record = there->record;
  if (const Result<void> put = put_record(record); !put) {
    if (!there) (void)models_.remove(model.hex());
    return disk_refusal(put.error());
  }
  if (!there)
    for (const ContentHash& content : contents_of(record, *manifest)) ++references_[content];
  damaged_models_.erase(model);
  catalogue_put(record);
  for (const auto& [hash, upload] : *uploads) uploads_.forget(upload);
  return record;
}

Outcome<ModelRecord> Store::describe(const ContentHash& model, const ipc::store::ModelFigures& figures, std::string_view thumbnail) {
  const Outcome<FoundModel> found = find(model);
  if (!found) return tl::unexpected(found.error());
  ModelRecord record = found->record;
  record.figures = figures;
  if (!thumbnail.empty()) {
    record.thumbnail = ipc::store::sha256(thumbnail);
    if (const Result<void> put = put_new_content(thumbnail, *record.thumbnail); !put) return disk_refusal(put.error());
  }
  if (const Result<void> put = put_record(record); !put) return disk_refusal(put.error());
  if (record.thumbnail != found->record.thumbnail) {
    if (record.thumbnail) ++references_[*record.thumbnail];
    if (found->record.thumbnail) release(*found->record.thumbnail);
  }
  catalogue_put(record);
  return record;
}

/// One model less has this content.
void Store::release(const ContentHash& hash) {
  const auto counted = references_.find(hash);
  if (counted == references_.end() || --counted->second > 0) return;
  references_.erase(counted);
  if (!damaged_models_.empty()) return;
  const Result<Folder> shard = content_.folder(ipc::store::shard_of(hash));
  if (shard) (void)shard->remove(hash.hex());
  if (damaged_.erase(hash) > 0) (void)damaged_folder_.remove(hash.hex());
}

Outcome<void> Store::remove(const ContentHash& model) {
  const Outcome<FoundModel> found = find(model);
  if (!found && found.error().why == Refusal::missing) return tl::unexpected(found.error());
  Result<void> removed = models_.remove(model.hex());
  if (removed) removed = models_.flush();
  if (!removed) return disk_refusal(removed.error());
  damaged_models_.erase(model);
  if (const Result<void> forgotten = catalogue_.remove(model); !forgotten) catalogue_is_behind_ = true;
  if (found)
    for (const ContentHash& content : contents_of(found->record, found->manifest)) release(content);
  return {};
}

// --- reading ---

Outcome<FoundModel> Store::find(const ContentHash& model) const {
  if (!models_.has(model.hex())) return refuse(Refusal::missing, "model " + model.hex(), "there is no such model");
  Result<FoundModel> found = reader_.find(model);
  if (!found) return refuse(Refusal::damaged, found.error());
  return std::move(*found);
}

Outcome<ipc::Descriptor> Store::open_file(const SetFile& file) const {
  Result<ipc::Descriptor> opened = reader_.open_file(file);
  if (!opened) return refuse(Refusal::damaged, opened.error());
  return std::move(*opened);
}

Outcome<std::string> Store::picture(const ContentHash& hash) const {
  const Result<Folder> shard = content_.folder(ipc::store::shard_of(hash));
  Result<std::string> bytes = shard ? shard->content(hash.hex(), kMaxPictureBytes) : tl::unexpected(shard.error());
  if (!bytes) return refuse(Refusal::missing, bytes.error());
  if (ipc::store::sha256(*bytes) != hash) return refuse(Refusal::damaged, (shard->path() / hash.hex()).string(), "is damaged");
  return std::move(*bytes);
}

Outcome<std::vector<CatalogueEntry>> Store::list(const CatalogueQuery& query) {
  if (catalogue_is_behind_)
    if (const Result<void> rebuilt = rebuild_catalogue(); !rebuilt) return disk_refusal(rebuilt.error());
  Result<std::vector<CatalogueEntry>> found = catalogue_.find(query);
  if (!found) return disk_refusal(found.error());
  return std::move(*found);
}

Outcome<StoreFigures> Store::figures() const {
  const Result<std::uint64_t> models = catalogue_.count();
  if (!models) return disk_refusal(models.error());
  return StoreFigures{*models, uploads_.count(), damaged_.size(), free_bytes()};
}

// --- scrubbing ---

void Store::mark_damaged(const ContentHash& hash) {
  damaged_.insert(hash);
  if (damaged_folder_.has(hash.hex())) return;
  Result<void> marked = damaged_folder_.write_new(hash.hex(), {});
  if (marked) marked = damaged_folder_.flush();
  if (!marked) logging::warn("{}", marked.error().text());
}

Result<std::optional<std::string>> Store::scrub_next(bool& done) {
  const auto next = scrubbed_to_ ? references_.upper_bound(*scrubbed_to_) : references_.begin();
  done = next == references_.end();
  scrubbed_to_ = done ? std::nullopt : std::optional(next->first);
  if (done || damaged_.contains(next->first)) return std::nullopt;
  const ContentHash hash = next->first;
  const Result<Folder> shard = content_.folder(ipc::store::shard_of(hash));
  const Result<ipc::Descriptor> file = shard ? shard->read(hash.hex()) : tl::unexpected(shard.error());
  const Result<ContentHash> found = file ? ipc::store::hash_file(*file, shard->path() / hash.hex()) : tl::unexpected(file.error());
  if (found && *found == hash) return std::nullopt;
  mark_damaged(hash);
  catalogue_is_behind_ = true;
  return (found ? (shard->path() / hash.hex()).string() + ": its bytes aren't those that were stored" : found.error().text()) +
         "; it isn't given out any more";
}

}  // namespace prismesh::intake
