// What the renderer gives up to keep to a limit of video memory, in a fixed order, so that the same models look the same on the same
// station.
#pragma once

#include <cstddef>
#include <string>

namespace prismesh::kiosk::render {

/// In the order in which it goes: what costs the user least comes first. No shell, line, node or glyph is left out, and what is picked is
/// the same.
struct GivenUp {
  bool multisampling = false;  ///< pictures at rest are drawn with one sample a pixel
  bool moving_images = false;  ///< pictures in motion are drawn into the images of the picture at rest, which is drawn again after them
  bool order = false;          ///< the order of shells is uploaded in pieces while they are drawn
  bool levels = false;         ///< no levels of detail: pictures in motion draw every shell
  bool operator==(const GivenUp&) const = default;
  bool any() const { return multisampling || moving_images || order || levels; }
  /// What one or the other gives up.
  GivenUp with(const GivenUp& other) const {
    return {multisampling || other.multisampling, moving_images || other.moving_images, order || other.order, levels || other.levels};
  }
};

/// What would be held if nothing were given up.
struct MemoryNeeds {
  std::size_t fixed_bytes = 0;   ///< what is always held
  std::size_t image_pixels = 0;  ///< of an eye's image
  int samples = 1;               ///< of pictures at rest
  bool in_motion = true;         ///< pictures in motion are drawn too
  std::size_t order_bytes = 0;
  std::size_t levels_bytes = 0;  ///< with what pictures in motion choose of them
};

struct MemoryPlan {
  GivenUp given_up;
  std::size_t bytes = 0;  ///< at most held then; above the limit if all that can be given up isn't enough
  bool operator==(const MemoryPlan&) const = default;
};

/// Kept free for what is small and comes and goes: handles, glyphs, lasso, a piece of the order.
inline constexpr std::size_t kMemoryMargin = std::size_t{4} << 20;

/// Gives up as little as keeps to `limit` bytes. 0: no limit.
MemoryPlan plan_memory(const MemoryNeeds& needs, std::size_t limit);

/// Bytes held on the graphics card, their limit (0: none), and what is given up to keep to it.
struct VideoMemory {
  std::size_t held = 0, limit = 0;
  std::size_t planned = 0;  ///< that may be held; above the limit if all is given up that can be
  GivenUp given_up;
  bool is_exceeded() const { return limit > 0 && planned > limit; }
};

/// "118 of 128 MB"; without a limit "118 MB".
std::string megabytes_of(const VideoMemory& memory);
/// What is given up, in a few words each, and in that order; empty: nothing.
std::string in_words(const GivenUp& given_up);
/// What a user must know: which limit, what is given up for it, and what isn't.
std::string sentence_of(const VideoMemory& memory);

}  // namespace prismesh::kiosk::render
