// What goes around a message on its way: numbers, descriptors, and what can't be read.
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
/// A request that can't be read; `number` is 0 where not even that can.
struct BadRequest {
  std::uint64_t number = 0;
  std::string message;
};
/// What a daemon says.
template <class AnyAnswer, class AnyEvent>
struct Said {
  std::uint64_t to = 0;         ///< the request that is answered
  std::size_t descriptors = 0;  ///< that ride with the line
  std::variant<AnyAnswer, AnyEvent> message;
};

}  // namespace prismesh::ipc
