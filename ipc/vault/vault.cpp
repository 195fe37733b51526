#include "ipc/vault/vault.h"

#include <algorithm>
#include <charconv>
#include <ctime>
#include <map>
#include <utility>

#include "base/progress.h"
#include "ipc/store/utf8.h"
#include "ipc/vault/objects.h"

namespace prismesh::ipc::vault {

namespace {

using Method = S3Request::Method;

constexpr std::size_t kMaxListed = 200'000;
constexpr std::size_t kMaxRegion = 100;
constexpr std::size_t kMaxKey = 1024;  // S3 has no longer ones

constexpr int kWrongBytesMax = 3;  // in a row: then it isn't chance
constexpr std::size_t kMaxListing = std::size_t{16} << 20;
constexpr std::string_view kObjectsAtOnce = "1000";
constexpr int kListsMax = 500;

/// RFC 3986, as signatures have it.
std::string percent_encoded(std::string_view text) {
  constexpr std::string_view kUpperDigits = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.' || c == '~';
    if (is_plain) {
      encoded += c;
    } else {
      encoded += '%';
      encoded += kUpperDigits[static_cast<unsigned char>(c) >> 4];
      encoded += kUpperDigits[static_cast<unsigned char>(c) & 15];
    }
  }
  return encoded;
}

bool is_for_a_while(unsigned status) { return status == 408 || status == 429 || status == 500 || (status >= 502 && status <= 504); }

/// Refusals of a body that came otherwise than it was sent.
bool is_about_the_body(const std::string& code) {
  return code == "BadDigest" || code == "XAmzContentSHA256Mismatch" || code == "InvalidDigest";
}

/// 400, for a line that was cut or silent: no fault of what was asked.
bool is_about_the_line(const S3Answer& answer) {
  if (answer.status != 400) return false;
  const std::string code = parse_refusal(answer.body).code;
  return code == "IncompleteBody" || code == "RequestTimeout";
}

}  // namespace

Vault::Vault(VaultAddress address, const VaultSettings& keys, VaultOptions options, Stop stop)
    : line_(std::move(address), keys, options.line, stop), retrying_(options.retry, std::move(stop)) {}

Error Vault::refusal(const S3Answer& answer) const {
  const S3Refusal said = parse_refusal(answer.body);
  const std::string words =
      said.code.empty() ? "status " + std::to_string(answer.status) : said.code + (said.message.empty() ? "" : ": " + said.message);
  const auto told = [&](const std::string& message) { return Error{name(), 0, message}; };
  if (said.code == "NoSuchBucket")
    return told("there is no bucket '" + line_.address().bucket + "'; make it there first, or correct the address");
  if (said.code == "RequestTimeTooSkewed") return told("this computer's clock differs from the store's; set it");
  if (answer.status == 301 || answer.status == 307 || said.code == "AuthorizationHeaderMalformed") {
    const std::string region(answer.header("x-amz-bucket-region"));
    const bool is_shown = !region.empty() && region.size() <= kMaxRegion && store::is_plain_utf8(region);
    return told("the bucket has another region or address (" + words + "); set AWS_REGION" + (is_shown ? "=" + region : "") +
                ", or correct the address" + (said.endpoint.empty() ? "" : ": its host is " + said.endpoint));
  }
  if (is_for_a_while(answer.status) || is_about_the_line(answer)) return told("can't answer now (" + words + ")");
  if (answer.status == 401 || answer.status == 403) return told("refuses these keys, or they may not do this (" + words + ")");
  return told(words);
}

Result<S3Answer> Vault::ask(const S3Request& request, std::string& content, std::size_t max_bytes) {
  // A store that knows no parts begins anew each time: only what no try brought before is progress.
  for (std::size_t most = content.size();;) {
    LineResult<S3Answer> answer = line_.ask(request, content, max_bytes);
    if (answer && answer->status == 416 && !content.empty()) {
      content.clear();  // all bytes had come, but not the answer's end
      answer = tl::unexpected(LineFault{refusal(*answer), true});
    }
    if (answer && (is_for_a_while(answer->status) || is_about_the_line(*answer)))
      answer = tl::unexpected(LineFault{refusal(*answer), true});
    const bool is_progress = content.size() > most;
    most = std::max(most, content.size());
    if (answer || is_progress) retrying_.line_is_good();
    if (answer) return std::move(*answer);
    const Result<void> waited = retrying_.wait_after(answer.error(), line_.moved());
    if (!waited) return fail(waited.error());
  }
}

Result<std::optional<std::uint64_t>> Vault::size_of(const std::string& object) {
  std::string none;
  const Result<S3Answer> answer = ask({Method::head, object, "", {}}, none, 0);
  if (!answer) return fail(answer.error());
  if (answer->status == 404) return std::optional<std::uint64_t>();
  if (answer->status != 200) return fail(refusal(*answer));
  const std::string_view text = answer->header("content-length");
  std::uint64_t bytes = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), bytes);
  if (text.empty() || failed != std::errc{} || end != text.data() + text.size())
    return fail(name(), "doesn't say how large an object is; is it an S3 store?");
  return std::optional(bytes);
}

