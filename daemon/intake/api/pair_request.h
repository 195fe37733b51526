// The body of a request for a token.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::intake {

struct PairRequest {
  std::string secret;   ///< of the pairing code
  std::string name;     ///< that the client wants; may be empty
  bool cookie = false;  ///< the token is to come as a browser's cookie, which no script can read
};

/// Reads {"secret": "...", "name": "...", "cookie": false}. Errors name the field.
Result<PairRequest> parse_pair_request(std::string_view body);

}  // namespace prismesh::intake
