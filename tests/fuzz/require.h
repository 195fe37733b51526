// What must hold whatever the bytes are: a fuzz target ends where it doesn't.
#pragma once

#include <cstdlib>

inline void require(bool holds) {
  if (!holds) std::abort();
}
