#include "daemon/intake/store/uploads.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "base/base64.h"
#include "daemon/intake/store/upload_record.h"

namespace prismesh::intake {

namespace {

using ipc::store::ContentHash;
using ipc::store::Folder;

constexpr std::string_view kRecordEnding = ".upload";  ///< whose the upload is
constexpr std::string_view kChunkEnding = ".chunk";    ///< where a chunk begins that isn't checked yet
constexpr std::size_t kMaxUploadRecordBytes = std::size_t{128} << 10;
constexpr std::size_t kIdBytes = 16;
constexpr std::size_t kHashPiece = std::size_t{1} << 20;

std::string record_name(const std::string& id) { return id + std::string(kRecordEnding); }
std::string chunk_name(const std::string& id) { return id + std::string(kChunkEnding); }

Result<void> truncate_file(const ipc::Descriptor& file, std::uint64_t size, const std::filesystem::path& shown) {
  if (::ftruncate(file.get(), static_cast<off_t>(size)) != 0)
    return fail(shown.string(), "can't be cut: " + std::generic_category().message(errno));
  return {};
}

tl::unexpected<Refused> no_upload(const std::string& id) { return refuse(Refusal::missing, "upload " + id, "there is no such upload"); }

}  // namespace

Result<Uploads> Uploads::open(Folder incoming, const StoreLimits& limits, Clock& clock, Randomness randomness,
                              std::vector<std::string>& notes) {
  Uploads uploads(std::move(incoming), limits, clock, std::move(randomness));
  if (const Result<void> taken = uploads.take_up(notes); !taken) return fail(taken.error());
  return uploads;
}

std::string Uploads::new_name() {
  std::array<std::byte, kIdBytes> bytes{};
  randomness_(bytes);
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string name;
  for (const std::byte byte : bytes) {
    name += kDigits[std::to_integer<std::size_t>(byte >> 4)];
    name += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
  }
  return name;
}

Result<void> Uploads::take_up(std::vector<std::string>& notes) {
  const Result<std::vector<std::string>> names = folder_.names();
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    if (!name.ends_with(kRecordEnding)) continue;
    const std::string id = name.substr(0, name.size() - kRecordEnding.size());
    if (const Result<void> taken = take_up_one(id); !taken) notes.push_back("an upload is given up: " + taken.error().text());
  }
  // What belongs to no upload: of one that ended while it was made or removed, of a publication that didn't come to its end.
  for (const std::string& name : *names)
    if (!uploads_.contains(name.substr(0, name.find('.'))))
      if (const Result<void> removed = folder_.remove(name); !removed) notes.push_back(removed.error().text());
  return {};
}

Result<void> Uploads::take_up_one(const std::string& id) {
  const Result<std::string> text = folder_.content(record_name(id), kMaxUploadRecordBytes);
  if (!text) return fail(text.error());
  Result<NewUpload> is = decode_upload(*text, (folder_.path() / record_name(id)).string());
  if (!is) return fail(is.error());
  Result<ipc::Descriptor> file = folder_.read_and_write(id);
  if (!file) return fail(file.error());
  const Result<std::uint64_t> size = folder_.size_of(id);
  if (!size) return fail(size.error());
  Upload upload{std::move(*is), std::move(*file), 0, 0, {}, std::nullopt, clock_->now_ns(), std::nullopt};
  upload.offset = std::min(*size, upload.is.length);
  if (const Result<void> cut = cut_unchecked_chunk(id, upload); !cut) return cut;
  uploads_.emplace(id, std::move(upload));
  return {};
}

Result<void> Uploads::cut_unchecked_chunk(const std::string& id, Upload& upload) {
  if (!folder_.has(chunk_name(id))) return {};
  const Result<std::string> text = folder_.content(chunk_name(id), 64);
  if (!text) return fail(text.error());
  // It is written before the chunk's first byte: without a whole number there is no byte of the chunk.
  if (const std::optional<std::uint64_t> begin = decode_offset(*text); begin && *begin < upload.offset) {
    if (const Result<void> cut = truncate_file(upload.file, *begin, folder_.path() / id); !cut) return cut;
    upload.offset = *begin;
  }
  return folder_.remove(chunk_name(id));
}

Outcome<UploadStatus> Uploads::begin(const NewUpload& upload) {
  if (upload.length > limits_.file_bytes)
    return refuse(Refusal::too_large, "upload", "a file may have " + std::to_string(limits_.file_bytes) + " bytes");
  const auto count = std::count_if(uploads_.begin(), uploads_.end(), [&](const auto& each) { return each.second.is.who == upload.who; });
  if (static_cast<std::uint64_t>(count) >= limits_.uploads)
    return refuse(Refusal::over_quota, "upload", "there are " + std::to_string(count) + " uploads of this token; publish or remove some");
  const std::string id = new_name();
  Result<ipc::Descriptor> file = folder_.create(id);
  if (!file) return disk_refusal(file.error());
  Result<void> made = folder_.write_new(record_name(id), encode_upload(upload));
  if (made) made = folder_.flush();
  if (!made) {
    remove_files(id);
    return disk_refusal(made.error());
  }
  Upload& added =
      uploads_.emplace(id, Upload{upload, std::move(*file), 0, 0, {}, std::nullopt, clock_->now_ns(), std::nullopt}).first->second;
  if (added.offset == added.is.length)
    if (const Outcome<void> done = complete(id, added); !done) return tl::unexpected(done.error());
  return status_of(id, uploads_.at(id));
}

