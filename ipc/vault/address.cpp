#include "ipc/vault/address.h"

#include <algorithm>

#include "ipc/wire/host_port.h"

namespace prismesh::ipc::vault {

namespace {

constexpr std::string_view kEncrypted = "s3+https://", kPlain = "s3+http://";
constexpr std::size_t kMaxBucket = 255, kMaxFolder = 300;

bool is_name_sign(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
}

bool is_part(std::string_view text) {
  return !text.empty() && text != "." && text != ".." && std::all_of(text.begin(), text.end(), is_name_sign);
}

tl::unexpected<Error> no_vault(std::string_view text) {
  return fail(std::string(text), "is no vault; write s3+https://HOST/BUCKET, or s3+https://HOST:PORT/BUCKET/FOLDER");
}

}  // namespace

std::string VaultAddress::origin() const {
  return (is_plain ? "http://" : "https://") + bracketed(host) + (port ? ":" + std::to_string(*port) : "");
}

std::string VaultAddress::text() const {
  const std::string place = "s3+" + origin() + "/" + bucket + "/" + folder;
  return place.substr(0, place.size() - 1);
}

bool VaultAddress::is_loopback() const {
  const bool is_number = host.find_first_not_of("0123456789.") == std::string::npos;
  return host == "localhost" || host == "::1" || (host.starts_with("127.") && is_number);
}

Result<VaultAddress> parse_vault_address(std::string_view text) {
  // First, and not shown: what stands before the @ is a secret.
  if (text.find('@') != std::string_view::npos)
    return fail("",
                "an address of a vault has no credentials in it; they come from AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or a file");
  VaultAddress address;
  std::string_view rest = text;
  if (rest.starts_with(kEncrypted)) {
    rest.remove_prefix(kEncrypted.size());
  } else if (rest.starts_with(kPlain)) {
    address.is_plain = true;
    rest.remove_prefix(kPlain.size());
  } else {
    return no_vault(text);
  }
  const std::size_t slash = rest.find('/');
  if (slash == std::string_view::npos) return no_vault(text);
  std::optional<HostPort> place = parse_host_port(rest.substr(0, slash));
  if (!place) return no_vault(text);
  address.host = std::move(place->host);
  address.port = place->port;
  rest.remove_prefix(slash + 1);
  if (rest.ends_with('/')) rest.remove_suffix(1);
  const std::size_t end = std::min(rest.find('/'), rest.size());
  address.bucket = rest.substr(0, end);
  if (!is_part(address.bucket) || address.bucket.size() > kMaxBucket) return no_vault(text);
  if (end + 1 == rest.size()) return no_vault(text);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  if (rest.size() > kMaxFolder) return no_vault(text);
  while (!rest.empty()) {
    const std::size_t part = std::min(rest.find('/'), rest.size());
    if (!is_part(rest.substr(0, part)) || part + 1 == rest.size()) return no_vault(text);
    address.folder += std::string(rest.substr(0, part)) + "/";
    rest.remove_prefix(std::min(part + 1, rest.size()));
  }
  return address;
}

}  // namespace prismesh::ipc::vault
