// How long work says how far it is and learns that it should stop.
#pragma once

#include <functional>

#include "base/error.h"

namespace prismesh {

/// Called now and then with the fraction done (0..1), from the thread that started the work; false means stop: the work
/// then fails with the error `cancelled()`. An empty function means nobody watches.
using Progress = std::function<bool(double fraction)>;

/// The error of work that was told to stop.
inline Error cancelled() { return {{}, 0, "cancelled"}; }

}  // namespace prismesh
