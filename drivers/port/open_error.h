// Why a device's file couldn't be opened, in words that tell the user what to do. Private to drivers/port.
#pragma once

#include <string>

#include "base/error.h"

namespace prismesh::drivers::port {

/// `error` is errno after opening or claiming `path`.
Error open_error(const std::string& path, int error);

/// Takes the terminal for this opener alone, with an advisory lock that every opener here asks for. 0, or errno: EBUSY when somebody else
/// has it.
int lock(int descriptor);

/// Refuses programs that don't ask for the lock (TIOCEXCL, which the superuser passes). Not for pseudo-terminals: theirs outlives the close
/// until the master goes too.
int refuse_others(int descriptor);

}  // namespace prismesh::drivers::port
