// How long work says how far it is and learns that it should stop.
#pragma once

#include <functional>

namespace prismesh {

/// Called now and then with the fraction done (0..1), from the thread that started the work; false means stop: the work
/// then fails with the error `cancelled()`. An empty function means nobody watches.
using Progress = std::function<bool(double fraction)>;

}  // namespace prismesh
