#include "kiosk/render/line_set.h"

#include <span>

namespace prismesh::kiosk::render {

Result<void> LineSet::upload(const std::vector<NodePair>& lines, const char* what) {
  count = 0;
  if (const auto reserved = texture.reserve(lines.size(), what); !reserved) return fail(reserved.error());
  texture.upload(std::as_bytes(std::span(lines)));
  count = lines.size();
  return {};
}

}  // namespace prismesh::kiosk::render
