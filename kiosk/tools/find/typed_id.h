// An id as it is typed to go there: "5000766", "node 17", "s12", "part:3".
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace prismesh::kiosk::tools::find {

struct TypedId {
  enum class Kind : std::uint8_t { any, node, shell, part };
  Kind kind = Kind::any;
  std::int64_t id = 0;
  bool operator==(const TypedId&) const = default;
};

/// Nothing if the text is no id: other words, no digit, a number over 2^63 - 1.
std::optional<TypedId> typed_id(std::string_view text);

}  // namespace prismesh::kiosk::tools::find
