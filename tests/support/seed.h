// Random numbers that are the same in every run, until `./station soak` asks for others.
#pragma once

#include <cstdlib>

namespace prismesh::test {

/// A seed for a test's `number`-th sequence; PRISMESH_SEED in the environment makes it another one.
inline unsigned seed(unsigned number) {
  const char* const other = std::getenv("PRISMESH_SEED");
  return number + (other == nullptr ? 0 : 1'000'003u * static_cast<unsigned>(std::strtoul(other, nullptr, 10)));
}

}  // namespace prismesh::test
