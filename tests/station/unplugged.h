// Takes the monitor of an X server away.
#pragma once

#include <string>

namespace prismesh::test {

/// Switches every output of the display off, as when its cable is pulled. Returns whether it had one.
bool switch_outputs_off(const std::string& display);

}  // namespace prismesh::test
