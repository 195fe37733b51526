// Owners of file descriptors and mappings, and shared memory.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "base/error.h"

namespace prismesh::ipc {

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  int release() { return std::exchange(fd_, -1); }
  Result<Descriptor> duplicate() const;
  /// Whether both are of the same file or shared memory; false if one of them is none.
  bool same_file(const Descriptor& other) const;

 private:
  int fd_ = -1;
};

/// A shared-memory mapping.
class Mapping {
 public:
  /// Maps the whole descriptor; read-only unless `writable`. Refuses a read-only mapping of memory that could shrink under
  /// the reader (not sealed with F_SEAL_SHRINK).
  static Result<Mapping> map(const Descriptor& descriptor, bool writable);
  Mapping() = default;
  Mapping(Mapping&& other) noexcept : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  Mapping& operator=(Mapping&& other) noexcept;
  ~Mapping();

  std::span<const std::byte> bytes() const { return {data_, size_}; }
  std::span<std::byte> writable_bytes() { return {data_, size_}; }

 private:
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Anonymous shared memory of a fixed size, sealed against shrinking and growing.
Result<Descriptor> make_shared_memory(const char* name, std::size_t size);
/// Anonymous shared memory with this content, sealed against any change.
Result<Descriptor> make_sealed_memory(const char* name, std::span<const std::byte> content);
/// Adds F_SEAL_FUTURE_WRITE and F_SEAL_SEAL: mappings made before can write, later ones only read.
Result<void> seal_for_readers(const Descriptor& descriptor);
/// Checks that a page from another process has all the seals that its reader relies on. `name` is the page's, for the error.
Result<void> check_page_seals(const Descriptor& descriptor, const char* name);
/// Allocates the memory of a range now, so that missing memory is an error here instead of a SIGBUS at the first write.
Result<void> reserve(const Descriptor& descriptor, std::size_t offset, std::size_t size);

}  // namespace prismesh::ipc
