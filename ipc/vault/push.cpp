#include "ipc/vault/push.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "ipc/store/folder.h"
#include "ipc/vault/objects.h"

namespace prismesh::ipc::vault {

namespace {

constexpr double kHashingShare = 0.1;  ///< of the progress bar

class VaultPush {
 public:
  VaultPush(Vault& vault, const VaultPushOptions& options) : vault_(vault), options_(options) {}

  Result<VaultPushed> run(const std::vector<store::LocalFile>& files, const std::string& main) {
    std::vector<std::vector<store::ContentHash>> pieces(files.size());
    const Result<store::LocalSet> set = store::hash_local(
        files, main, [this] { return told(); },
        [&](std::size_t file, std::string_view piece) { pieces[file].push_back(store::sha256(piece)); });
    if (!set) return fail(set.error());
    std::map<std::string, const std::vector<store::ContentHash>*> pieces_of;  // by the path in the model
    for (std::size_t i = 0; i < files.size(); ++i) pieces_of[files[i].path] = &pieces[i];
    if (const Result<void> described = describe(*set); !described) return fail(described.error());
    // The first request: where a store refuses a list it says why, which it can't in an answer to HEAD.
    if (const Result<void> known = keep_name(); !known) return fail(known.error());
    for (const store::LocalContent& content : set->contents) all_bytes_ += content.is.bytes;
    const Result<bool> is_there = has(model_object(pushed_.model.model), set->text.size());
    if (!is_there) return fail(is_there.error());
    for (const store::LocalContent& content : set->contents)
      if (const Result<void> sent = send(content, *pieces_of[content.is.path]); !sent) return fail(sent.error());
    pushed_.pieces = known_.size();
    if (is_new_name_)
      if (const Result<void> named = put_name(); !named) return fail(named.error());
    if (const Result<void> put = put_small(model_object(pushed_.model.model), set->text, pushed_.model.model); !put)
      return fail(put.error());
    pushed_.was_there = *is_there && pushed_.sent_pieces == 0 && !sent_small_;
    return std::move(pushed_);
  }

 private:
  bool told() const { return !vault_.is_stopped() && (!options_.progress || options_.progress(fraction_)); }

  Result<void> describe(const store::LocalSet& set) {
    store::ModelRecord& model = pushed_.model;
    model.model = store::model_hash(set.text);
    model.name = options_.name.empty() ? std::filesystem::path(set.manifest.main).filename().string() : options_.name;
    model.when_s = options_.now_s;
    model.bytes = set.manifest.bytes();
    model.files = set.manifest.files.size();
    if (!is_model_name(model.name))
      return fail(set.manifest.main,
                  "a model's name is text of at most " + std::to_string(store::kMaxNameBytes) +
                      " bytes without control characters, and more than digits of a hash (0-9, a-f); give one with --name");
    return {};
  }

  Result<bool> has(const std::string& object, std::uint64_t bytes) {
    const Result<std::optional<std::uint64_t>> size = vault_.size_of(object);
    if (!size) return fail(size.error());
    return *size == bytes;
  }

  /// A list or a manifest, unless the same bytes are there: damage of the same size is found here, where it can be mended.
  Result<void> put_small(const std::string& object, std::string_view bytes, const store::ContentHash& hash) {
    if (!options_.sends_all) {
      const Result<std::optional<std::string>> there = vault_.get_unchecked(object, bytes.size());
      if (!there && there.error().kind != ErrorKind::over_limit) return fail(there.error());
      if (there && *there && **there == bytes) return {};
    }
    sent_small_ = true;
    return vault_.put(object, bytes, hash);
  }

  Result<void> send(const store::LocalContent& content, const std::vector<store::ContentHash>& pieces) {
    const Result<store::OpenedFile> opened = store::open_local(content.disk);
    if (!opened) return fail(opened.error());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const std::uint64_t at = std::uint64_t{i} * kPieceBytes;
      const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(kPieceBytes, content.is.bytes - at));
      if (known_.insert(pieces[i]).second)
        if (const Result<void> sent = send_piece(content, opened->file, at, bytes, pieces[i]); !sent) return sent;
      done_bytes_ += bytes;
      fraction_ = kHashingShare +
                  (1 - kHashingShare) * static_cast<double>(done_bytes_) / static_cast<double>(std::max<std::uint64_t>(1, all_bytes_));
      if (!told()) return fail(cancelled());
    }
    if (pieces.size() < 2) return {};
    const std::string list = encode_pieces(pieces);
    if (list.size() > kMaxListBytes) return fail(content.disk.string(), "is too large for a vault");
    return put_small(list_object(content.is.hash), list, store::sha256(list));
  }

  Result<void> send_piece(const store::LocalContent& content, const Descriptor& file, std::uint64_t at, std::size_t bytes,
                          const store::ContentHash& hash) {
    if (!options_.sends_all) {
      const Result<bool> is_there = has(piece_object(hash), bytes);
      if (!is_there) return fail(is_there.error());
      if (*is_there) return {};
    }
    piece_.resize(bytes);
    const Result<std::size_t> got = store::read_at(file, piece_.data(), bytes, at, content.disk);
    if (!got) return fail(got.error());
    if (*got != bytes || store::sha256(piece_) != hash) return fail(content.disk.string(), "changed while it was sent; push it again");
    if (const Result<void> put = vault_.put(piece_object(hash), piece_, hash); !put) return put;
    ++pushed_.sent_pieces;
    pushed_.sent_bytes += bytes;
    return {};
  }

  /// A model that has names keeps the newest, unless the user gives another.
  Result<void> keep_name() {
    store::ModelRecord& model = pushed_.model;
    const Result<std::vector<ListedObject>> names = vault_.list(std::string(kNames) + model.model.hex() + "/");
    if (!names) return fail(names.error());
    std::optional<store::ModelRecord> newest;
    for (const ListedObject& object : *names)
      if (auto record = record_of_object(object.key); record && (!newest || is_newer_name(*record, *newest, options_.now_s)))
        newest = std::move(record);
    is_new_name_ = !newest || (!options_.name.empty() && newest->name != options_.name);
    if (newest && !is_new_name_) {
      model.name = newest->name;
      model.when_s = newest->when_s;
    } else if (newest && name_time(*newest, options_.now_s) >= model.when_s) {
      model.when_s = newest->when_s + 1;  // within the same second, or by a clock that is ahead
    }
    return {};
  }

  Result<void> put_name() { return vault_.put(name_object(pushed_.model), pushed_.model.name, store::sha256(pushed_.model.name)); }

  Vault& vault_;
  const VaultPushOptions& options_;
  VaultPushed pushed_;
  std::set<store::ContentHash> known_;  ///< pieces that were asked for
  std::string piece_;
  bool is_new_name_ = false, sent_small_ = false;
  std::uint64_t all_bytes_ = 0, done_bytes_ = 0;
  double fraction_ = 0;
};

}  // namespace

Result<VaultPushed> push(Vault& vault, const std::vector<store::LocalFile>& files, const std::string& main,
                         const VaultPushOptions& options) {
  return VaultPush(vault, options).run(files, main);
}

}  // namespace prismesh::ipc::vault
