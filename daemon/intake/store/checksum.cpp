#include "daemon/intake/store/checksum.h"

#include <new>
#include <optional>
#include <vector>

#include <openssl/evp.h>

#include "base/base64.h"

namespace prismesh::intake {

namespace {

void require_digest(int done) {
  if (done != 1) throw std::bad_alloc();
}

}  // namespace

Result<Checksum> parse_checksum(std::string_view header) {
  const auto wrong = [](std::string message) { return fail("Upload-Checksum", std::move(message)); };
  const std::size_t blank = header.find(' ');
  if (blank == std::string_view::npos) return wrong("must be an algorithm, a blank and a digest in base64");
  Checksum checksum;
  std::size_t size = 32;
  if (const std::string_view algorithm = header.substr(0, blank); algorithm == "sha1") {
    checksum.algorithm = ChecksumAlgorithm::sha1;
    size = 20;
  } else if (algorithm != "sha256") {
    return wrong("the algorithms are " + std::string(kChecksumAlgorithms));
  }
  const std::optional<std::vector<std::byte>> digest = base64_decode(header.substr(blank + 1));
  if (!digest || digest->size() != size) return wrong("the digest must be " + std::to_string(size) + " bytes in base64");
  checksum.digest.assign(reinterpret_cast<const char*>(digest->data()), digest->size());
  return checksum;
}

void ChunkDigest::Free::operator()(void* context) const { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(context)); }

ChunkDigest::ChunkDigest(ChecksumAlgorithm algorithm) : context_(EVP_MD_CTX_new()) {
  require_digest(context_ != nullptr && EVP_DigestInit_ex(static_cast<EVP_MD_CTX*>(context_.get()),
                                                          algorithm == ChecksumAlgorithm::sha1 ? EVP_sha1() : EVP_sha256(), nullptr));
}

void ChunkDigest::add(std::string_view bytes) {
  require_digest(EVP_DigestUpdate(static_cast<EVP_MD_CTX*>(context_.get()), bytes.data(), bytes.size()));
}

std::string ChunkDigest::digest() const {
  std::string bytes(EVP_MAX_MD_SIZE, '\0');
  unsigned size = 0;
  require_digest(EVP_DigestFinal_ex(static_cast<EVP_MD_CTX*>(context_.get()), reinterpret_cast<unsigned char*>(bytes.data()), &size));
  bytes.resize(size);
  return bytes;
}

}  // namespace prismesh::intake
