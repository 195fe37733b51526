// Explains why a device's file couldn't be opened and what the user can do about it. Private to drivers/port.
#pragma once

#include <string>

#include "base/error.h"

namespace prismesh::drivers::port {

/// Returns the error for `path`. `error` is the errno after opening or locking it.
Error open_error(const std::string& path, int error);
/// The same for a USB device that is driven from user space. `name`: as the user calls it.
Error usb_open_error(const std::string& name, const std::string& path, int error);

/// Locks the terminal for this opener with an advisory lock (flock), which every opener in this project asks for. Returns 0 or an errno:
/// EBUSY if another opener holds the lock.
int lock(int descriptor);

/// Excludes programs that don't ask for the lock (TIOCEXCL; the superuser can still open the terminal). Don't use it for pseudo-terminals:
/// there the flag stays after closing until the master is closed too. Returns 0 or an errno.
int refuse_others(int descriptor);

}  // namespace prismesh::drivers::port
