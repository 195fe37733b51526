#include "kiosk/tools/shaping/touch_words.h"

#include <fmt/format.h>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::shaping {

namespace {

std::string part_words(mesh::PartIndex part, const ipc::SnapshotInfo& info) {
  if (part.value >= info.parts.size()) return "shells without a part";
  const ipc::SnapshotPart& named = info.parts[part.value];
  return named.name.empty() ? fmt::format("part {}", named.id) : fmt::format("{} {}", named.id, panels::printable(named.name));
}

}  // namespace

std::string touch_words(const ipc::PreviewTouches& touches, const ipc::SnapshotInfo& info) {
  if (!touches.watched) return "so many shells move that it isn't seen what they touch";
  if (touches.parts == 0) return {};
  const std::string a = part_words(touches.part_a, info), b = part_words(touches.part_b, info);
  const char* verb = touches.cross ? "cross" : "touch";
  const std::string depth = touches.cross ? "" : ", " + panels::length_text(touches.depth, info.length_unit) + " deep";
  if (touches.parts == 1) return fmt::format("1 part {}es itself: {}{}", verb, a, depth);
  return fmt::format("{} parts {}: {}{} and {}{}", touches.parts, verb, touches.parts > 2 ? "the worst are " : "", a, b, depth);
}

}  // namespace prismesh::kiosk::tools::shaping
