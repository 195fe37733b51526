#include "daemon/intake/api/tus.h"

#include <ctime>
#include <map>

#include "daemon/intake/http/fields.h"

namespace prismesh::intake {

namespace {

/// As RFC 9110, 5.6.7, writes it.
std::string http_date(std::int64_t when_s) {
  constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const auto time = static_cast<std::time_t>(when_s);
  std::tm parts{};
  if (::gmtime_r(&time, &parts) == nullptr) return {};
  const auto two = [](int number) { return std::string(number < 10 ? "0" : "") + std::to_string(number); };
  return std::string(kDays[parts.tm_wday]) + ", " + two(parts.tm_mday) + " " + kMonths[parts.tm_mon] + " " +
         std::to_string(1900 + parts.tm_year) + " " + two(parts.tm_hour) + ":" + two(parts.tm_min) + ":" + two(parts.tm_sec) + " GMT";
}

}  // namespace

bool needs_tus_version(Operation operation) {
  return operation == Operation::begin_upload || operation == Operation::show_upload || operation == Operation::continue_upload ||
         operation == Operation::end_upload;
}

std::optional<HttpResponse> check_tus_version(const HttpRequest& request) {
  if (request.header("tus-resumable") == kTusVersion) return std::nullopt;
  HttpResponse response = error_response(412, "the request must say Tus-Resumable: 1.0.0");
  response.headers.emplace_back("Tus-Version", kTusVersion);
  return response;
}

HttpResponse tus_description(std::uint64_t max_file_bytes) {
  return {204,
          {{"Tus-Resumable", kTusVersion},
           {"Tus-Version", kTusVersion},
           {"Tus-Max-Size", std::to_string(max_file_bytes)},
           {"Tus-Extension", "creation,expiration,checksum,termination"},
           {"Tus-Checksum-Algorithm", std::string(kChecksumAlgorithms)}},
          std::string(),
          std::nullopt,
          nullptr};
}

Result<NewUpload> parse_new_upload(const HttpRequest& request, const std::string& who) {
  NewUpload upload{who, 0, {}, std::nullopt};
  const std::optional<std::string_view> length = request.header("upload-length");
  const std::optional<std::uint64_t> bytes = length ? parse_size(*length) : std::nullopt;
  if (!bytes) return fail("Upload-Length", "must be the file's length in bytes");
  upload.length = *bytes;
  const std::optional<std::string_view> header = request.header("upload-metadata");
  if (!header) return upload;
  const Result<std::map<std::string, std::string>> metadata = parse_upload_metadata(*header);
  if (!metadata) return fail(metadata.error());
  upload.metadata = *header;
  const auto hash = metadata->find("sha256");
  if (hash == metadata->end()) return upload;
  upload.expected = ipc::store::parse_content_hash(hash->second);
  if (!upload.expected) return fail("Upload-Metadata", "sha256 must be 64 hexadecimal digits in small letters");
  return upload;
}

HttpResponse upload_response(unsigned status, const UploadStatus& upload, std::int64_t now_s) {
  return {status,
          {{"Tus-Resumable", kTusVersion},
           {"Upload-Offset", std::to_string(upload.offset)},
           {"Upload-Expires", http_date(now_s + upload.expires_in_s)},
           {"Cache-Control", "no-store"}},
          std::string(),
          std::nullopt,
          nullptr};
}

HttpResponse shown_upload(const UploadStatus& upload, std::int64_t now_s) {
  HttpResponse response = upload_response(200, upload, now_s);
  response.headers.emplace_back("Upload-Length", std::to_string(upload.length));
  if (!upload.metadata.empty()) response.headers.emplace_back("Upload-Metadata", upload.metadata);
  return response;
}

}  // namespace prismesh::intake