Outcome<Uploads::Found> Uploads::find(const std::string& who, const std::string& id) {
  const Found found = uploads_.find(id);
  if (found == uploads_.end() || found->second.is.who != who) return no_upload(id);
  return found;
}

UploadStatus Uploads::status_of(const std::string& id, const Upload& upload) const {
  const std::int64_t quiet_s = (clock_->now_ns() - upload.touched_ns) / 1'000'000'000;
  return {id, upload.is.length, upload.offset, upload.is.metadata, std::max<std::int64_t>(0, limits_.upload_lifetime_s - quiet_s)};
}

Outcome<UploadStatus> Uploads::status(const std::string& who, const std::string& id) {
  const Outcome<Found> found = find(who, id);
  if (!found) return tl::unexpected(found.error());
  return status_of(id, (*found)->second);
}

Result<void> Uploads::catch_up(const std::string& id, Upload& upload) {
  std::string piece;
  while (upload.hashed < upload.offset) {
    piece.resize(std::min<std::uint64_t>(kHashPiece, upload.offset - upload.hashed));
    const Result<std::size_t> got = ipc::store::read_at(upload.file, piece.data(), piece.size(), upload.hashed, folder_.path() / id);
    if (!got) return fail(got.error());
    if (*got != piece.size()) return fail((folder_.path() / id).string(), "is shorter than it was");
    upload.hash.add(piece);
    upload.hashed += *got;
  }
  return {};
}

Outcome<std::uint64_t> Uploads::begin_chunk(const std::string& who, const std::string& id, std::uint64_t offset,
                                            std::optional<Checksum> checksum) {
  const Outcome<Found> found = find(who, id);
  if (!found) return tl::unexpected(found.error());
  Upload& upload = (*found)->second;
  if (upload.chunk)
    if (const Outcome<void> discarded = discard_chunk(id, upload); !discarded) return tl::unexpected(discarded.error());
  if (offset != upload.offset)
    return refuse(Refusal::wrong_offset, "upload " + id,
                  "goes on at " + std::to_string(upload.offset) + ", not at " + std::to_string(offset));
  // An earlier chunk couldn't be cut off.
  if (folder_.has(chunk_name(id))) {
    Result<void> cut = truncate_file(upload.file, upload.offset, folder_.path() / id);
    if (cut) cut = folder_.remove(chunk_name(id));
    if (!cut) return disk_refusal(cut.error());
  }
  if (const Result<void> caught_up = catch_up(id, upload); !caught_up) return disk_refusal(caught_up.error());
  if (checksum)
    if (const Result<void> marked = folder_.write_new(chunk_name(id), encode_offset(offset)); !marked) return disk_refusal(marked.error());
  upload.chunk = Chunk{++chunks_, 0, std::move(checksum), std::nullopt, upload.hash};
  if (upload.chunk->checksum) upload.chunk->digest.emplace(upload.chunk->checksum->algorithm);
  return chunks_;
}

Outcome<Uploads::Upload*> Uploads::find_chunk(const std::string& id, std::uint64_t chunk) {
  const Found found = uploads_.find(id);
  if (found == uploads_.end()) return no_upload(id);
  if (!found->second.chunk || found->second.chunk->number != chunk)
    return refuse(Refusal::taken_over, "upload " + id, "a later request goes on with it");
  return &found->second;
}

Outcome<void> Uploads::add(const std::string& id, std::uint64_t chunk, std::string_view bytes) {
  const Outcome<Upload*> found = find_chunk(id, chunk);
  if (!found) return tl::unexpected(found.error());
  Upload& upload = **found;
  const std::uint64_t at = upload.chunk->checksum ? upload.offset + upload.chunk->received : upload.offset;
  if (bytes.size() > upload.is.length - at)
    return refuse(Refusal::too_large, "upload " + id, "there are more bytes than the " + std::to_string(upload.is.length) + " announced");
  if (const Result<void> written = ipc::store::write_at(upload.file, bytes, at, folder_.path() / id); !written)
    return disk_refusal(written.error());
  upload.touched_ns = clock_->now_ns();
  upload.hash.add(std::as_bytes(std::span(bytes.data(), bytes.size())));
  upload.hashed += bytes.size();
  upload.chunk->received += bytes.size();
  if (upload.chunk->digest)
    upload.chunk->digest->add(bytes);
  else
    upload.offset += bytes.size();
  return {};
}

