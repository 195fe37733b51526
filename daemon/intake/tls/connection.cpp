#include "daemon/intake/tls/connection.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <boost/asio/write.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>

#include "base/log.h"

namespace prismesh::intake {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::size_t kMaxHeaderBytes = std::size_t{16} << 10;
constexpr std::size_t kPieceBytes = std::size_t{32} << 10;
constexpr std::chrono::milliseconds kDrainTime{2000};

std::string small_letters(beast::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

template <class Parser>
HttpRequest request_of(const Parser& parser) {
  const auto& message = parser.get();
  HttpRequest request;
  request.method = std::string(message.method_string());
  request.target = std::string(message.target());
  for (const auto& field : message) request.headers.push_back({small_letters(field.name_string()), std::string(field.value())});
  if (const auto bytes = parser.content_length()) request.body_bytes = *bytes;
  request.is_chunked = parser.chunked();
  return request;
}

}  // namespace

Connection::Connection(asio::ip::tcp::socket socket, asio::ssl::context& tls, ConnectionContext context)
    : context_(std::move(context)), stream_(std::move(socket), tls), timer_(stream_.get_executor()), buffer_(2 * kPieceBytes) {
  ++context_.figures.connections;
}

Connection::~Connection() {
  if (follower_) context_.events.leave(*follower_);
  --context_.figures.connections;
}

void Connection::expire_in(std::chrono::milliseconds time) { beast::get_lowest_layer(stream_).expires_after(time); }

void Connection::start() {
  expire_in(context_.settings.greeting);
  stream_.async_handshake(asio::ssl::stream_base::server, [self = shared_from_this()](const ErrorCode& error) {
    if (error) return beast::get_lowest_layer(self->stream_).close();
    self->read_request(self->context_.settings.greeting);
  });
}

// --- requests ---

void Connection::read_request(std::chrono::milliseconds patience) {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // each route has its own
  expire_in(patience);
  http::async_read_header(stream_, buffer_, *parser_,
                          [self = shared_from_this()](const ErrorCode& error, std::size_t) { self->on_header(error); });
}

void Connection::on_header(const ErrorCode& error) {
  if (error && error.category() != http::make_error_code(http::error::bad_method).category()) return close();
  if (error == http::error::end_of_stream) return close();
  keeps_alive_ = false;
  is_head_ = false;
  if (error) {
    ++context_.figures.requests;
    const bool too_long = error == http::error::header_limit || error == http::error::buffer_overflow;
    return send(error_response(too_long ? 431 : 400, "the request can't be read: " + error.message()));
  }
  const HttpRequest request = request_of(*parser_);
  is_head_ = request.method == "HEAD";
  react(context_.api.take(request));
}

Respond Connection::responder() {
  return [self = shared_from_this()](HttpResponse response) {
    asio::post(self->stream_.get_executor(),
               [self, response = std::make_shared<HttpResponse>(std::move(response))] { self->send(std::move(*response)); });
  };
}

GoOn Connection::continuation(void (Connection::*next)()) {
  return [self = shared_from_this(), next](std::optional<HttpResponse> refused) {
    asio::post(self->stream_.get_executor(), [self, next, refused = std::make_shared<std::optional<HttpResponse>>(std::move(refused))] {
      if (*refused) return self->send(std::move(**refused));
      ((*self).*next)();
    });
  };
}

void Connection::react(Reaction reaction) {
  if (auto* response = std::get_if<HttpResponse>(&reaction)) return send(std::move(*response));
  // What the disk does isn't the client's delay.
  beast::get_lowest_layer(stream_).expires_never();
  if (const auto* work = std::get_if<std::function<void(Respond)>>(&reaction)) return (*work)(responder());
  body_ = std::get<std::shared_ptr<BodyTaker>>(std::move(reaction));
  body_->open(continuation(&Connection::begin_body));
}

void Connection::begin_body() {
  if (small_letters(parser_->get()[http::field::expect]) != "100-continue" || parser_->is_done()) return read_piece();
  static constexpr beast::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  expire_in(context_.settings.piece);
  asio::async_write(stream_, asio::buffer(kContinue.data(), kContinue.size()),
                    [self = shared_from_this()](const ErrorCode& error, std::size_t) {
                      if (error) return self->close();
                      self->read_piece();
                    });
}

void Connection::read_piece() {
  if (parser_->is_done()) return body_taken();
  piece_.resize(kPieceBytes);
  auto& body = parser_->get().body();
  body.data = piece_.data();
  body.size = piece_.size();
  expire_in(context_.settings.piece);
  http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](const ErrorCode& error, std::size_t) { self->on_piece(error); });
}

