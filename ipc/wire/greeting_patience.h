// How long clients wait for a greeting.
#pragma once

#include <chrono>

namespace prismesh::ipc {

/// Max time that a listening daemon may take to greet.
inline constexpr std::chrono::seconds kGreetingPatience{10};

}  // namespace prismesh::ipc
