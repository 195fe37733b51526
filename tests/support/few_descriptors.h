// A process that has run out of descriptors.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <vector>

namespace prismesh::test {

/// Limits the process to so many more open files until the end of the scope.
class FewDescriptors {
 public:
  explicit FewDescriptors(int free) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    std::vector<int> opened;
    for (int i = 0; i <= free; ++i) opened.push_back(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    for (const int each : opened) ::close(each);
    const rlimit few{static_cast<rlim_t>(opened.back()), before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

}  // namespace prismesh::test
