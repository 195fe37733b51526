// Regions in which parts touch, in words.
#pragma once

#include <string>

#include "ipc/model/messages.h"

namespace prismesh::kiosk::tools::contact {

/// "7 Roof", "no part".
std::string part_words(const std::string& part, const std::string& name);
/// How deep a region is, or what it is otherwise: "0.8 mm deep", "half through".
std::string depth_words(const ipc::ContactRegion& region, const std::string& unit);
/// All of it: "cross, 0.8 mm deep: 7 Roof and 9 Rail, joined".
std::string region_words(const ipc::ContactRegion& region, const std::string& unit);
/// A row of the list, behind a sign of the kind: "0.8 mm: 7 Roof, 9 Rail".
std::string row_words(const ipc::ContactRegion& region, const std::string& unit);
/// "2 cross, 1 too close, 1 within the gap".
std::string count_words(const ipc::Contacts& contacts);

}  // namespace prismesh::kiosk::tools::contact
