#include "ipc/vault/s3_line.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include <curl/curl.h>

#include "base/progress.h"

namespace prismesh::ipc::vault {

namespace {

constexpr std::size_t kMaxRefusal = std::size_t{64} << 10;
constexpr std::size_t kMaxHeaders = 200;
constexpr long kSilentBytes = 100;  // a second

struct FreeHeaders {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using HeaderList = std::unique_ptr<curl_slist, FreeHeaders>;

/// What one request sends and what comes back.
struct Exchange {
  CURL* handle = nullptr;
  const Stop* stop = nullptr;
  std::string_view body;
  std::size_t sent = 0;
  S3Answer answer;
  std::string* content = nullptr;
  std::size_t max_bytes = 0;
  std::size_t begun = 0;  ///< bytes in `content` before
  bool is_first = true;
  std::string fault;  ///< why the answer isn't taken
  ErrorKind kind = ErrorKind::failure;
  std::chrono::steady_clock::time_point moved = std::chrono::steady_clock::now();
  std::chrono::seconds silence{0};  ///< patience without a byte
  bool is_silent = false;           ///< it is over
};

std::size_t refuse(Exchange& exchange, const char* why) {
  exchange.fault = why;
  return 0;
}

std::size_t take_header(char* bytes, std::size_t, std::size_t size, void* held) {
  Exchange& exchange = *static_cast<Exchange*>(held);
  exchange.moved = std::chrono::steady_clock::now();
  std::string_view line(bytes, size);
  while (line.ends_with('\n') || line.ends_with('\r')) line.remove_suffix(1);
  if (line.starts_with("HTTP/")) {
    exchange.answer.headers.clear();  // those of an interim answer
    return size;
  }
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return size;
  if (exchange.answer.headers.size() >= kMaxHeaders) return refuse(exchange, "its answer has too many headers");
  std::string name(line.substr(0, colon));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  line.remove_prefix(colon + 1);
  while (line.starts_with(' ')) line.remove_prefix(1);
  exchange.answer.headers[std::move(name)] = std::string(line);
  return size;
}

std::size_t take_body(char* bytes, std::size_t, std::size_t size, void* held) {
  Exchange& exchange = *static_cast<Exchange*>(held);
  exchange.moved = std::chrono::steady_clock::now();
  long status = 0;
  curl_easy_getinfo(exchange.handle, CURLINFO_RESPONSE_CODE, &status);
  if (status != 200 && status != 206) {
    exchange.answer.body.append(bytes, std::min(size, kMaxRefusal - std::min(kMaxRefusal, exchange.answer.body.size())));
    return size;
  }
  std::string& content = *exchange.content;
  if (std::exchange(exchange.is_first, false) && exchange.begun > 0) {
    const std::string part = "bytes " + std::to_string(exchange.begun) + "-";
    if (status == 200) content.clear();  // a store may give the whole
    if (status == 206 && !exchange.answer.header("content-range").starts_with(part))
      return refuse(exchange, "it gives another part of an object than the one asked for");
  }
  if (size > exchange.max_bytes - content.size()) {
    exchange.kind = ErrorKind::over_limit;
    return refuse(exchange, "an object is longer than it was");
  }
  content.append(bytes, size);
  return size;
}

std::size_t give_body(char* bytes, std::size_t, std::size_t size, void* held) {
  Exchange& exchange = *static_cast<Exchange*>(held);
  exchange.moved = std::chrono::steady_clock::now();
  const std::string_view piece = exchange.body.substr(exchange.sent, size);
  std::memcpy(bytes, piece.data(), piece.size());
  exchange.sent += piece.size();
  return piece.size();
}

/// libcurl sends a body again where a kept connection was closed meanwhile.
int seek_body(void* held, curl_off_t offset, int origin) {
  Exchange& exchange = *static_cast<Exchange*>(held);
  if (origin != SEEK_SET || offset < 0 || static_cast<std::size_t>(offset) > exchange.body.size()) return CURL_SEEKFUNC_FAIL;
  exchange.sent = static_cast<std::size_t>(offset);
  return CURL_SEEKFUNC_OK;
}

int ask_stop(void* held, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  Exchange& exchange = *static_cast<Exchange*>(held);
  // libcurl's own limit looks at the mean speed of some seconds, so that it takes longer behind a fast beginning.
  exchange.is_silent = std::chrono::steady_clock::now() - exchange.moved > exchange.silence;
  return exchange.is_silent || (*exchange.stop && (*exchange.stop)()) ? 1 : 0;
}

/// Whether another try may have another end.
bool passes(CURLcode code) {
  switch (code) {
    case CURLE_COULDNT_RESOLVE_PROXY:
    case CURLE_COULDNT_RESOLVE_HOST:
    case CURLE_COULDNT_CONNECT:
    case CURLE_PARTIAL_FILE:
    case CURLE_OPERATION_TIMEDOUT:
    case CURLE_SSL_CONNECT_ERROR:
    case CURLE_GOT_NOTHING:
    case CURLE_SEND_ERROR:
    case CURLE_RECV_ERROR:
    case CURLE_SEND_FAIL_REWIND:
    case CURLE_AGAIN: return true;
    default: return false;
  }
}

void add_header(HeaderList& list, const std::string& header) {
  curl_slist* longer = curl_slist_append(list.get(), header.c_str());
  if (longer == nullptr) throw std::bad_alloc();
  (void)list.release();
  list.reset(longer);
}

}  // namespace

std::string_view S3Answer::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? std::string_view() : found->second;
}

struct S3Line::Impl {
  struct FreeHandle {
    void operator()(CURL* held) const { curl_easy_cleanup(held); }
  };

