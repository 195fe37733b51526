// What is known of an upload when it begins.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ipc/store/sha256.h"

namespace prismesh::intake {

/// What is asked for when an upload begins.
struct NewUpload {
  std::string who;  ///< the token's name
  std::uint64_t length = 0;
  std::string metadata;                             ///< the header as it came, for those who ask for the upload
  std::optional<ipc::store::ContentHash> expected;  ///< of the whole file
};

}  // namespace prismesh::intake
