// Pictures of models, which other programs make and browsers show.
#pragma once

#include <cstddef>
#include <string_view>

namespace prismesh::intake {

inline constexpr std::size_t kMaxThumbnailBytes = std::size_t{512} << 10;
inline constexpr std::size_t kMaxThumbnailSide = 1024;  ///< pixels

/// Whether the bytes are a PNG (W3C, third edition) of at most these sizes: its signature, a sound IHDR first, and chunks that end with
/// IEND where the bytes end. What is in the chunks isn't looked at.
bool is_thumbnail(std::string_view bytes);

}  // namespace prismesh::intake
