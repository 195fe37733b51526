// Error: what went wrong and where, in words a user can act on. Result: a value, or an Error.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace prismesh {

enum class ErrorKind : std::uint8_t {
  failure,
  cancelled,   ///< the work was told to stop (base/progress.h)
  over_limit,  ///< there is more of something than a limit allows
};

/// A recoverable failure. `file` is the user's file (or a device's or socket's name, or "expression"); `line` counts
/// from 1, is a column for expressions, and is 0 where no line applies.
struct Error {
  std::string file;
  long line = 0;
  std::string message;
  ErrorKind kind = ErrorKind::failure;

  /// "file:line: message", without the parts that are empty.
  std::string text() const;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string file, long line, std::string message) {
  return tl::unexpected<Error>(Error{std::move(file), line, std::move(message)});
}
inline tl::unexpected<Error> fail(std::string file, std::string message) { return fail(std::move(file), 0, std::move(message)); }
inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

}  // namespace prismesh
