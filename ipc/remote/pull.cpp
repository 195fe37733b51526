#include "ipc/remote/pull.h"

#include <algorithm>
#include <set>
#include <utility>

#include <unistd.h>

#include "ipc/store/choosing.h"
#include "ipc/store/folder.h"
#include "ipc/store/receiving.h"

namespace prismesh::ipc::remote {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPullHashPiece = std::size_t{4} << 20;
constexpr const char* kUnfinished = ".pulling";

/// The manifest's own text, whose hash is the model's: a station can't give another one out.
Result<store::Manifest> fetch_manifest(RemoteStation& remote, const store::ContentHash& model) {
  const Result<HttpsAnswer> answer = remote.ask({"GET", "/models/" + model.hex() + "/manifest", {}, {}});
  if (!answer) return fail(answer.error());
  const std::string& station = remote.station().name;
  if (answer->status == 404) return fail(station, "has no such model any more; `prismesh stations models` lists those there are");
  if (answer->status != 200) return fail(remote.refusal(*answer, "the model"));
  Result<store::Manifest> manifest = store::decode_manifest(answer->body);
  if (!manifest) return fail(station, "gives a list of files that isn't taken: " + manifest.error().message);
  if (store::model_hash(answer->body) != model) return fail(station, "gives another model than the one asked for; nothing was written");
  return manifest;
}

class Pull {
 public:
  Pull(const PairedStation& station, const PullOptions& options)
      : options_(options), remote_(station, options.remote, [this] { return !told(); }) {}

  Result<Pulled> run(const std::string& wanted) {
    Result<ListedModel> model = find_model(remote_, wanted);
    if (!model) return fail(model.error());
    const Result<store::Manifest> manifest = fetch_manifest(remote_, model->record.model);
    if (!manifest) return fail(manifest.error());
    const fs::path folder = options_.folder.value_or(store::usual_folder(*manifest, model->record.model));
    const Result<store::Receiving> receiving = store::Receiving::begin(folder, kUnfinished);
    if (!receiving) return fail(receiving.error());
    all_bytes_ = manifest->bytes();
    if (const Result<void> fetched = fetch_all(*manifest, model->record.model, *receiving); !fetched) return fail(fetched.error());
    if (const Result<void> finished = receiving->finish(*manifest, [this] { return !told(); }); !finished) return fail(finished.error());
    return Pulled{std::move(*model), folder, folder / manifest->main, received_bytes_};
  }

 private:
  bool told() const { return !options_.progress || options_.progress(fraction_); }
  void advance(std::uint64_t of_this_file) {
    fraction_ =
        std::min(1.0, static_cast<double>(done_bytes_ + of_this_file) / static_cast<double>(std::max<std::uint64_t>(1, all_bytes_)));
  }

  /// The files by their hashes, as a store has them: names of theirs come into play only when all is there.
  Result<void> fetch_all(const store::Manifest& manifest, const store::ContentHash& model, const store::Receiving& receiving) {
    std::set<store::ContentHash> known;
    for (const store::SetFile& file : manifest.files) {
      if (known.insert(file.hash).second) {
        const Result<store::ReceivedFile> received = receiving.file(file.hash);
        if (!received) return fail(received.error());
        if (const Result<void> fetched = fetch(file, model, *received); !fetched) return fetched;
      }
      done_bytes_ += file.bytes;
    }
    return {};
  }

