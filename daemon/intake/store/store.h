// The store of models: what was uploaded becomes a model by one rename, so that it is there whole or not at all. docs/remote.md says how
// it lies on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/intake/store/catalogue.h"
#include "daemon/intake/store/uploads.h"
#include "ipc/store/reading.h"

namespace prismesh::intake {

/// A model that is to be published.
struct Publication {
  std::string who;       ///< the token's name
  std::string manifest;  ///< as it came
  std::string name;      ///< for people; empty: the main file's
  std::optional<ipc::store::ContentHash> derived_from;
  bool may_use_stored = false;  ///< files that others have stored may be parts: who may read them could send them
  std::int64_t when_s = 0;
};

/// What stands in the store, for figures.
struct StoreFigures {
  std::uint64_t models = 0;
  std::uint64_t uploads = 0;
  std::uint64_t damaged = 0;     ///< files
  std::uint64_t free_bytes = 0;  ///< on the disk, beyond the reserve
};

/// Used by one thread.
class Store {
 public:
  /// Makes what is missing, takes up what an earlier process left, and removes what was never published. `notes`: what was found, as
  /// sentences. Errors: the disk; another process has it.
  static Result<Store> open(const std::filesystem::path& path, const StoreLimits& limits, Clock& clock, Randomness randomness,
                            std::vector<std::string>& notes);

  /// Errors: quota, space, and those of Uploads::begin.
  Outcome<UploadStatus> begin_upload(const NewUpload& upload);
  Uploads& uploads() { return uploads_; }

  /// Publishes a model; one that is there already stays as it is. Errors: the manifest (malformed), a file that wasn't uploaded
  /// (unfinished, named), quota, the disk: then the model isn't there.
  Outcome<ipc::store::ModelRecord> publish(const Publication& publication);
  /// Says what a reader found in a model. `thumbnail`: a PNG's bytes; empty: none.
  Outcome<ipc::store::ModelRecord> describe(const ipc::store::ContentHash& model, const ipc::store::ModelFigures& figures,
                                            std::string_view thumbnail);
  Outcome<void> remove(const ipc::store::ContentHash& model);

  Outcome<ipc::store::FoundModel> find(const ipc::store::ContentHash& model) const;
  Outcome<ipc::Descriptor> open_file(const ipc::store::SetFile& file) const;
  /// The bytes of a thumbnail, checked. Errors: missing, damaged.
  Outcome<std::string> picture(const ipc::store::ContentHash& hash) const;
  Outcome<std::vector<CatalogueEntry>> list(const CatalogueQuery& query);
  Outcome<StoreFigures> figures() const;

  /// Hashes the next file of the store. Returns a sentence where it is damaged; from then on it isn't read any more. `done`: that was the
  /// last one, and the next call begins anew.
  Result<std::optional<std::string>> scrub_next(bool& done);

 private:
  using ContentHash = ipc::store::ContentHash;
  Store(ipc::Descriptor lock, ipc::store::Folder content, ipc::store::Folder models, ipc::store::Folder damaged, ipc::store::Reader reader,
        Uploads uploads, Catalogue catalogue, const StoreLimits& limits);
  Result<void> take_up(std::vector<std::string>& notes);
  void collect_orphans(std::vector<std::string>& notes);
  Result<void> rebuild_catalogue();
  bool is_damaged(const ipc::store::Manifest& manifest) const;
  Outcome<void> check_room(const std::string& who, std::uint64_t bytes) const;
  std::uint64_t free_bytes() const;
  Outcome<std::map<ContentHash, std::string>> missing_content(const Publication& publication, const ipc::store::Manifest& manifest);
  Outcome<void> check_quota(const Publication& publication, const ipc::store::Manifest& manifest,
                            const std::map<ContentHash, std::string>& uploads) const;
  Result<void> put_content(const std::string& incoming, const ContentHash& hash);
  Result<void> put_new_content(std::string_view bytes, const ContentHash& hash);
  Result<void> put_record(const ipc::store::ModelRecord& record);
  bool has_content(const ContentHash& hash, std::uint64_t bytes) const;
  void catalogue_put(const ipc::store::ModelRecord& record);
  void release(const ContentHash& hash);
  void mark_damaged(const ContentHash& hash);

  ipc::Descriptor lock_;
  ipc::store::Folder content_, models_, damaged_folder_;
  ipc::store::Reader reader_;
  Uploads uploads_;
  Catalogue catalogue_;
  StoreLimits limits_;
  std::map<ContentHash, std::uint64_t> references_;  ///< by records: of files, manifests and thumbnails
  std::set<ContentHash> damaged_;
  std::set<ContentHash> damaged_models_;  ///< whose record or manifest can't be read; nothing is removed while there are some
  bool catalogue_is_behind_ = false;
  std::optional<ContentHash> scrubbed_to_;
};

}  // namespace prismesh::intake
