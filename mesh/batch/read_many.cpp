#include "mesh/batch/read_many.h"

#include <algorithm>

#include "base/tasks.h"

namespace prismesh::mesh::batch {

namespace {

constexpr std::size_t kReaders = 16;
constexpr std::size_t kBlock = 64;

}  // namespace

void read_many(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& each) {
  const auto read = [&](std::size_t block, const std::function<void()>&) { each(block * kBlock, std::min(count, (block + 1) * kBlock)); };
  run_tasks((count + kBlock - 1) / kBlock, kReaders, read, [] {});
}

}  // namespace prismesh::mesh::batch
