// The code by which a client is paired with a station: it carries the beginning of the fingerprint of the station's certificate, so that
// nobody in between can take the station's place, and a secret that is good for once. People read and type it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::ipc {

struct PairingCode {
  std::array<std::uint8_t, 10> fingerprint{};  ///< the first 80 bits of the certificate's SHA-256
  std::array<std::uint8_t, 10> secret{};
  bool operator==(const PairingCode&) const = default;
};

/// Eight groups of four of Crockford's 32 letters and digits, with hyphens between.
std::string encode_pairing_code(const PairingCode& code);
/// Takes small letters, blanks, missing hyphens, and O, I, L for 0, 1, 1. Errors: another length or sign.
Result<PairingCode> decode_pairing_code(std::string_view text);

/// The secret by itself, as it is sent: four groups.
std::string encode_pairing_secret(const std::array<std::uint8_t, 10>& secret);
Result<std::array<std::uint8_t, 10>> decode_pairing_secret(std::string_view text);

}  // namespace prismesh::ipc
