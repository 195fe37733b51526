// Files that are being uploaded: `incoming/ID` has the bytes so far, `incoming/ID.upload` says whose they are. After an end of the process
// they go on where they were.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "daemon/intake/store/checksum.h"
#include "daemon/intake/store/limits.h"
#include "daemon/intake/store/new_upload.h"
#include "daemon/intake/store/outcome.h"
#include "ipc/store/folder.h"
#include "ipc/store/sha256.h"

namespace prismesh::intake {

struct UploadStatus {
  std::string id;
  std::uint64_t length = 0;
  std::uint64_t offset = 0;
  std::string metadata;
  std::int64_t expires_in_s = 0;
};

/// Used by one thread.
class Uploads {
 public:
  /// Takes up what an earlier process left. `notes`: what couldn't be taken up, as sentences. Errors: the folder can't be read.
  static Result<Uploads> open(ipc::store::Folder incoming, const StoreLimits& limits, Clock& clock, Randomness randomness,
                              std::vector<std::string>& notes);

  /// Makes an upload; the caller has checked quota and space. Errors: too large, too many, the disk.
  Outcome<UploadStatus> begin(const NewUpload& upload);
  Outcome<UploadStatus> status(const std::string& who, const std::string& id);

  /// Begins a chunk; a chunk of the same upload that is under way is given up. With a checksum nothing of it counts before `end_chunk`;
  /// without, each piece counts at once. Returns the chunk's number.
  Outcome<std::uint64_t> begin_chunk(const std::string& who, const std::string& id, std::uint64_t offset, std::optional<Checksum> checksum);
  /// Errors: taken over by another chunk, more bytes than the upload has, the disk.
  Outcome<void> add(const std::string& id, std::uint64_t chunk, std::string_view bytes);
  /// Checks the chunk, and the whole file if this was its end. Errors: wrong checksum (the chunk is gone), wrong content (the upload is
  /// gone), the disk.
  Outcome<UploadStatus> end_chunk(const std::string& id, std::uint64_t chunk);
  /// The chunk's sender is gone.
  void give_up_chunk(const std::string& id, std::uint64_t chunk);

  Outcome<void> terminate(const std::string& who, const std::string& id);
  /// Removes uploads that got no byte for their lifetime. Returns how many.
  std::size_t expire();

  /// What all uploads of a name, or of all, will have when they are complete.
  std::uint64_t announced_bytes(const std::string& who) const;
  std::uint64_t missing_bytes() const;
  std::size_t count() const { return uploads_.size(); }

  /// The id of a complete upload with that content. Errors: the disk.
  Outcome<std::optional<std::string>> find_complete(const std::string& who, const ipc::store::ContentHash& hash, std::uint64_t bytes);
  /// The upload's content has another name now.
  void forget(const std::string& id);
  const ipc::store::Folder& folder() const { return folder_; }
  /// A name in the folder that nobody has.
  std::string new_name();

 private:
  struct Chunk {
    std::uint64_t number = 0;
    std::uint64_t received = 0;
    std::optional<Checksum> checksum;
    std::optional<ChunkDigest> digest;
    ipc::store::Sha256 before;
  };
  struct Upload {
    NewUpload is;
    ipc::Descriptor file;
    std::uint64_t offset = 0;
    std::uint64_t hashed = 0;  ///< bytes in `hash`
    ipc::store::Sha256 hash;
    std::optional<ipc::store::ContentHash> content;  ///< of a complete and checked one
    std::int64_t touched_ns = 0;
    std::optional<Chunk> chunk;
  };
  using Found = std::map<std::string, Upload>::iterator;

  Uploads(ipc::store::Folder folder, const StoreLimits& limits, Clock& clock, Randomness randomness)
      : folder_(std::move(folder)), limits_(limits), clock_(&clock), randomness_(std::move(randomness)) {}
  Result<void> take_up(std::vector<std::string>& notes);
  Result<void> take_up_one(const std::string& id);
  Result<void> cut_unchecked_chunk(const std::string& id, Upload& upload);
  Outcome<Found> find(const std::string& who, const std::string& id);
  Outcome<Upload*> find_chunk(const std::string& id, std::uint64_t chunk);
  UploadStatus status_of(const std::string& id, const Upload& upload) const;
  Result<void> catch_up(const std::string& id, Upload& upload);
  Outcome<void> discard_chunk(const std::string& id, Upload& upload);
  Outcome<void> complete(const std::string& id, Upload& upload);
  void remove_files(const std::string& id);

  ipc::store::Folder folder_;
  StoreLimits limits_;
  Clock* clock_;
  Randomness randomness_;
  std::map<std::string, Upload> uploads_;
  std::uint64_t chunks_ = 0;
};

}  // namespace prismesh::intake
