#include "ipc/wire/descriptor.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace prismesh::ipc {

namespace {

tl::unexpected<Error> system_failure(const std::string& what) {
  const int code = errno;
  return fail("shared memory", what + ": " + std::strerror(code));
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = std::exchange(other.fd_, -1);
  }
  return *this;
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

Result<Descriptor> Descriptor::duplicate() const {
  Descriptor copy(::fcntl(fd_, F_DUPFD_CLOEXEC, 0));
  if (!copy) return system_failure("no further descriptor");
  return copy;
}

bool Descriptor::same_file(const Descriptor& other) const {
  struct stat ours {};
  struct stat theirs {};
  if (::fstat(fd_, &ours) != 0 || ::fstat(other.fd_, &theirs) != 0) return false;
  return ours.st_dev == theirs.st_dev && ours.st_ino == theirs.st_ino;
}

Result<Mapping> Mapping::map(const Descriptor& descriptor, bool writable) {
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) return system_failure("not a descriptor of shared memory");
  if (status.st_size <= 0) return fail("shared memory", "it is empty");
  if (!writable) {
    const int seals = ::fcntl(descriptor.get(), F_GET_SEALS);
    if (seals < 0 || (seals & F_SEAL_SHRINK) == 0)
      return fail("shared memory", "it could shrink while it is read (F_SEAL_SHRINK is missing)");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* data = ::mmap(nullptr, size, writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, descriptor.get(), 0);
  if (data == MAP_FAILED) return system_failure("mapping " + std::to_string(size) + " bytes");
  Mapping mapping;
  mapping.data_ = static_cast<std::byte*>(data);
  mapping.size_ = size;
  return mapping;
}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  if (this != &other) {
    if (data_ != nullptr) ::munmap(data_, size_);
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
  }
  return *this;
}

Mapping::~Mapping() {
  if (data_ != nullptr) ::munmap(data_, size_);
}

Result<Descriptor> make_shared_memory(const char* name, std::size_t size) {
  Descriptor descriptor(::memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!descriptor) return system_failure("making shared memory");
  if (::ftruncate(descriptor.get(), static_cast<off_t>(size)) != 0)
    return system_failure("sizing shared memory to " + std::to_string(size) + " bytes");
  if (::fcntl(descriptor.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0) return system_failure("sealing shared memory");
  return descriptor;
}

Result<Descriptor> make_sealed_memory(const char* name, std::span<const std::byte> content) {
  Descriptor descriptor(::memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!descriptor) return system_failure("making shared memory");
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor.get(), content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return system_failure("filling shared memory");
    content = content.subspan(static_cast<std::size_t>(written));
  }
  if (::fcntl(descriptor.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL) != 0)
    return system_failure("sealing shared memory");
  return descriptor;
}

Result<void> seal_for_readers(const Descriptor& descriptor) {
  if (::fcntl(descriptor.get(), F_ADD_SEALS, F_SEAL_FUTURE_WRITE | F_SEAL_SEAL) != 0)
    return system_failure("sealing shared memory against writing");
  return {};
}

Result<void> check_page_seals(const Descriptor& descriptor, const char* name) {
  constexpr int kSize = F_SEAL_SHRINK | F_SEAL_GROW;
  constexpr int kWriting = F_SEAL_FUTURE_WRITE | F_SEAL_WRITE;
  const int seals = ::fcntl(descriptor.get(), F_GET_SEALS);
  if (seals < 0) return fail(name, "it isn't sealed memory");
  if ((seals & kSize) != kSize) return fail(name, "its size could change while it is read (F_SEAL_SHRINK or F_SEAL_GROW is missing)");
  if ((seals & kWriting) == 0) return fail(name, "somebody else could write it (F_SEAL_FUTURE_WRITE is missing)");
  return {};
}

Result<void> reserve(const Descriptor& descriptor, std::size_t offset, std::size_t size) {
  int status = 0;
  do status = ::fallocate(descriptor.get(), 0, static_cast<off_t>(offset), static_cast<off_t>(size));
  while (status != 0 && errno == EINTR);
  if (status != 0) return system_failure("no memory for " + std::to_string(size) + " bytes more");
  return {};
}

}  // namespace prismesh::ipc
