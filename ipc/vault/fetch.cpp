#include "ipc/vault/fetch.h"

#include <algorithm>
#include <ctime>
#include <set>
#include <utility>

#include <unistd.h>

#include "ipc/store/choosing.h"
#include "ipc/store/folder.h"
#include "ipc/store/receiving.h"
#include "ipc/vault/objects.h"

namespace prismesh::ipc::vault {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFetching = ".fetching";
constexpr const char* kResend = "; push the model again with --resend";
constexpr int kListTries = 3;  // a list has no hash of its own: the line may have changed it

class VaultFetch {
 public:
  VaultFetch(Vault& vault, const VaultFetchOptions& options) : vault_(vault), options_(options) {}

  Result<VaultFetched> run(const std::string& wanted) {
    Result<store::ModelRecord> model = find_model(vault_, wanted);
    if (!model) return fail(model.error());
    const Result<store::Manifest> manifest = get_manifest(vault_, model->model);
    if (!manifest) return fail(manifest.error());
    const fs::path folder = options_.folder.value_or(store::usual_folder(*manifest, model->model));
    const Result<store::Receiving> receiving = store::Receiving::begin(folder, kFetching);
    if (!receiving) return fail(receiving.error());
    all_bytes_ = manifest->bytes();
    std::set<store::ContentHash> known;
    for (const store::SetFile& file : manifest->files)
      if (known.insert(file.hash).second)
        if (const Result<void> fetched = fetch_file(file, *receiving); !fetched) return fail(fetched.error());
    if (const Result<void> finished = receiving->finish(*manifest, [this] { return !told(); }); !finished) return fail(finished.error());
    model->bytes = manifest->bytes();
    model->files = manifest->files.size();
    return VaultFetched{std::move(*model), folder, folder / manifest->main, received_bytes_};
  }

 private:
  bool told() const { return !vault_.is_stopped() && (!options_.progress || options_.progress(fraction_)); }

  Result<void> fetch_file(const store::SetFile& file, const store::Receiving& receiving) {
    const Result<std::vector<store::ContentHash>> pieces = get_pieces(vault_, file);
    if (!pieces) return fail(pieces.error());
    const Result<store::ReceivedFile> received = receiving.file(file.hash);
    if (!received) return fail(received.error());
    for (std::size_t i = 0; i < pieces->size(); ++i) {
      const std::uint64_t at = std::uint64_t{i} * kPieceBytes;
      const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(kPieceBytes, file.bytes - at));
      if (const Result<void> fetched = fetch_piece(file, *received, (*pieces)[i], at, bytes); !fetched) return fetched;
      done_bytes_ += bytes;
      fraction_ = std::min(1.0, static_cast<double>(done_bytes_) / static_cast<double>(std::max<std::uint64_t>(1, all_bytes_)));
      if (!told()) return fail(cancelled());
    }
    if (::ftruncate(received->disk.get(), static_cast<off_t>(file.bytes)) != 0) return fail(received->shown.string(), "can't be written");
    return {};
  }

  Result<void> fetch_piece(const store::SetFile& file, const store::ReceivedFile& received, const store::ContentHash& piece,
                           std::uint64_t at, std::size_t bytes) {
    if (received.is_begun) {
      begun_.resize(bytes);
      const Result<std::size_t> got = store::read_at(received.disk, begun_.data(), bytes, at, received.shown);
      if (!got) return fail(got.error());
      if (*got == bytes && store::sha256(begun_) == piece) return {};
    }
    const Result<std::optional<std::string>> content = vault_.get(piece_object(piece), piece, bytes);
    if (!content) return fail(content.error());
    if (!*content) return fail(vault_.name(), piece_object(piece) + " of " + file.path + " isn't there; push the model again");
    if ((*content)->size() != bytes) return fail(vault_.name(), "has a list of pieces for " + file.path + " that isn't right" + kResend);
    if (const Result<void> written = store::write_at(received.disk, **content, at, received.shown); !written) return written;
    received_bytes_ += bytes;
    return {};
  }

  Vault& vault_;
  const VaultFetchOptions& options_;
  std::string begun_;
  std::uint64_t all_bytes_ = 0, done_bytes_ = 0, received_bytes_ = 0;
  double fraction_ = 0;
};

/// With what people call it, if that can be listed.
Result<store::ModelRecord> named_model(Vault& vault, const store::ContentHash& model) {
  const std::int64_t now_s = std::time(nullptr);
  store::ModelRecord named;
  named.model = model;
  const Result<std::vector<ListedObject>> names = vault.list(std::string(kNames) + model.hex() + "/");
  if (!names && is_cancelled(names.error())) return fail(names.error());
  for (const ListedObject& object : names ? *names : std::vector<ListedObject>())
    if (auto record = record_of_object(object.key); record && (named.name.empty() || is_newer_name(*record, named, now_s)))
      named = std::move(*record);
  return named;
}

}  // namespace

Result<store::ModelRecord> find_model(Vault& vault, const std::string& wanted) {
  if (const auto model = store::parse_content_hash(wanted)) {
    const Result<std::optional<std::uint64_t>> size = vault.size_of(model_object(*model));
    if (!size) return fail(size.error());
    if (*size) return named_model(vault, *model);
  }
  const Result<std::vector<store::ModelRecord>> all = models(vault);
  if (!all) return fail(all.error());
  // What a model was called earlier counts where none is called so now.
  const bool is_known =
      store::may_be_hash(wanted) || std::any_of(all->begin(), all->end(), [&](const auto& model) { return model.name == wanted; });
  const Result<std::vector<store::ModelRecord>> named = is_known ? all : models(vault, wanted);
  if (!named) return fail(named.error());
  const Result<std::size_t> chosen = store::choose_model(*named, wanted, vault.name(), "prismesh vault list");
  if (!chosen) return fail(chosen.error());
  return (*named)[*chosen];
}

Result<store::Manifest> get_manifest(Vault& vault, const store::ContentHash& model) {
  const Result<std::optional<std::string>> text = vault.get(model_object(model), model, store::kMaxManifestBytes);
  if (!text) return fail(text.error());
  if (!*text) return fail(vault.name(), "has no such model any more; `prismesh vault list` lists those there are");
  Result<store::Manifest> manifest = store::decode_manifest(**text);
  if (!manifest)
    return fail(vault.name(),
                "gives a list of files that isn't taken, line " + std::to_string(manifest.error().line) + ": " + manifest.error().message);
  return manifest;
}

Result<std::vector<store::ContentHash>> get_pieces(Vault& vault, const store::SetFile& file) {
  if (piece_count(file.bytes) == 0) return std::vector<store::ContentHash>();
  if (piece_count(file.bytes) == 1) return std::vector<store::ContentHash>{file.hash};
  for (int tries = 1;; ++tries) {
    const Result<std::optional<std::string>> text = vault.get_unchecked(list_object(file.hash), kMaxListBytes);
    if (!text) return fail(text.error());
    if (!*text) return fail(vault.name(), list_object(file.hash) + " of " + file.path + " isn't there; push the model again");
    Result<std::vector<store::ContentHash>> pieces = decode_pieces(**text, file.bytes);
    if (pieces) return pieces;
    if (tries == kListTries)
      return fail(vault.name(), list_object(file.hash) + " of " + file.path + " isn't taken: " + pieces.error().message + kResend);
  }
}

Result<VaultFetched> fetch(Vault& vault, const std::string& wanted, const VaultFetchOptions& options) {
  return VaultFetch(vault, options).run(wanted);
}

}  // namespace prismesh::ipc::vault
