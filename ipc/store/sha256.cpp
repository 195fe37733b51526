#include "ipc/store/sha256.h"

#include <new>

#include <openssl/evp.h>

namespace prismesh::ipc::store {

namespace {

EVP_MD_CTX* context(void* held) { return static_cast<EVP_MD_CTX*>(held); }

/// OpenSSL's digests fail for lack of memory only.
void demand(bool done) {
  if (!done) throw std::bad_alloc();
}

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace

std::string ContentHash::hex() const {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::optional<ContentHash> parse_content_hash(std::string_view text) {
  ContentHash hash;
  if (text.size() != 2 * hash.bytes.size()) return std::nullopt;
  for (std::size_t i = 0; i < hash.bytes.size(); ++i) {
    const int high = digit(text[2 * i]), low = digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    hash.bytes[i] = static_cast<std::uint8_t>(high * 16 + low);
  }
  return hash;
}

void Sha256::Free::operator()(void* held) const { EVP_MD_CTX_free(context(held)); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  demand(context_ != nullptr && EVP_DigestInit_ex(context(context_.get()), EVP_sha256(), nullptr) == 1);
}

Sha256::Sha256(const Sha256& other) : context_(EVP_MD_CTX_new()) {
  demand(context_ != nullptr && EVP_MD_CTX_copy_ex(context(context_.get()), context(other.context_.get())) == 1);
}

Sha256& Sha256::operator=(const Sha256& other) {
  if (this != &other) *this = Sha256(other);
  return *this;
}

void Sha256::add(std::span<const std::byte> bytes) { demand(EVP_DigestUpdate(context(context_.get()), bytes.data(), bytes.size()) == 1); }

ContentHash Sha256::hash() const {
  const Sha256 so_far(*this);
  ContentHash result;
  demand(EVP_DigestFinal_ex(context(so_far.context_.get()), result.bytes.data(), nullptr) == 1);
  return result;
}

ContentHash sha256(std::string_view text) {
  Sha256 hash;
  hash.add(text);
  return hash.hash();
}

}  // namespace prismesh::ipc::store
