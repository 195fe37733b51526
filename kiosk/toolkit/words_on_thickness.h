// Says which parts aren't drawn with the real thickness of their shells. Pure.
#pragma once

#include <span>
#include <string>

#include "ipc/model/snapshot_info.h"

namespace prismesh::kiosk::toolkit {

/// Of the parts with shells: how many are drawn as surfaces, as not all of their shells have a thickness, and how many with a mean
/// thickness, as their shells differ. Empty: none.
std::string words_on_thickness(std::span<const ipc::SnapshotPart> parts);

}  // namespace prismesh::kiosk::toolkit
