// Follows the catalogue of a station.
#pragma once

#include <functional>

#include "ipc/remote/remote_station.h"

namespace prismesh::ipc::remote {

/// Calls `heard` for each event until `remote` is stopped (then it returns) or its patience is over. A line that was cut is made again;
/// what happened meanwhile isn't told. `connected`: called each time that the following begins.
Result<void> watch(RemoteStation& remote, const std::function<void()>& connected, const std::function<void(const CatalogueEvent&)>& heard);

}  // namespace prismesh::ipc::remote
