// What is sent with a message: its number, its count of descriptors; and requests that can't be read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

namespace prismesh::ipc {

template <class AnyRequest>
struct Numbered {
  std::uint64_t number = 0;
  AnyRequest request;
};
/// A request that can't be read; `number` is 0 if it can't be read either.
struct BadRequest {
  std::uint64_t number = 0;
  std::string message;
};
/// A message from a daemon: an answer or an event.
template <class AnyAnswer, class AnyEvent>
struct Said {
  std::uint64_t to = 0;         ///< the request that is answered
  std::size_t descriptors = 0;  ///< that belong to the line
  std::variant<AnyAnswer, AnyEvent> message;
};

}  // namespace prismesh::ipc
