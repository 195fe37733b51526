// What a pull comes to touch, in words.
#pragma once

#include <string>

#include "ipc/model/preview.h"
#include "ipc/model/snapshot_info.h"

namespace prismesh::kiosk::tools::shaping {

/// "2 parts touch: 7 Roof and 9 Rail, 0.8 mm deep"; empty: nothing touches. Says, too, if nothing is looked for.
std::string touch_words(const ipc::PreviewTouches& touches, const ipc::SnapshotInfo& info);

}  // namespace prismesh::kiosk::tools::shaping
