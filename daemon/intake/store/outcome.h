// Why the store refuses something, for the answer to its client.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "base/error.h"

namespace prismesh::intake {

enum class Refusal : std::uint8_t {
  malformed,       ///< it can't be understood
  missing,         ///< there is no such upload or model, or it is another's
  wrong_offset,    ///< the chunk doesn't begin where the upload ends
  taken_over,      ///< a later request goes on with the upload
  wrong_checksum,  ///< the chunk isn't what its sender hashed; it was discarded
  wrong_content,   ///< the whole file isn't; the upload was discarded
  too_large,       ///< than one file may be, or more bytes than were announced
  over_quota,      ///< of the token
  no_space,        ///< on the disk, the reserve aside
  unfinished,      ///< files of the model are missing
  damaged,         ///< the store's copy
  failed,          ///< the disk
};

struct Refused {
  Refusal why = Refusal::failed;
  Error error;
};

template <class T>
using Outcome = tl::expected<T, Refused>;

inline tl::unexpected<Refused> refuse(Refusal why, std::string file, std::string message) {
  return tl::unexpected<Refused>(Refused{why, Error{std::move(file), 0, std::move(message)}});
}
inline tl::unexpected<Refused> refuse(Refusal why, Error error) { return tl::unexpected<Refused>(Refused{why, std::move(error)}); }
/// What the disk refused.
inline tl::unexpected<Refused> disk_refusal(const Error& error) {
  return refuse(error.message.find("the disk is full") != std::string::npos ? Refusal::no_space : Refusal::failed, error);
}

}  // namespace prismesh::intake