/// Ends a chunk; what doesn't count yet is cut off.
Outcome<void> Uploads::discard_chunk(const std::string& id, Upload& upload) {
  Chunk chunk = std::move(*upload.chunk);
  upload.chunk.reset();
  if (!chunk.checksum) return {};
  upload.hash = std::move(chunk.before);
  upload.hashed = upload.offset;
  Result<void> cut = truncate_file(upload.file, upload.offset, folder_.path() / id);
  if (cut) cut = folder_.remove(chunk_name(id));
  if (!cut) return disk_refusal(cut.error());
  return {};
}

Outcome<UploadStatus> Uploads::end_chunk(const std::string& id, std::uint64_t chunk) {
  const Outcome<Upload*> found = find_chunk(id, chunk);
  if (!found) return tl::unexpected(found.error());
  Upload& upload = **found;
  if (upload.chunk->checksum) {
    if (upload.chunk->digest->digest() != upload.chunk->checksum->digest) {
      if (const Outcome<void> discarded = discard_chunk(id, upload); !discarded) return tl::unexpected(discarded.error());
      return refuse(Refusal::wrong_checksum, "upload " + id, "the chunk's bytes don't have its checksum; it was discarded");
    }
    // The mark goes first: with it, checked bytes would be cut off after a kill.
    if (const Result<void> removed = folder_.remove(chunk_name(id)); !removed) {
      (void)discard_chunk(id, upload);
      return disk_refusal(removed.error());
    }
    upload.offset += upload.chunk->received;
  }
  upload.chunk.reset();
  if (upload.offset == upload.is.length)
    if (const Outcome<void> done = complete(id, upload); !done) return tl::unexpected(done.error());
  return status_of(id, upload);
}

void Uploads::give_up_chunk(const std::string& id, std::uint64_t chunk) {
  if (const Outcome<Upload*> found = find_chunk(id, chunk)) (void)discard_chunk(id, **found);
}

/// Flushes and checks the whole file.
Outcome<void> Uploads::complete(const std::string& id, Upload& upload) {
  if (const Result<void> flushed = ipc::store::flush_file(upload.file, folder_.path() / id); !flushed) {
    // What the disk has lost after a failed flush is unknown, so nothing of it counts.
    (void)truncate_file(upload.file, 0, folder_.path() / id);
    upload.offset = upload.hashed = 0;
    upload.hash = {};
    return disk_refusal(flushed.error());
  }
  if (const Result<void> caught_up = catch_up(id, upload); !caught_up) return disk_refusal(caught_up.error());
  upload.content = upload.hash.hash();
  if (!upload.is.expected || *upload.is.expected == *upload.content) return {};
  uploads_.erase(id);
  remove_files(id);
  return refuse(Refusal::wrong_content, "upload " + id, "the file's bytes don't have its SHA-256; the upload was discarded");
}

void Uploads::remove_files(const std::string& id) {
  // The record goes first: without it the rest is removed at the next start.
  (void)folder_.remove(record_name(id));
  (void)folder_.remove(chunk_name(id));
  (void)folder_.remove(id);
}

void Uploads::forget(const std::string& id) {
  uploads_.erase(id);
  remove_files(id);
}

Outcome<void> Uploads::terminate(const std::string& who, const std::string& id) {
  const Outcome<Found> found = find(who, id);
  if (!found) return tl::unexpected(found.error());
  forget(id);
  return {};
}

std::size_t Uploads::expire() {
  std::vector<std::string> old;
  for (const auto& [id, upload] : uploads_)
    if (clock_->now_ns() - upload.touched_ns >= limits_.upload_lifetime_s * 1'000'000'000) old.push_back(id);
  for (const std::string& id : old) forget(id);
  return old.size();
}

std::uint64_t Uploads::announced_bytes(const std::string& who) const {
  std::uint64_t bytes = 0;
  for (const auto& [id, upload] : uploads_)
    if (upload.is.who == who) bytes += upload.is.length;
  return bytes;
}

std::uint64_t Uploads::missing_bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& [id, upload] : uploads_) bytes += upload.is.length - upload.offset;
  return bytes;
}

Outcome<std::optional<std::string>> Uploads::find_complete(const std::string& who, const ContentHash& hash, std::uint64_t bytes) {
  std::vector<std::string> candidates;
  for (const auto& [id, upload] : uploads_)
    if (upload.is.who == who && upload.is.length == bytes && upload.offset == bytes && !upload.chunk) candidates.push_back(id);
  for (const std::string& id : candidates) {
    Upload& upload = uploads_.at(id);
    // An earlier process may have taken its last byte.
    if (!upload.content)
      if (const Outcome<void> done = complete(id, upload); !done) {
        if (done.error().why == Refusal::wrong_content) continue;
        return tl::unexpected(done.error());
      }
    if (uploads_.contains(id) && upload.content == hash) return std::optional(id);
  }
  return std::optional<std::string>();
}

}  // namespace prismesh::intake
