// The file of tokens as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "daemon/intake/access/token.h"

namespace prismesh::intake {

struct TokenFile {
  std::vector<TokenRecord> tokens;
  std::int64_t latest_s = 0;  ///< the latest time that was seen: a clock that is set back brings no token back
};

std::string encode_tokens(const TokenFile& file);
/// Errors: it is damaged. `name` is for errors.
Result<TokenFile> decode_tokens(std::string_view text, const std::string& name);

std::vector<std::string> scope_names(const Scopes& scopes);
/// Errors: a name that isn't known.
Result<Scopes> scopes_named(const std::vector<std::string>& names);

}  // namespace prismesh::intake
