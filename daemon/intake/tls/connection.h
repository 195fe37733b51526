// One connection of a client: requests and answers, one after the other. Boost.Beast's headers are heavy: only this folder includes them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include "daemon/intake/api/api.h"
#include "daemon/intake/tls/server_settings.h"

namespace prismesh::intake {

/// What all connections have in common.
struct ConnectionContext {
  const ServerSettings& settings;
  Api& api;
  Access& access;
  EventHub& events;
  Figures& figures;
  std::shared_ptr<StoreThread> store;
};

/// A file that is being sent.
struct FileSending {
  std::shared_ptr<FileBody> file;
  std::uint64_t sent = 0;
  ipc::store::Sha256 hash;
  std::string piece;
};

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context& tls, ConnectionContext context);
  ~Connection();
  void start();

 private:
  using ErrorCode = boost::system::error_code;
  using Parser = boost::beast::http::request_parser<boost::beast::http::buffer_body>;
  using HeaderOnly = boost::beast::http::response<boost::beast::http::empty_body>;
  using WholeResponse = boost::beast::http::response<boost::beast::http::string_body>;

  void expire_in(std::chrono::milliseconds time);
  void read_request(std::chrono::milliseconds patience);
  void on_header(const ErrorCode& error);
  void react(Reaction reaction);
  GoOn continuation(void (Connection::*next)());
  Respond responder();
  void begin_body();
  void read_piece();
  void on_piece(const ErrorCode& error);
  void give_up_after_last_piece(std::string bytes);
  void body_taken();

  void send(HttpResponse response);
  void fill_header(HeaderOnly::header_type& header, const HttpResponse& response) const;
  void send_text(HttpResponse& response);
  void send_header(HttpResponse& response, std::optional<std::uint64_t> bytes, void (Connection::*next)());
  void send_next_piece();
  void on_file_piece(std::string piece);
  void sent();
  void follow_events();
  void pump_events();
  void beat();
  void close();
  void drain();
  void drain_piece();

  ConnectionContext context_;
  boost::beast::ssl_stream<boost::beast::tcp_stream> stream_;
  boost::asio::steady_timer timer_;
  boost::beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  bool is_head_ = false;
  bool keeps_alive_ = false;
  std::shared_ptr<BodyTaker> body_;
  std::string piece_;
  std::shared_ptr<void> permit_;
  std::optional<WholeResponse> whole_;
  std::optional<HeaderOnly> header_;
  std::optional<boost::beast::http::response_serializer<boost::beast::http::empty_body>> serializer_;
  std::optional<FileSending> sending_;
  std::optional<std::uint64_t> follower_;
  std::string events_text_;
  bool writes_events_ = false;
};

}  // namespace prismesh::intake
