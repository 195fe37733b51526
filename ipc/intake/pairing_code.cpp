#include "ipc/intake/pairing_code.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace prismesh::ipc {

namespace {

constexpr std::string_view kSigns = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr std::size_t kBitsOfASign = 5;
constexpr std::size_t kGroup = 4;

std::string signs_of(const std::uint8_t* bytes, std::size_t count) {
  std::string text;
  std::uint32_t bits = 0;
  std::size_t held = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bits = bits << 8 | bytes[i];
    for (held += 8; held >= kBitsOfASign; held -= kBitsOfASign) {
      if (text.size() % (kGroup + 1) == kGroup) text += '-';
      text += kSigns[bits >> (held - kBitsOfASign) & 31U];
    }
  }
  return text;
}

std::optional<std::size_t> value_of_sign(char c) {
  if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  if (c == 'O') c = '0';
  if (c == 'I' || c == 'L') c = '1';
  const std::size_t value = kSigns.find(c);
  return value == std::string_view::npos ? std::nullopt : std::optional(value);
}

Result<std::vector<std::uint8_t>> bytes_of_signs(std::string_view text, std::size_t count) {
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  std::size_t held = 0;
  for (const char c : text) {
    if (c == '-' || c == ' ') continue;
    const std::optional<std::size_t> value = value_of_sign(c);
    if (!value) return fail("pairing code", "has a sign that no code has; codes have digits and letters, without U");
    bits = (bits << kBitsOfASign | static_cast<std::uint32_t>(*value)) & 0xffffU;
    held += kBitsOfASign;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> held & 0xffU));
    if (bytes.size() > count) break;
  }
  if (bytes.size() != count || held != 0)
    return fail("pairing code", "must have " + std::to_string(count * 8 / kBitsOfASign) + " letters and digits");
  return bytes;
}

}  // namespace

std::string encode_pairing_code(const PairingCode& code) {
  std::array<std::uint8_t, 20> all{};
  std::copy(code.fingerprint.begin(), code.fingerprint.end(), all.begin());
  std::copy(code.secret.begin(), code.secret.end(), all.begin() + 10);
  return signs_of(all.data(), all.size());
}

Result<PairingCode> decode_pairing_code(std::string_view text) {
  const Result<std::vector<std::uint8_t>> bytes = bytes_of_signs(text, 20);
  if (!bytes) return fail(bytes.error());
  PairingCode code;
  std::copy_n(bytes->begin(), 10, code.fingerprint.begin());
  std::copy_n(bytes->begin() + 10, 10, code.secret.begin());
  return code;
}

std::string encode_pairing_secret(const std::array<std::uint8_t, 10>& secret) { return signs_of(secret.data(), secret.size()); }

Result<std::array<std::uint8_t, 10>> decode_pairing_secret(std::string_view text) {
  const Result<std::vector<std::uint8_t>> bytes = bytes_of_signs(text, 10);
  if (!bytes) return fail(bytes.error());
  std::array<std::uint8_t, 10> secret{};
  std::copy_n(bytes->begin(), 10, secret.begin());
  return secret;
}

}  // namespace prismesh::ipc
