#include "kiosk/render/glyph_levels.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>

namespace prismesh::kiosk::render {

namespace {

constexpr int kZeroLevel = 128;  ///< of cells of 1
constexpr int kMostLevels = 40;  ///< from the least cells on: more than any model is large

/// Where glyphs stand, and which: all those of a shell, or one cluster.
struct Site {
  mesh::Vec3 at;
  std::size_t first = 0, count = 0;
};

std::vector<Site> sites_of(const ModelTable& table, const std::vector<Glyph>& glyphs) {
  std::vector<Site> sites;
  const auto is_cluster = [](const Glyph& glyph) { return (glyph.kind & 15U) == static_cast<std::uint32_t>(GlyphShape::cluster); };
  for (std::size_t g = 0; g < glyphs.size(); ++g) {
    if (g > 0 && glyphs[g].shell == glyphs[g - 1].shell && !is_cluster(glyphs[g]) && !is_cluster(glyphs[g - 1])) {
      ++sites.back().count;
      continue;
    }
    mesh::Vec3 at = mesh::Vec3::Zero();
    mesh::ShellNodes nodes;
    if (is_cluster(glyphs[g]) && table.shell(glyphs[g].shell, nodes))
      at = table.position(nodes.node[(glyphs[g].kind >> kGlyphPlaceShift) & 3U].value);
    else if (!table.shell_centre(glyphs[g].shell, at))
      at = mesh::Vec3::Zero();
    sites.push_back({at, g, 1});
  }
  return sites;
}

std::uint64_t cell_of(const mesh::Vec3& at, double edge) {
  std::uint64_t key = 0xcbf29ce484222325ULL;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = std::clamp(std::floor(at[axis] / edge), -1e18, 1e18);
    key = (key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(place))) * 0x9e3779b97f4a7c15ULL;
    key ^= key >> 29;
  }
  return key;
}

std::uint32_t level_of(int exponent) {
  return static_cast<std::uint32_t>(std::clamp(exponent + kZeroLevel, 0, static_cast<int>(kShownAtEveryLevel)));
}

}  // namespace

void set_glyph_levels(const ModelTable& table, double least, std::vector<Glyph>& glyphs) {
  const auto set = [&](const Site& site, std::uint32_t level) {
    for (std::size_t g = site.first; g < site.first + site.count; ++g)
      glyphs[g].kind = (glyphs[g].kind & ((1U << kGlyphLevelShift) - 1)) | level << kGlyphLevelShift;
  };
  std::vector<Site> left = sites_of(table, glyphs);
  std::reverse(left.begin(), left.end());  // the last one is the first in its cell
  int exponent = least > 0 && std::isfinite(least) ? static_cast<int>(std::clamp(std::floor(std::log2(least)), -120.0, 80.0)) : 0;
  std::unordered_set<std::uint64_t> taken;
  for (int step = 0; step < kMostLevels && left.size() > 1; ++step, ++exponent) {
    taken.clear();
    const double edge = std::exp2(exponent);
    std::vector<Site> stay;
    for (const Site& site : left)
      if (taken.insert(cell_of(site.at, edge)).second)
        stay.push_back(site);
      else
        set(site, level_of(exponent - 1));
    left = std::move(stay);
  }
  for (const Site& site : left) set(site, kShownAtEveryLevel);
}

std::uint32_t needed_glyph_level(double spacing) {
  if (!(spacing > 0) || !std::isfinite(spacing)) return 0;
  return level_of(static_cast<int>(std::clamp(std::round(std::log2(spacing)), -1000.0, 1000.0)));
}

}  // namespace prismesh::kiosk::render
