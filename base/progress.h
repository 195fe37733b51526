// How long work reports its progress and is told to stop.
#pragma once

#include <functional>

#include "base/error.h"

namespace prismesh {

/// Is called repeatedly with the fraction done (0..1), on the thread that started the work. Returns false to stop: the work then fails
/// with the error `cancelled()`. An empty function is never called.
using Progress = std::function<bool(double fraction)>;

/// The error of work that was told to stop.
inline Error cancelled() { return {{}, 0, "cancelled", ErrorKind::cancelled}; }
/// Whether an error is that of work that was told to stop, whatever file it names.
inline bool is_cancelled(const Error& error) { return error.kind == ErrorKind::cancelled; }

}  // namespace prismesh