  VaultAddress address;
  VaultSettings keys;
  S3Patience patience;
  Stop stop;
  std::unique_ptr<CURL, FreeHandle> handle;  ///< keeps the connection
  std::chrono::steady_clock::time_point moved = {};

  /// Errors: why libcurl refuses a setting; then nothing may be sent.
  CURLcode prepare(const S3Request& request, Exchange& exchange, const HeaderList& headers) const {
    CURL* const curl = handle.get();
    CURLcode refused = CURLE_OK;
    const auto set = [&refused](CURL* on, CURLoption option, auto value) {
      if (refused == CURLE_OK) refused = curl_easy_setopt(on, option, value);
    };
    curl_easy_reset(curl);  // keeps the connection
    const std::string place =
        address.origin() + "/" + address.bucket + (request.object.empty() ? "" : "/" + address.folder + request.object);
    set(curl, CURLOPT_URL, (place + (request.query.empty() ? "" : "?" + request.query)).c_str());
    set(curl, CURLOPT_PROTOCOLS_STR, address.is_plain ? "http" : "https");
    set(curl, CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
    set(curl, CURLOPT_PATH_AS_IS, 1L);
    set(curl, CURLOPT_NOSIGNAL, 1L);
    if (address.is_loopback()) set(curl, CURLOPT_NOPROXY, "*");
    set(curl, CURLOPT_AWS_SIGV4, ("aws:amz:" + keys.region + ":s3").c_str());
    set(curl, CURLOPT_USERNAME, keys.access_key_id.c_str());
    set(curl, CURLOPT_PASSWORD, keys.secret_access_key.c_str());
    if (!keys.authorities.empty()) set(curl, CURLOPT_CAINFO, keys.authorities.c_str());
    set(curl, CURLOPT_HTTPHEADER, headers.get());
    set(curl, CURLOPT_CONNECTTIMEOUT, static_cast<long>(patience.connect.count()));
    set(curl, CURLOPT_LOW_SPEED_LIMIT, kSilentBytes);
    set(curl, CURLOPT_LOW_SPEED_TIME, static_cast<long>(patience.silence.count()));
    set(curl, CURLOPT_NOPROGRESS, 0L);
    set(curl, CURLOPT_XFERINFOFUNCTION, ask_stop);
    set(curl, CURLOPT_XFERINFODATA, &exchange);
    set(curl, CURLOPT_HEADERFUNCTION, take_header);
    set(curl, CURLOPT_HEADERDATA, &exchange);
    set(curl, CURLOPT_WRITEFUNCTION, take_body);
    set(curl, CURLOPT_WRITEDATA, &exchange);
    if (request.method == S3Request::Method::head) set(curl, CURLOPT_NOBODY, 1L);
    if (request.method == S3Request::Method::get && exchange.begun > 0)
      set(curl, CURLOPT_RANGE, (std::to_string(exchange.begun) + "-").c_str());
    if (request.method == S3Request::Method::put) {
      set(curl, CURLOPT_UPLOAD, 1L);
      set(curl, CURLOPT_INFILESIZE_LARGE, static_cast<curl_off_t>(request.body.size()));
      set(curl, CURLOPT_READFUNCTION, give_body);
      set(curl, CURLOPT_READDATA, &exchange);
      set(curl, CURLOPT_SEEKFUNCTION, seek_body);
      set(curl, CURLOPT_SEEKDATA, &exchange);
    }
    return refused;
  }

  LineFault fault(CURLcode code, const Exchange& exchange) const {
    const std::string where = address.text();
    if (code == CURLE_ABORTED_BY_CALLBACK && !exchange.is_silent) return {cancelled(), false};
    if (!exchange.fault.empty()) return {Error{where, 0, exchange.fault, exchange.kind}, false};
    if (code == CURLE_PEER_FAILED_VERIFICATION)
      return {Error{where, 0,
                    "its certificate is that of another host, or no authority that this computer trusts vouches for it; nothing was sent"},
              false};
    if (code == CURLE_SSL_CACERT_BADFILE) return {Error{keys.authorities, 0, "can't be read as certificates; nothing was sent"}, false};
    if (code == CURLE_OPERATION_TIMEDOUT || exchange.is_silent) return {Error{where, 0, "it doesn't answer"}, true};
    return {Error{where, 0, std::string("the request failed: ") + curl_easy_strerror(code)}, passes(code)};
  }
};

S3Line::S3Line(VaultAddress address, const VaultSettings& keys, S3Patience patience, Stop stop)
    : impl_(new Impl{std::move(address), keys, patience, std::move(stop), nullptr, {}}) {
  impl_->handle.reset(curl_easy_init());
  if (!impl_->handle) throw std::bad_alloc();
}
S3Line::S3Line(S3Line&&) noexcept = default;
S3Line& S3Line::operator=(S3Line&&) noexcept = default;
S3Line::~S3Line() = default;

const VaultAddress& S3Line::address() const { return impl_->address; }
std::chrono::steady_clock::time_point S3Line::moved() const { return impl_->moved; }

LineResult<S3Answer> S3Line::ask(const S3Request& request, std::string& content, std::size_t max_bytes) {
  Exchange exchange;
  exchange.handle = impl_->handle.get();
  exchange.stop = &impl_->stop;
  exchange.body = request.body;
  exchange.content = &content;
  exchange.max_bytes = max_bytes;
  exchange.silence = impl_->patience.silence;
  if (request.object.empty()) content.clear();  // a list may differ from that of the earlier try
  exchange.begun = request.method == S3Request::Method::get ? content.size() : 0;
  HeaderList headers;
  // libcurl 7.88 takes the payload's hash for the signature from here, so that the store compares the body with it.
  add_header(headers, "x-amz-content-sha256: " + request.body_hash.hex());
  if (!impl_->keys.session_token.empty()) add_header(headers, "x-amz-security-token: " + impl_->keys.session_token);
  CURLcode code = impl_->prepare(request, exchange, headers);
  if (code == CURLE_OK) code = curl_easy_perform(impl_->handle.get());
  impl_->moved = exchange.moved;
  if (code != CURLE_OK) return tl::unexpected(impl_->fault(code, exchange));
  long status = 0;
  curl_easy_getinfo(impl_->handle.get(), CURLINFO_RESPONSE_CODE, &status);
  exchange.answer.status = static_cast<unsigned>(status);
  return std::move(exchange.answer);
}

}  // namespace prismesh::ipc::vault