void Connection::on_piece(const ErrorCode& error) {
  piece_.resize(kPieceBytes - parser_->get().body().size);
  if (error && error != http::error::need_buffer) return give_up_after_last_piece(std::exchange(piece_, {}));
  beast::get_lowest_layer(stream_).expires_never();
  if (piece_.empty()) return read_piece();
  body_->piece(std::exchange(piece_, {}), continuation(&Connection::read_piece));
}

/// The line was cut: what came counts, so that it needn't be sent again.
void Connection::give_up_after_last_piece(std::string bytes) {
  const std::shared_ptr<BodyTaker> body = std::exchange(body_, nullptr);
  if (!bytes.empty()) body->piece(std::move(bytes), [](const std::optional<HttpResponse>&) {});
  close();
}

void Connection::body_taken() {
  beast::get_lowest_layer(stream_).expires_never();
  body_->end(responder());
}

// --- answers ---

void Connection::send(HttpResponse response) {
  body_.reset();
  if (response.status >= 400) ++context_.figures.refused;
  // What is left of a body would be read as the next request.
  keeps_alive_ = parser_ && parser_->is_done() && parser_->get().keep_alive();
  permit_ = std::move(response.permit);
  expire_in(context_.settings.piece);
  if (auto* file = std::get_if<FileBody>(&response.body)) {
    const std::uint64_t bytes = file->bytes;
    sending_.emplace();
    sending_->file = std::make_shared<FileBody>(std::move(*file));
    return send_header(response, bytes, is_head_ ? &Connection::sent : &Connection::send_next_piece);
  }
  if (const auto* events = std::get_if<EventBody>(&response.body)) {
    follower_ = events->subscription;
    keeps_alive_ = false;
    return send_header(response, std::nullopt, is_head_ ? &Connection::sent : &Connection::follow_events);
  }
  const std::string& text = std::get<std::string>(response.body);
  if (is_head_) return send_header(response, text.size(), &Connection::sent);
  send_text(response);
}

void Connection::fill_header(HeaderOnly::header_type& header, const HttpResponse& response) const {
  header.result(response.status);
  if (response.status == 460) header.reason("Checksum Mismatch");
  for (const auto& [name, value] : response.headers) header.insert(name, value);
  header.set("X-Content-Type-Options", "nosniff");
  // The page has a policy of its own.
  if (header.find("Content-Security-Policy") == header.end())
    header.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
  header.set("Referrer-Policy", "no-referrer");
  header.set("Cross-Origin-Resource-Policy", "same-origin");
  header.set("Cross-Origin-Opener-Policy", "same-origin");
}

void Connection::send_text(HttpResponse& response) {
  whole_.emplace();
  fill_header(*whole_, response);
  whole_->body() = std::move(std::get<std::string>(response.body));
  whole_->version(11);
  whole_->keep_alive(keeps_alive_);
  whole_->prepare_payload();
  http::async_write(stream_, *whole_, [self = shared_from_this()](const ErrorCode& error, std::size_t) {
    if (error) return self->close();
    self->sent();
  });
}

void Connection::send_header(HttpResponse& response, std::optional<std::uint64_t> bytes, void (Connection::*next)()) {
  header_.emplace();
  fill_header(*header_, response);
  header_->version(11);
  header_->keep_alive(keeps_alive_);
  if (bytes && response.status != 204 && response.status != 304) header_->content_length(*bytes);
  serializer_.emplace(*header_);
  http::async_write_header(stream_, *serializer_, [self = shared_from_this(), next](const ErrorCode& error, std::size_t) {
    if (error) return self->close();
    ((*self).*next)();
  });
}

void Connection::send_next_piece() {
  const FileBody& file = *sending_->file;
  if (sending_->sent == file.bytes) return sent();
  const std::uint64_t size = std::min<std::uint64_t>(kPieceBytes, file.bytes - sending_->sent);
  context_.store->run([self = shared_from_this(), file = sending_->file, size, at = file.begin + sending_->sent](Store&) {
    std::string piece(size, '\0');
    const Result<std::size_t> got = ipc::store::read_at(file->file, piece.data(), size, at, "a stored file");
    piece.resize(got.value_or(0));
    asio::post(self->stream_.get_executor(), [self, piece = std::move(piece)]() mutable { self->on_file_piece(std::move(piece)); });
  });
}

