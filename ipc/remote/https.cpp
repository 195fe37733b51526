#include "ipc/remote/https.h"

#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <algorithm>
#include <array>
#include <optional>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>

#include "base/progress.h"

namespace prismesh::ipc::remote {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using tcp = asio::ip::tcp;
using ErrorCode = boost::system::error_code;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr std::chrono::milliseconds kStopTurn{100};
constexpr std::size_t kPieceBytes = std::size_t{256} << 10;
constexpr std::size_t kMaxBody = std::size_t{16} << 20;
constexpr std::uint32_t kMaxHeader = std::uint32_t{64} << 10;
constexpr std::uint64_t kAnyBody = std::uint64_t{1} << 62;  // sinks and kMaxBody limit it

using AnswerParser = http::response_parser<http::buffer_body>;

/// A request's head. What would end a line is refused: no header may be smuggled in.
Result<std::string> head_of(const HttpsRequest& request, const StationAddress& station) {
  std::string text = request.method + " " + request.target + " HTTP/1.1\r\nHost: " + station.text() + "\r\n";
  for (const auto& [name, value] : request.headers) {
    if ((name + value).find_first_of("\r\n") != std::string::npos) return fail(station.text(), "a header can't have line ends");
    text += name + ": " + value + "\r\n";
  }
  if (request.has_body) text += "Content-Length: " + std::to_string(request.body.size()) + "\r\n";
  if (request.asks_before_body) text += "Expect: 100-continue\r\n";
  return text + "\r\n";
}

store::ContentHash fingerprint_of(SSL* tls) {
  store::ContentHash hash;
  X509* certificate = SSL_get1_peer_certificate(tls);
  unsigned size = 0;
  if (certificate != nullptr) X509_digest(certificate, EVP_sha256(), hash.bytes.data(), &size);
  X509_free(certificate);
  return hash;
}

}  // namespace

std::string_view HttpsAnswer::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? std::string_view() : found->second;
}

struct HttpsLine::Impl {
  Impl(StationAddress given, const LinePatience& patience_given, Stop stop_given)
      : station(std::move(given)), patience(patience_given), stop(std::move(stop_given)) {}

  StationAddress station;
  LinePatience patience;
  Stop stop;
  asio::io_context io{1};
  asio::ssl::context tls{asio::ssl::context::tls_client};
  asio::ssl::stream<tcp::socket> stream{io, tls};
  beast::flat_buffer buffer;
  store::ContentHash fingerprint;
  bool open = false;
  bool stopped = false;

  /// Starts something and waits for its end, the patience's or the user's.
  template <class Start>
  ErrorCode wait(std::chrono::milliseconds limit, Start start) {
    std::optional<ErrorCode> result;
    io.restart();
    start([&result](const ErrorCode& error, auto&&...) { result = error; });
    const SteadyClock::time_point end = SteadyClock::now() + limit;
    while (!result) {
      io.run_one_for(kStopTurn);
      if (result) break;
      stopped = stopped || (stop && stop());
      if (!stopped && SteadyClock::now() < end) continue;
      ErrorCode ignored;
      stream.lowest_layer().close(ignored);
      io.restart();
      io.run();
      return asio::error::timed_out;
    }
    return *result;
  }

  tl::unexpected<LineFault> fault(const std::string& what, const ErrorCode& error) {
    open = false;
    if (stopped) return tl::unexpected(LineFault{cancelled(), false});
    const std::string why = error == asio::error::timed_out ? "it doesn't answer" : error.message();
    return tl::unexpected(LineFault{Error{station.text(), 0, what + ": " + why}, true});
  }
  tl::unexpected<LineFault> refuse(Error error) {
    open = false;
    return tl::unexpected(LineFault{std::move(error), false});
  }

  LineResult<void> connect() {
    SSL_CTX* context = tls.native_handle();
    if (SSL_CTX_set_min_proto_version(context, TLS1_3_VERSION) != 1) return refuse(Error{station.text(), 0, "TLS 1.3 isn't there"});
    tcp::resolver resolver(io);
    tcp::resolver::results_type found;
    ErrorCode error = wait(patience.connect, [&](auto done) {
      resolver.async_resolve(station.host, std::to_string(station.port), [&found, done](const ErrorCode& failed, const auto& results) {
        found = results;
        done(failed);
      });
    });
    if (error) return fault("can't be found in the network", error);
    error = wait(patience.connect, [&](auto done) { asio::async_connect(stream.lowest_layer(), found, done); });
    if (error) return fault("can't be reached; see that it is on, and that its prismesh-intake runs", error);
    ErrorCode ignored;
    stream.lowest_layer().set_option(tcp::no_delay(true), ignored);
    // Who the station is says its certificate's hash, which is compared before anything is sent.
    stream.set_verify_mode(asio::ssl::verify_none);
    error = wait(patience.connect, [&](auto done) { stream.async_handshake(asio::ssl::stream_base::client, done); });
    if (error) return fault("no encrypted connection could be made (TLS 1.3 is needed)", error);
    fingerprint = fingerprint_of(stream.native_handle());
    open = true;
    return {};
  }

