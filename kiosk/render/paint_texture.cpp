#include "kiosk/render/paint_texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {
namespace {

// Bits of a texel above the colour's three bytes; kPaint of shaders.cpp reads them.
constexpr std::uint32_t kHasColour = 1U << 24, kTransparent = 1U << 25;

std::uint32_t texel_of(const PartPaint& paint) {
  std::uint32_t texel = paint.transparent ? kTransparent : 0;
  if (!paint.colour) return texel;
  const auto byte = [](float value) { return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)); };
  return texel | kHasColour | byte(paint.colour->x()) | byte(paint.colour->y()) << 8 | byte(paint.colour->z()) << 16;
}

}  // namespace

Result<void> PaintTexture::set(std::span<const PartPaint> paints) {
  std::vector<std::uint32_t> texels;
  texels.reserve(paints.size());
  for (const PartPaint& paint : paints) texels.push_back(texel_of(paint));
  count_ = 0;
  any_transparent_ = false;
  if (std::ranges::all_of(texels, [](std::uint32_t texel) { return texel == 0; })) return {};
  if (const auto reserved = texture_.reserve(texels.size(), "colours of parts"); !reserved) return fail(reserved.error());
  texture_.upload(std::as_bytes(std::span(texels)));
  count_ = texels.size();
  any_transparent_ = std::ranges::any_of(paints, &PartPaint::transparent);
  return {};
}

void PaintTexture::use(const gl::Program& program, bool see_through) const {
  texture_.bind(unit::kPaint);
  program.set("part_paint", static_cast<int>(unit::kPaint));
  program.set("painted_parts", static_cast<int>(count_));
  program.set("see_through", see_through ? 1 : 0);
}

}  // namespace prismesh::kiosk::render
