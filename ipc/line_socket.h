// A connected local socket that carries lines of text, and descriptors with the lines that name them. Never blocks.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/descriptor.h"

namespace prismesh::ipc {

struct LineLimits {
  std::size_t line_bytes = std::size_t{8} << 20;  ///< longest line taken
  std::size_t descriptors = 253;                  ///< most that may wait for their line; 0: none are taken
};

class LineSocket {
 public:
  LineSocket(Descriptor socket, LineLimits limits);

  /// Takes in what has arrived, up to a few hundred kilobytes. False: nothing was there. Errors: the other side is gone, a line is
  /// too long, descriptors that weren't asked for.
  Result<bool> receive();
  /// The next whole line, without its end; valid until the next call of receive.
  std::optional<std::string_view> next_line();
  /// The descriptors that ride with the line just taken. Errors: fewer have come than it names.
  Result<std::vector<Descriptor>> take_descriptors(std::size_t count);

  void queue(std::string line, std::vector<Descriptor> descriptors = {});
  /// Sends what the other side takes now; true when nothing is left.
  Result<bool> flush();
  std::size_t queued_bytes() const { return queued_bytes_; }

  int descriptor() const { return socket_.get(); }

 private:
  struct Outgoing {
    std::string bytes;
    std::size_t sent = 0;
    std::vector<Descriptor> descriptors;
  };
  Result<void> keep_descriptors(const void* message);
  long send_some(Outgoing& out);

  Descriptor socket_;
  LineLimits limits_;
  std::string incoming_;
  std::size_t taken_ = 0;    ///< bytes of incoming_ that were given out
  std::size_t scanned_ = 0;  ///< bytes of incoming_ known to hold no further line's end
  std::deque<Descriptor> descriptors_;
  std::deque<Outgoing> outgoing_;
  std::size_t queued_bytes_ = 0;
};

/// Connects to a listening socket. Errors say whether nobody listens (with `remedy`: what to do then) or the socket may not be used.
Result<Descriptor> connect_to(const std::filesystem::path& socket, std::string_view remedy = "start its daemon");

}  // namespace prismesh::ipc
