// Requests to a store that speaks S3, one after the other, each with its signature. The only source with libcurl is s3_line.cpp.
// Source: Amazon S3 API Reference, Signature Version 4 with a signed payload.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/store/sha256.h"
#include "ipc/vault/address.h"
#include "ipc/vault/settings.h"
#include "ipc/wire/line_fault.h"

namespace prismesh::ipc::vault {

struct S3Patience {
  std::chrono::seconds connect{10};
  std::chrono::seconds silence{60};  ///< with less than 100 bytes a second
};

struct S3Request {
  enum class Method : std::uint8_t { get, head, put };
  Method method = Method::get;
  std::string object;     ///< without the vault's folder; empty: the bucket itself. Letters, digits, `-` and `/`
  std::string query;      ///< encoded, its keys ascending
  std::string_view body;  ///< put
  store::ContentHash body_hash = store::sha256({});
};

struct S3Answer {
  unsigned status = 0;
  std::map<std::string, std::string> headers;  ///< names in small letters
  std::string body;                            ///< of other statuses than 200 and 206; at most 64 KB of it

  std::string_view header(const std::string& name) const;
};

class S3Line {
 public:
  S3Line(VaultAddress address, const VaultSettings& keys, S3Patience patience, Stop stop);
  S3Line(S3Line&&) noexcept;
  S3Line& operator=(S3Line&&) noexcept;
  ~S3Line();

  const VaultAddress& address() const;
  /// When the last byte of the last request came or went, or when that began.
  std::chrono::steady_clock::time_point moved() const;

  /// What a get brings is put behind `content`, which holds what an earlier try brought of the same object: only the rest is asked for. It
  /// grows also where the line is cut. Errors: the line; more than `max_bytes` would be in `content`.
  LineResult<S3Answer> ask(const S3Request& request, std::string& content, std::size_t max_bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::ipc::vault
