#include "kiosk/render/plate_textures.h"

#include <algorithm>
#include <bit>

namespace prismesh::kiosk::render {

void PlateTextures::note(const ModelChanges& changes) {
  stale_ = stale_ || changes.topology || changes.visibility || changes.reparted;
  if (!stale_) moved_chunks_.insert(moved_chunks_.end(), changes.moved_chunks.begin(), changes.moved_chunks.end());
}

Result<void> PlateTextures::update(const ModelTable& table) {
  std::vector<float> thicknesses = plate_thicknesses(table.source());
  stale_ = stale_ || thicknesses != thicknesses_ || shape_.shell_count() != table.shell_count();
  if (!stale_ && moved_chunks_.empty()) return {};
  const Result<bool> fresh = rows_.reserve(table.shell_count(), "plates");
  if (!fresh) return fail(fresh.error());
  if (const auto reserved = thickness_texture_.reserve(thicknesses.size(), "thicknesses of parts"); !reserved)
    return fail(reserved.error());
  if (stale_ || *fresh) {
    std::vector<std::uint32_t> bits;
    for (const float thickness : thicknesses) bits.push_back(std::bit_cast<std::uint32_t>(thickness));
    thickness_texture_.upload(std::as_bytes(std::span(bits)));
    thicknesses_ = std::move(thicknesses);
    shape_.make(table, thicknesses_);
    for (std::size_t chunk = 0; chunk * mesh::kChunkSize < table.shell_count(); ++chunk) upload_chunk(chunk);
  } else {
    for (const std::uint32_t chunk : shape_.move(table, moved_chunks_)) upload_chunk(chunk);
  }
  stale_ = false;
  moved_chunks_.clear();
  return {};
}

void PlateTextures::upload_chunk(std::size_t chunk) {
  std::vector<PlateRow> rows;
  for (std::size_t s = chunk * mesh::kChunkSize; s < std::min((chunk + 1) * mesh::kChunkSize, shape_.shell_count()); ++s)
    rows.push_back(shape_.row(s));
  rows_.upload_row(chunk, std::as_bytes(std::span(rows)));
}

double PlateTextures::max_thickness() const {
  return thicknesses_.empty() ? 0 : *std::max_element(thicknesses_.begin(), thicknesses_.end());
}

}  // namespace prismesh::kiosk::render
