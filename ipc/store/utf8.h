// Text of others that is kept and shown: names, paths.
#pragma once

#include <string_view>

namespace prismesh::ipc::store {

/// Whether the text is sound UTF-8 (RFC 3629) without control characters (C0, DEL, C1) and without the marks that change the direction of
/// the text around them.
bool is_plain_utf8(std::string_view text);

}  // namespace prismesh::ipc::store