void Connection::on_file_piece(std::string piece) {
  const FileBody& file = *sending_->file;
  const std::uint64_t expected = std::min<std::uint64_t>(kPieceBytes, file.bytes - sending_->sent);
  // The announced length tells the client that something is missing.
  if (piece.size() != expected) return close();
  if (file.is_whole()) {
    sending_->hash.add(piece);
    if (sending_->sent + piece.size() == file.bytes && sending_->hash.hash() != file.hash) {
      logging::error("a stored file is damaged and wasn't given out whole: {}", file.hash.hex());
      return close();
    }
  }
  sending_->piece = std::move(piece);
  expire_in(context_.settings.piece);
  asio::async_write(stream_, asio::buffer(sending_->piece), [self = shared_from_this()](const ErrorCode& error, std::size_t bytes) {
    if (error) return self->close();
    self->context_.figures.sent_bytes += bytes;
    self->sending_->sent += bytes;
    self->send_next_piece();
  });
}

void Connection::sent() {
  sending_.reset();
  permit_.reset();
  whole_.reset();
  serializer_.reset();
  if (!keeps_alive_) return drain();
  read_request(context_.settings.idle);
}

// --- events ---

void Connection::follow_events() {
  beast::get_lowest_layer(stream_).expires_never();
  const std::weak_ptr<Connection> weak = weak_from_this();
  context_.events.wake_by(*follower_, [weak, executor = stream_.get_executor()] {
    asio::post(executor, [weak] {
      if (const std::shared_ptr<Connection> self = weak.lock()) self->pump_events();
    });
  });
  // Ends with the connection, and keeps it until then; a follower has nothing more to say.
  piece_.resize(1);
  stream_.async_read_some(asio::buffer(piece_), [self = shared_from_this()](const ErrorCode&, std::size_t) { self->close(); });
  events_text_ = ": follows the catalogue\n\n";
  pump_events();
  beat();
}

void Connection::pump_events() {
  if (writes_events_) return;
  PendingEvents next = context_.events.take(*follower_);
  if (next.ends) return close();
  events_text_ += next.text;
  if (events_text_.empty()) return;
  writes_events_ = true;
  expire_in(context_.settings.piece);
  const auto text = std::make_shared<std::string>(std::exchange(events_text_, {}));
  asio::async_write(stream_, asio::buffer(*text), [self = shared_from_this(), text](const ErrorCode& error, std::size_t) {
    self->writes_events_ = false;
    if (error) return self->close();
    beast::get_lowest_layer(self->stream_).expires_never();
    self->pump_events();
  });
}

/// Keeps the line alive, notices that the client is gone, and that its right is.
void Connection::beat() {
  timer_.expires_after(context_.settings.heartbeat);
  timer_.async_wait([weak = weak_from_this()](const ErrorCode& error) {
    const std::shared_ptr<Connection> self = weak.lock();
    if (error || !self || !self->follower_) return;
    const std::optional<Caller> caller = self->context_.events.caller_of(*self->follower_);
    if (!caller || !self->context_.access.still_may(*caller, Scope::read)) return self->close();
    self->events_text_ += ": still here\n\n";
    self->pump_events();
    self->beat();
  });
}

// --- the end ---

void Connection::close() {
  timer_.cancel();
  body_.reset();
  permit_.reset();
  if (follower_) context_.events.leave(*std::exchange(follower_, std::nullopt));
  beast::get_lowest_layer(stream_).close();
}

/// Says goodbye, and reads what still comes for a moment: a connection that is closed with bytes unread takes the answer with it.
void Connection::drain() {
  expire_in(kDrainTime);
  // It ends with an error where bytes of a body come, which is as good.
  stream_.async_shutdown([self = shared_from_this()](const ErrorCode&) {
    ErrorCode ignored;
    beast::get_lowest_layer(self->stream_).socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    self->piece_.resize(kPieceBytes);
    self->drain_piece();
  });
}

void Connection::drain_piece() {
  beast::get_lowest_layer(stream_).async_read_some(asio::buffer(piece_), [self = shared_from_this()](const ErrorCode& error, std::size_t) {
    if (error) return self->close();
    self->drain_piece();
  });
}

}  // namespace prismesh::intake
