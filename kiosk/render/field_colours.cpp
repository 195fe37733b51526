#include "kiosk/render/field_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace prismesh::kiosk::render {

namespace {

constexpr TexelFormat kValueTexel{GL_RG32F, GL_RG, GL_FLOAT, 8};

}  // namespace

std::optional<Colour> FieldLook::colour_of(double value) const {
  double share = (value - clear) / (full - clear);
  if (!(share > 0)) return std::nullopt;
  share = std::min(share, 1.0);
  if (bands > 0) share = (std::floor(std::min(share, 0.9999) * bands) + 0.5) / bands;
  return colours_of(map)[static_cast<std::size_t>(std::lround(share * (kColourMapSteps - 1)))];
}

FieldColours::FieldColours() : values_(kValueTexel) {}

std::size_t FieldColours::bytes_for(std::size_t values) { return RowTexture::bytes_for(values, kValueTexel); }

Result<void> FieldColours::set(std::span<const float> values, bool on_nodes) {
  shown_ = 0;
  const Result<bool> renewed = values_.reserve(values.size(), "values");
  if (!renewed) return fail(renewed.error());
  if (*renewed) known_.clear();
  std::vector<std::array<float, 2>> texels;
  for (std::size_t begin = 0; begin < values.size(); begin += RowTexture::kWidth) {
    const std::span<const float> row = values.subspan(begin, std::min(RowTexture::kWidth, values.size() - begin));
    const bool same = known_.size() >= begin + row.size() && std::memcmp(known_.data() + begin, row.data(), row.size_bytes()) == 0;
    if (same) continue;
    texels.clear();
    for (const float value : row) texels.push_back(std::isfinite(value) ? std::array<float, 2>{value, 1} : std::array<float, 2>{0, 0});
    values_.upload_row(begin / RowTexture::kWidth, std::as_bytes(std::span(texels)));
  }
  known_.assign(values.begin(), values.end());
  on_nodes_ = on_nodes;
  shown_ = values.size();
  return {};
}

int FieldColours::kind_for(const ModelTable& table) const {
  if (shown_ == 0 || shown_ != (on_nodes_ ? table.node_count() : table.shell_count())) return 0;
  return on_nodes_ ? 1 : 2;
}

void FieldColours::bind(unsigned values_unit, unsigned map_unit, const FieldLook& look) {
  if (map_shown_ != look.map) {
    std::vector<std::array<std::uint8_t, 4>> texels;
    for (const Colour& colour : colours_of(look.map)) {
      const auto byte = [](float value) { return static_cast<std::uint8_t>(std::lround(value * 255)); };
      texels.push_back({byte(colour.x()), byte(colour.y()), byte(colour.z()), 255});
    }
    map_ = gl::Texture::make();
    glActiveTexture(GL_TEXTURE0 + map_unit);
    glBindTexture(GL_TEXTURE_2D, map_.get());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, static_cast<GLsizei>(kColourMapSteps), 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(kColourMapSteps), 1, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, name, GL_LINEAR);
    for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, name, GL_CLAMP_TO_EDGE);
    map_shown_ = look.map;
  }
  values_.bind(values_unit);
  glActiveTexture(GL_TEXTURE0 + map_unit);
  glBindTexture(GL_TEXTURE_2D, map_.get());
}

}  // namespace prismesh::kiosk::render
