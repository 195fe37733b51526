// The addresses by which this machine can be reached.
#pragma once

#include <string>
#include <vector>

namespace prismesh::ipc {

/// With their prefixes, in order, without those of the machine alone and those of IPv6 that hold on one line only.
std::vector<std::string> own_addresses();

}  // namespace prismesh::ipc
