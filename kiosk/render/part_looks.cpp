#include "kiosk/render/part_looks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;
using mesh::quality::Grade;
using mesh::quality::ShellState;

std::vector<PartState> part_states(const ModelTable& table, bool damaged) {
  const ModelSource& source = table.source();
  const SnapshotArray array = damaged ? SnapshotArray::shell_damage : SnapshotArray::shell_quality;
  std::vector<PartState> parts(source.part_count());
  for (std::size_t c = 0; c < source.chunk_count(array); ++c) {
    const std::span<const ShellState> states = source.chunk<ShellState>(array, c);
    const std::size_t begin = c * mesh::kChunkSize;
    for (std::size_t i = 0; i < states.size() && begin + i < table.shell_count(); ++i) {
      const std::size_t part = table.shell_part(begin + i).value;
      const bool removed = source.at<ShellState>(SnapshotArray::shell_quality, begin + i).is_removed();  // not recorded in shell_damage
      if (part >= parts.size() || removed) continue;
      ++parts[part].shells;
      parts[part].warn += states[i].grade() == Grade::warn;
      parts[part].fail += states[i].grade() == Grade::fail;
    }
  }
  return parts;
}

Colour colour_of_state(const PartState& state) {
  constexpr float kMinStrength = 0.3F, kFullShare = 0.1F;
  const std::array<Colour, 3>& grades = grade_colours();
  const std::size_t wrong = state.fail > 0 ? state.fail : state.warn;
  if (wrong == 0) return grades[0];
  const float share = static_cast<float>(wrong) / static_cast<float>(state.shells) / kFullShare;
  const float strength = kMinStrength + (1 - kMinStrength) * std::min(share, 1.0F);
  return (1 - strength) * grades[0] + strength * grades[state.fail > 0 ? 2 : 1];
}

Result<void> PartLooks::update(const ModelTable& table, bool damaged) {
  std::vector<std::array<std::uint32_t, 2>> looks;
  for (const PartState& state : part_states(table, damaged)) {
    const Colour colour = colour_of_state(state);
    const auto byte = [](float value) { return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)); };
    looks.push_back({byte(colour.x()) | byte(colour.y()) << 8 | byte(colour.z()) << 16, 0});
  }
  count_ = 0;
  if (const auto reserved = texture_.reserve(looks.size(), "parts"); !reserved) return fail(reserved.error());
  texture_.upload(std::as_bytes(std::span(looks)));
  count_ = looks.size();
  return {};
}

}  // namespace prismesh::kiosk::render
