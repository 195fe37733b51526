// A connected local socket for lines of text, and for descriptors that belong to lines. Never blocks.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::ipc {

struct LineLimits {
  std::size_t line_bytes = std::size_t{8} << 20;  ///< max length of a line
  std::size_t descriptors = 253;                  ///< max number that may wait for their line; 0: none are accepted
};

class LineSocket {
 public:
  LineSocket(Descriptor socket, LineLimits limits);

  /// Reads what has arrived, up to a few hundred kilobytes. False if nothing has. Errors: the other side is gone, a line is too long,
  /// unexpected descriptors.
  Result<bool> receive();
  /// The next whole line, without its end; valid until the next call of receive.
  std::optional<std::string_view> next_line();
  /// The descriptors of the line just taken. Errors: fewer have arrived than it names.
  Result<std::vector<Descriptor>> take_descriptors(std::size_t count);

  void queue(std::string line, std::vector<Descriptor> descriptors = {});
  /// Sends as much as the other side accepts now; true when nothing is left.
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

/// Connects to a listening socket. Errors: nobody listens (with `remedy`, what to do then), the socket may not be used.
Result<Descriptor> connect_to(const std::filesystem::path& socket, std::string_view remedy = "start its daemon");

}  // namespace prismesh::ipc