  /// What is there of the file, hashed.
  Result<std::uint64_t> hash_begun(const Descriptor& file, const fs::path& shown, std::uint64_t max_bytes, store::Sha256& sum) const {
    std::string piece(kPullHashPiece, '\0');
    std::uint64_t at = 0;
    while (at < max_bytes) {
      const std::size_t size = static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), max_bytes - at));
      const Result<std::size_t> got = store::read_at(file, piece.data(), size, at, shown);
      if (!got) return fail(got.error());
      sum.add(std::string_view(piece.data(), *got));
      at += *got;
      if (*got < size) break;
      if (!told()) return fail(cancelled());
    }
    return at;
  }

  Result<void> fetch(const store::SetFile& file, const store::ContentHash& model, const store::ReceivedFile& received) {
    const Descriptor& disk = received.disk;
    const fs::path& shown = received.shown;
    store::Sha256 sum;
    const Result<std::uint64_t> begun = hash_begun(disk, shown, file.bytes, sum);
    if (!begun) return fail(begun.error());
    std::uint64_t at = *begun;
    bool begins_anew = false;
    for (;;) {
      if (::ftruncate(disk.get(), static_cast<off_t>(at)) != 0) return fail(shown.string(), "can't be written");
      while (at < file.bytes)
        if (const Result<void> some = fetch_rest(file, model, disk, shown, at, sum); !some) return some;
      if (sum.hash() == file.hash) return {};
      // What an earlier call left may have been changed; what this one fetched was not.
      if (std::exchange(begins_anew, true) || !received.is_begun)
        return fail(remote_.station().name, "gives other bytes than the model has for " + file.path);
      at = 0;
      sum = store::Sha256();
    }
  }

  /// Until the line is cut, or the file's end.
  Result<void> fetch_rest(const store::SetFile& file, const store::ContentHash& model, const Descriptor& disk, const fs::path& shown,
                          std::uint64_t& at, store::Sha256& sum) {
    HttpsRequest request{"GET", "/models/" + model.hex() + "/files/" + file.hash.hex(), {}, {}};
    const bool is_part = at > 0;
    if (is_part) request.headers.emplace_back("Range", "bytes=" + std::to_string(at) + "-");
    const std::string expected = "bytes " + std::to_string(at) + "-" + std::to_string(file.bytes - 1) + "/" + std::to_string(file.bytes);
    const BodySink sink = [&](const HttpsAnswer& head, std::string_view bytes) -> Result<void> {
      if (is_part ? head.status != 206 || head.header("content-range") != expected : head.status != 200)
        return fail(remote_.station().name, "gives another part of a file than the one asked for");
      if (bytes.size() > file.bytes - at) return fail(remote_.station().name, "gives more bytes than the model has for " + file.path);
      if (const Result<void> written = store::write_at(disk, bytes, at, shown); !written) return written;
      sum.add(bytes);
      at += bytes.size();
      received_bytes_ += bytes.size();
      remote_.line_is_good();
      advance(at);
      return {};
    };
    const std::uint64_t before = at;
    const LineResult<HttpsAnswer> answer = remote_.ask_once(request, sink);
    if (!answer) return remote_.wait_after(answer.error());
    if (answer->status != 200 && answer->status != 206) return fail(remote_.refusal(*answer, file.path));
    if (at == before) return fail(remote_.station().name, "gives nothing of " + file.path);
    // A quick line never waits, so it wasn't asked meanwhile.
    if (!told()) return fail(cancelled());
    return {};
  }

  const PullOptions& options_;
  RemoteStation remote_;
  std::uint64_t all_bytes_ = 0, done_bytes_ = 0, received_bytes_ = 0;
  double fraction_ = 0;
};

}  // namespace

Result<ListedModel> find_model(RemoteStation& remote, const std::string& wanted) {
  Result<std::vector<ListedModel>> all = remote.models();
  if (!all) return fail(all.error());
  std::vector<store::ModelRecord> records;
  for (const ListedModel& model : *all) records.push_back(model.record);
  const Result<std::size_t> chosen = store::choose_model(records, wanted, remote.station().name, "prismesh stations models");
  if (!chosen) return fail(chosen.error());
  return std::move((*all)[*chosen]);
}

Result<Pulled> pull(const PairedStation& station, const std::string& wanted, const PullOptions& options) {
  return Pull(station, options).run(wanted);
}

}  // namespace prismesh::ipc::remote