Result<std::optional<std::string>> Vault::get_unchecked(const std::string& object, std::size_t max_bytes) {
  std::string content;
  const Result<S3Answer> answer = ask({Method::get, object, "", {}}, content, max_bytes);
  if (!answer) return fail(answer.error());
  if (answer->status == 404 && parse_refusal(answer->body).code != "NoSuchBucket") return std::optional<std::string>();
  if (answer->status != 200 && answer->status != 206) return fail(refusal(*answer));
  return std::optional(std::move(content));
}

Result<std::optional<std::string>> Vault::get(const std::string& object, const store::ContentHash& hash, std::size_t max_bytes) {
  for (int tries = 0; tries < kWrongBytesMax; ++tries) {
    Result<std::optional<std::string>> content = get_unchecked(object, max_bytes);
    if (!content || !*content || store::sha256(**content) == hash) return content;
  }
  return fail(name(), "gives other bytes for " + object + " than its name says; nothing of them was used");
}

Result<void> Vault::put(const std::string& object, std::string_view bytes, const store::ContentHash& hash) {
  for (int tries = 1;; ++tries) {
    std::string none;
    const Result<S3Answer> answer = ask({Method::put, object, "", bytes, hash}, none, kMaxListing);
    if (!answer) return fail(answer.error());
    if (answer->status == 200 || answer->status == 201) return {};
    const std::string code = parse_refusal(answer->body).code;
    if (!is_about_the_body(code)) return fail(refusal(*answer));
    if (tries == kWrongBytesMax)
      return fail(name(), "gets other bytes of " + object + " than were sent (" + code + "); the line changes them");
  }
}

Result<std::vector<ListedObject>> Vault::list(std::string_view beginning) {
  const std::string& folder = line_.address().folder;
  std::vector<ListedObject> all;
  std::string next;
  int lists = 0;
  do {
    if (++lists > kListsMax) return fail(name(), "lists more than " + std::to_string(kListsMax) + " times a thousand objects");
    // The keys ascend, for the signature.
    std::string query = next.empty() ? "" : "continuation-token=" + percent_encoded(next) + "&";
    query += "list-type=2&max-keys=" + std::string(kObjectsAtOnce) + "&prefix=" + percent_encoded(folder + std::string(beginning));
    std::string body;
    const Result<S3Answer> answer = ask({Method::get, "", query, {}}, body, kMaxListing);
    if (!answer) return fail(answer.error());
    if (answer->status != 200 && answer->status != 206) return fail(refusal(*answer));
    Result<ObjectList> some = parse_object_list(body);
    if (!some) return fail(name(), some.error().message);
    if (some->next == next && !next.empty()) return fail(name(), "lists the same objects again and again");
    next = std::move(some->next);
    for (ListedObject& object : some->objects) {
      if (!object.key.starts_with(folder) || object.key.size() > kMaxKey) continue;
      if (all.size() == kMaxListed)
        return fail(Error{
            name(), 0,
            "has more than " + std::to_string(kMaxListed) + " objects named " + std::string(beginning) + "..; " + "no vault is so large",
            ErrorKind::over_limit});
      object.key.erase(0, folder.size());
      all.push_back(std::move(object));
    }
  } while (!next.empty());
  return all;
}

Result<std::vector<store::ModelRecord>> models(Vault& vault, std::string_view preferred) {
  const std::int64_t now_s = std::time(nullptr);
  const Result<std::vector<ListedObject>> there = vault.list(kModels);
  if (!there) return fail(there.error());
  const Result<std::vector<ListedObject>> names = vault.list(kNames);
  if (!names) return fail(names.error());
  std::map<store::ContentHash, store::ModelRecord> newest;
  for (const ListedObject& object : *names)
    if (auto record = record_of_object(object.key)) {
      store::ModelRecord& known = newest[record->model];
      const bool is_preferred = record->name == preferred, has_preferred = known.name == preferred;
      if (known.name.empty() || (is_preferred != has_preferred ? is_preferred : is_newer_name(*record, known, now_s)))
        known = std::move(*record);
    }
  std::vector<store::ModelRecord> all;
  for (const ListedObject& object : *there)
    if (const auto model = model_of_object(object.key)) {
      store::ModelRecord& record = newest[*model];
      record.model = *model;
      all.push_back(record);
    }
  std::sort(all.begin(), all.end(), [](const store::ModelRecord& a, const store::ModelRecord& b) {
    return a.when_s != b.when_s ? a.when_s > b.when_s : a.model < b.model;
  });
  return all;
}

}  // namespace prismesh::ipc::vault