  ErrorCode write(std::string_view bytes) {
    return wait(patience.silence, [&](auto done) { asio::async_write(stream, asio::buffer(bytes.data(), bytes.size()), done); });
  }

  ErrorCode write_body(std::string_view body, const std::function<void(std::uint64_t)>& sent) {
    for (std::size_t at = 0; at < body.size(); at += kPieceBytes) {
      const std::string_view piece = body.substr(at, kPieceBytes);
      if (const ErrorCode error = write(piece)) return error;
      if (sent) sent(at + piece.size());
    }
    return {};
  }

  ErrorCode read_head(AnswerParser& parser) {
    parser.header_limit(kMaxHeader);
    parser.body_limit(kAnyBody);
    return wait(patience.silence, [&](auto done) { http::async_read_header(stream, buffer, parser, done); });
  }

  static HttpsAnswer answer_of(const AnswerParser& parser) {
    HttpsAnswer answer;
    answer.status = parser.get().result_int();
    for (const auto& field : parser.get()) {
      std::string name(field.name_string());
      std::transform(name.begin(), name.end(), name.begin(),
                     [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
      answer.headers[name] = std::string(field.value());
    }
    return answer;
  }

  LineResult<void> read_body(AnswerParser& parser, HttpsAnswer& answer, const BodySink& sink) {
    const bool is_taken = sink && (answer.status == 200 || answer.status == 206);
    std::vector<char> piece(kPieceBytes);
    while (!parser.is_done()) {
      parser.get().body().data = piece.data();
      parser.get().body().size = piece.size();
      const ErrorCode error = wait(patience.silence, [&](auto done) { http::async_read_some(stream, buffer, parser, done); });
      const std::string_view got(piece.data(), piece.size() - parser.get().body().size);
      if (is_taken && !got.empty()) {
        if (const Result<void> taken = sink(answer, got); !taken) return refuse(taken.error());
      } else if (!got.empty()) {
        if (answer.body.size() + got.size() > kMaxBody) return refuse(Error{station.text(), 0, "its answer is too long"});
        answer.body += got;
      }
      if (error && error != http::error::need_buffer) return fault("the connection ended in the middle of an answer", error);
    }
    return {};
  }

  LineResult<HttpsAnswer> ask(const HttpsRequest& request, const BodySink& sink, const std::function<void(std::uint64_t)>& sent) {
    const Result<std::string> head = head_of(request, station);
    if (!head) return refuse(head.error());
    if (const ErrorCode error = write(*head)) return fault("the connection was cut", error);
    bool wanted = request.has_body && !request.asks_before_body;
    for (;;) {
      // A refusal may come before all of the body is out, and the line is closed behind it.
      const ErrorCode cut = wanted ? write_body(request.body, sent) : ErrorCode();
      if (stopped) return fault("", cut);
      wanted = false;
      AnswerParser parser;
      parser.skip(request.method == "HEAD");
      const ErrorCode error = read_head(parser);
      if (error) return fault("the connection was cut", cut ? cut : error);
      if (parser.get().result_int() == 100 && request.has_body) {
        wanted = true;
        continue;
      }
      HttpsAnswer answer = answer_of(parser);
      if (const LineResult<void> read = read_body(parser, answer, sink); !read) return tl::unexpected(read.error());
      open = parser.get().keep_alive() && !cut;
      return answer;
    }
  }
};

HttpsLine::HttpsLine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HttpsLine::HttpsLine(HttpsLine&&) noexcept = default;
HttpsLine& HttpsLine::operator=(HttpsLine&&) noexcept = default;
HttpsLine::~HttpsLine() = default;

LineResult<HttpsLine> HttpsLine::connect(const StationAddress& station, const Pin& pin, const LinePatience& patience, Stop stop) {
  auto impl = std::make_unique<Impl>(station, patience, std::move(stop));
  if (LineResult<void> connected = impl->connect(); !connected) return tl::unexpected(std::move(connected.error()));
  const auto& found = impl->fingerprint.bytes;
  if (pin.empty() || pin.size() > found.size() || !std::equal(pin.begin(), pin.end(), found.begin()))
    return impl->refuse(
        Error{station.text(), 0,
              "has another key than the one it was paired by (its certificate's SHA-256 is " + impl->fingerprint.hex() +
                  "). It was set up anew, or somebody takes its place: nothing was sent. Compare that number at the station, "
                  "then pair again with a new code"});
  return HttpsLine(std::move(impl));
}

const store::ContentHash& HttpsLine::fingerprint() const { return impl_->fingerprint; }
bool HttpsLine::is_open() const { return impl_->open; }

LineResult<HttpsAnswer> HttpsLine::ask(const HttpsRequest& request, const BodySink& sink, const std::function<void(std::uint64_t)>& sent) {
  return impl_->ask(request, sink, sent);
}

}  // namespace prismesh::ipc::remote
