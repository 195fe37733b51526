#include "ipc/remote/push.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/base64.h"
#include "ipc/store/folder.h"

namespace prismesh::ipc::remote {

namespace {

constexpr std::size_t kMinChunk = std::size_t{64} << 10;
constexpr double kHashingShare = 0.1;  ///< of the progress bar
constexpr int kRoundsMax = 3;
constexpr int kConflictsMax = 20;  // in a row: then the station contradicts itself

std::string base64_of(std::string_view text) { return base64_encode(std::as_bytes(std::span(text.data(), text.size()))); }

/// A file to send.
struct Sending {
  std::filesystem::path disk;
  store::SetFile is;
  store::ContentHash key;  ///< of the book's note
};

class Push {
 public:
  Push(const StationBook& book, const PairedStation& station, const PushOptions& options)
      : book_(book), options_(options), remote_(station, options.remote, [this] { return !told(); }) {}

  Result<Pushed> run(const std::vector<LocalFile>& files, const std::string& main) {
    const Result<store::LocalSet> set = store::hash_local(files, main, [this] { return told(); });
    if (!set) return fail(set.error());
    note(set->contents);
    for (int round = 0; round < kRoundsMax; ++round) {
      const Result<HttpsAnswer> answer = publish(set->text);
      if (!answer) return fail(answer.error());
      if (answer->status == 200 || answer->status == 201) return finish(answer->body, round == 0);
      if (answer->status != 409 || round + 1 == kRoundsMax) return fail(remote_.refusal(*answer, ""));
      done_bytes_ = 0;
      for (const Sending& file : sending_)
        if (const Result<void> sent = send(file); !sent) return fail(sent.error());
    }
    return fail(remote_.station().name, "takes the files, but doesn't publish them");
  }

 private:
  /// False: stop.
  bool told() const { return !options_.progress || options_.progress(fraction_); }
  void advance(std::uint64_t of_this_file) {
    const double all = static_cast<double>(std::max<std::uint64_t>(1, all_bytes_));
    fraction_ = kHashingShare + (1 - kHashingShare) * std::min(1.0, static_cast<double>(done_bytes_ + of_this_file) / all);
  }

  void note(const std::vector<store::LocalContent>& contents) {
    const PairedStation& station = remote_.station();
    for (const store::LocalContent& content : contents) {
      sending_.push_back(
          {content.disk, content.is, store::sha256(station.fingerprint.hex() + " " + station.token_name + " " + content.is.hash.hex())});
      all_bytes_ += content.is.bytes;
    }
  }

  Result<HttpsAnswer> publish(const std::string& text) {
    HttpsRequest request{"POST", "/models", {{"Content-Type", "application/x-prismesh-set"}}, text, true};
    if (!options_.name.empty()) request.headers.emplace_back("Prismesh-Name", base64_of(options_.name));
    return remote_.ask(request);
  }

  Result<Pushed> finish(const std::string& body, bool at_once) {
    for (const Sending& file : sending_) book_.forget_upload(file.key);
    Result<ListedModel> model = parse_listed_model(body);
    if (!model) return fail(remote_.station().name, model.error().message);
    return Pushed{std::move(*model), at_once, sent_bytes_};
  }

  static HttpsRequest of_tus(std::string method, std::string target) {
    return {std::move(method), std::move(target), {{"Tus-Resumable", "1.0.0"}}, {}};
  }

  /// Errors: the header is missing in an answer.
  Result<std::uint64_t> offset_in(const HttpsAnswer& answer) const {
    const std::string_view text = answer.header("upload-offset");
    std::uint64_t offset = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), offset);
    if (text.empty() || failed != std::errc{} || end != text.data() + text.size())
      return fail(remote_.station().name, "doesn't say how far an upload is; is it a prismesh-intake?");
    return offset;
  }

  /// Where an upload that is known goes on. Nothing: the station knows it no more.
  Result<std::optional<std::uint64_t>> offset_of(const std::string& upload) {
    const Result<HttpsAnswer> shown = remote_.ask(of_tus("HEAD", upload));
    if (!shown) return fail(shown.error());
    if (shown->status == 404) return std::optional<std::uint64_t>();
    if (shown->status != 200) return fail(remote_.refusal(*shown, ""));
    const Result<std::uint64_t> offset = offset_in(*shown);
    if (!offset) return fail(offset.error());
    return std::optional(*offset);
  }

  Result<std::string> begin(const Sending& file) {
    HttpsRequest request = of_tus("POST", "/uploads");
    request.headers.emplace_back("Upload-Length", std::to_string(file.is.bytes));
    request.headers.emplace_back("Upload-Metadata", "filename " + base64_of(file.is.path) + ",sha256 " + base64_of(file.is.hash.hex()));
    const Result<HttpsAnswer> begun = remote_.ask(request);
    if (!begun) return fail(begun.error());
    if (begun->status != 201) return fail(remote_.refusal(*begun, file.is.path));
    std::string path(begun->header("location"));
    if (!is_upload_path(path)) return fail(remote_.station().name, "names no upload; is it a prismesh-intake?");
    if (const Result<void> kept = book_.keep_upload(file.key, path); !kept) return fail(kept.error());
    return path;
  }

