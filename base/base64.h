// Bytes as text: base64 with the standard alphabet and padding (RFC 4648, section 4).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh {

std::string base64_encode(std::span<const std::byte> bytes);
/// Empty if the text isn't exactly what base64_encode returns for some bytes: no blanks, complete padding, zero spare bits.
std::optional<std::vector<std::byte>> base64_decode(std::string_view text);

}  // namespace prismesh
