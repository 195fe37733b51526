#include "daemon/intake/tls/identity.h"

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <memory>

namespace prismesh::intake {

namespace {

constexpr const char* kIdentityFile = "identity.pem";
constexpr const char* kNewIdentityFile = "identity.pem.new";
constexpr std::size_t kMaxIdentityBytes = std::size_t{64} << 10;

struct FreeOpenssl {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(BIO* bio) const { BIO_free(bio); }
  void operator()(X509_EXTENSION* extension) const { X509_EXTENSION_free(extension); }
};
template <class T>
using Owned = std::unique_ptr<T, FreeOpenssl>;

bool set_serial(X509* certificate) {
  unsigned char random[16];
  if (RAND_bytes(random, sizeof random) != 1) return false;
  random[0] = static_cast<unsigned char>((random[0] & 0x7f) | 0x40);
  const std::unique_ptr<BIGNUM, decltype(&BN_free)> number(BN_bin2bn(random, sizeof random, nullptr), BN_free);
  return number && BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)) != nullptr;
}

bool add_extension(X509* certificate, int kind, const char* value) {
  const Owned<X509_EXTENSION> extension(X509V3_EXT_conf_nid(nullptr, nullptr, kind, value));
  return extension && X509_add_ext(certificate, extension.get(), -1) == 1;
}

/// Good at any time: the station's clock may be wrong, and clients pin it anyway.
bool set_times(X509* certificate) {
  return ASN1_TIME_set_string_X509(X509_getm_notBefore(certificate), "20000101000000Z") == 1 &&
         ASN1_TIME_set_string_X509(X509_getm_notAfter(certificate), "99991231235959Z") == 1;
}

Owned<X509> make_certificate(EVP_PKEY* key) {
  Owned<X509> certificate(X509_new());
  if (!certificate || X509_set_version(certificate.get(), X509_VERSION_3) != 1 || !set_serial(certificate.get()) ||
      !set_times(certificate.get()) || X509_set_pubkey(certificate.get(), key) != 1)
    return nullptr;
  X509_NAME* name = X509_get_subject_name(certificate.get());
  const auto* common = reinterpret_cast<const unsigned char*>("prismesh station");
  if (X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8, common, -1, -1, 0) != 1 || X509_set_issuer_name(certificate.get(), name) != 1)
    return nullptr;
  if (!add_extension(certificate.get(), NID_subject_alt_name, "DNS:localhost,DNS:prismesh-station,IP:127.0.0.1") ||
      !add_extension(certificate.get(), NID_ext_key_usage, "serverAuth"))
    return nullptr;
  if (X509_sign(certificate.get(), key, EVP_sha256()) == 0) return nullptr;
  return certificate;
}

std::string content_of(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

/// Empty: OpenSSL failed.
std::string make_identity() {
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"));
  if (!key) return {};
  const Owned<X509> certificate = make_certificate(key.get());
  const Owned<BIO> out(BIO_new(BIO_s_mem()));
  if (!certificate || !out || PEM_write_bio_PrivateKey(out.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
      PEM_write_bio_X509(out.get(), certificate.get()) != 1)
    return {};
  return content_of(out.get());
}

Result<Identity> read_identity(const std::string& pem, const std::string& shown) {
  const Owned<BIO> in(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  const Owned<EVP_PKEY> key(in ? PEM_read_bio_PrivateKey(in.get(), nullptr, nullptr, nullptr) : nullptr);
  const Owned<X509> certificate(key ? PEM_read_bio_X509(in.get(), nullptr, nullptr, nullptr) : nullptr);
  if (!certificate || X509_check_private_key(certificate.get(), key.get()) != 1)
    return fail(shown, "the station's key is damaged; put a copy back, or remove it and pair all clients anew");
  Identity identity{pem, {}};
  unsigned size = 0;
  if (X509_digest(certificate.get(), EVP_sha256(), identity.fingerprint.bytes.data(), &size) != 1)
    return fail(shown, "the certificate can't be hashed");
  return identity;
}

}  // namespace

Result<Identity> open_identity(const ipc::store::Folder& folder) {
  const std::string shown = (folder.path() / kIdentityFile).string();
  if (!folder.has(kIdentityFile)) {
    (void)folder.remove(kNewIdentityFile);
    const std::string pem = make_identity();
    if (pem.empty()) return fail(shown, "the station's key can't be made");
    if (const Result<void> written = folder.replace(kIdentityFile, pem, kNewIdentityFile, 0600); !written) return fail(written.error());
  }
  const Result<ipc::Descriptor> file = folder.read(kIdentityFile);
  if (!file) return fail(file.error());
  struct stat status {};
  if (::fstat(file->get(), &status) != 0 || (status.st_mode & 077) != 0)
    return fail(shown, "others may read the station's key; make a new one (remove the file) and pair all clients anew");
  const Result<std::string> pem = folder.content(kIdentityFile, kMaxIdentityBytes);
  if (!pem) return fail(pem.error());
  return read_identity(*pem, shown);
}

}  // namespace prismesh::intake