  static bool is_upload_path(std::string_view path) {
    const auto is_sign = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-'; };
    return path.starts_with("/uploads/") && path.size() > 9 && path.size() <= 200 && std::all_of(path.begin() + 9, path.end(), is_sign);
  }

  /// One chunk; where the upload is after it. Nothing: ask the station.
  Result<std::optional<std::uint64_t>> send_chunk(const Sending& file, const std::string& upload, std::uint64_t at,
                                                  const std::string& chunk) {
    HttpsRequest request = of_tus("PATCH", upload);
    const auto& sum = store::sha256(chunk).bytes;
    request.headers.emplace_back("Content-Type", "application/offset+octet-stream");
    request.headers.emplace_back("Upload-Offset", std::to_string(at));
    request.headers.emplace_back("Upload-Checksum", "sha256 " + base64_encode(std::as_bytes(std::span(sum))));
    request.body = chunk;
    request.has_body = true;
    request.asks_before_body = true;
    std::uint64_t out = 0;
    const LineResult<HttpsAnswer> answer = remote_.ask_once(request, {}, [&](std::uint64_t bytes) {
      out = bytes;
      advance(at + bytes);
    });
    sent_bytes_ += out;
    if (!answer) {
      chunk_bytes_ = std::max(std::min(kMinChunk, options_.chunk_bytes), chunk_bytes_ / 2);
      if (const Result<void> waited = remote_.wait_after(answer.error()); !waited) return fail(waited.error());
      return std::optional<std::uint64_t>();
    }
    if (answer->status == 204) {
      const Result<std::uint64_t> now = offset_in(*answer);
      if (!now) return fail(now.error());
      if (*now <= at) return fail(remote_.station().name, "takes a chunk, but its upload doesn't grow");
      conflicts_ = 0;
      chunk_bytes_ = std::min(options_.chunk_bytes, 2 * chunk_bytes_);
      advance(*now);
      // A quick line never waits, so it wasn't asked meanwhile.
      if (!told()) return fail(cancelled());
      return std::optional(*now);
    }
    // Bytes of a line that was cut came later than the answer to how far the upload is; or the upload is gone.
    if ((answer->status == 409 || answer->status == 404) && ++conflicts_ < kConflictsMax) return std::optional<std::uint64_t>();
    if (answer->status == 460 && at + chunk.size() == file.is.bytes) {
      book_.forget_upload(file.key);
      return fail(file.disk.string(), "changed while it was sent; push it again");
    }
    // A chunk that came with other bytes: TLS doesn't let that happen, so it isn't the line's fault, and it may be the station's memory.
    return fail(remote_.refusal(*answer, file.is.path));
  }

  Result<void> send(const Sending& file) {
    const Result<store::OpenedFile> opened = store::open_local(file.disk);
    if (!opened) return fail(opened.error());
    std::optional<std::string> upload = book_.upload(file.key);
    if (upload && !is_upload_path(*upload)) upload.reset();
    std::optional<std::uint64_t> at;
    std::string chunk;
    while (!at || *at < file.is.bytes) {
      if (!at) {
        if (upload) {
          const Result<std::optional<std::uint64_t>> known = offset_of(*upload);
          if (!known) return fail(known.error());
          at = *known;
          if (!at) upload.reset();
        }
        if (!upload) {
          Result<std::string> begun = begin(file);
          if (!begun) return fail(begun.error());
          upload = std::move(*begun);
          at = 0;
        }
        if (*at > file.is.bytes) return fail(remote_.station().name, "has more of an upload than there is");
        continue;
      }
      advance(*at);
      chunk.resize(static_cast<std::size_t>(std::min<std::uint64_t>(chunk_bytes_, file.is.bytes - *at)));
      const Result<std::size_t> got = store::read_at(opened->file, chunk.data(), chunk.size(), *at, file.disk);
      if (!got) return fail(got.error());
      if (*got != chunk.size()) return fail(file.disk.string(), "became shorter while it was sent; push it again");
      Result<std::optional<std::uint64_t>> now = send_chunk(file, *upload, *at, chunk);
      if (!now) return fail(now.error());
      at = *now;
    }
    done_bytes_ += file.is.bytes;
    return {};
  }

  const StationBook& book_;
  const PushOptions& options_;
  RemoteStation remote_;
  std::vector<Sending> sending_;
  std::uint64_t all_bytes_ = 0, done_bytes_ = 0, sent_bytes_ = 0;
  std::size_t chunk_bytes_ = options_.chunk_bytes;  ///< a line that is always cut carries smaller chunks only; a chunk counts whole or not
  double fraction_ = 0;
  int conflicts_ = 0;
};

}  // namespace

Result<Pushed> push(const StationBook& book, const PairedStation& station, const std::vector<LocalFile>& files, const std::string& main,
                    const PushOptions& options) {
  return Push(book, station, options).run(files, main);
}

}  // namespace prismesh::ipc::remote
