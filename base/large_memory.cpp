#include "base/large_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <utility>

namespace prismesh {
namespace {

constexpr std::size_t kPoolBlock = 4 * kLargePage;

std::size_t round_up(std::size_t value, std::size_t to) { return (value + to - 1) / to * to; }

}  // namespace

void prefer_large_pages(void* begin, std::size_t bytes) {
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = round_up(first, kLargePage);
  const std::uintptr_t to = (first + bytes) / kLargePage * kLargePage;
  if (from < to) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
}

LargeBlock::LargeBlock(std::size_t bytes) : size_(bytes) {
  if (bytes < kLargePage) {
    data_ = new char[bytes]();
    return;
  }
  if (bytes > SIZE_MAX / 2) throw std::bad_alloc();
  // Maps one page more for the alignment and unmaps the excess at once. Memory beyond the last whole large page is never touched.
  const std::size_t wanted = round_up(bytes, kLargePage) + kLargePage;
  void* mapped = ::mmap(nullptr, wanted, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  char* begin = static_cast<char*>(mapped);
  const std::size_t before = round_up(reinterpret_cast<std::uintptr_t>(begin), kLargePage) - reinterpret_cast<std::uintptr_t>(begin);
  mapped_ = round_up(bytes, kLargePage);
  if (before > 0) ::munmap(begin, before);
  if (before < kLargePage) ::munmap(begin + before + mapped_, kLargePage - before);
  data_ = begin + before;
  ::madvise(data_, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
}

LargeBlock::LargeBlock(LargeBlock&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)), mapped_(std::exchange(other.mapped_, 0)) {}

LargeBlock& LargeBlock::operator=(LargeBlock&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(mapped_, other.mapped_);
  return *this;
}

LargeBlock::~LargeBlock() {
  if (mapped_ > 0)
    ::munmap(data_, mapped_);
  else
    delete[] data_;
}

std::pair<void*, std::shared_ptr<const LargeBlock>> LargePool::take(std::size_t bytes) {
  bytes = round_up(bytes, kAlignment);
  const std::lock_guard lock(mutex_);
  if (!block_ || block_->size() - used_ < bytes) {
    block_ = std::make_shared<const LargeBlock>(std::max(bytes, kPoolBlock));
    used_ = 0;
  }
  void* data = block_->data() + used_;
  used_ += bytes;
  return {data, block_};
}

}  // namespace prismesh
