#include "daemon/import/sandbox.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <type_traits>
#include <utility>

#include "ipc/wire/descriptor.h"

namespace prismesh::importer {

namespace {

/// A file is closed as soon as it is read. Standard error, socket, folder, memory and some room.
constexpr rlim_t kOpenFiles = 32;

tl::unexpected<Error> no_sandbox(const std::string& what, int code) {
  return fail("prismesh-import", "can't lock itself in, so it reads nothing: " + what + ": " + std::strerror(code));
}

Result<void> limit(int resource, rlim_t soft, rlim_t hard, const char* what) {
  rlimit value{soft, hard};
  // A limit that stands lower already is kept: raising it may be forbidden.
  rlimit before{};
  if (::getrlimit(static_cast<__rlimit_resource>(resource), &before) == 0) {
    value.rlim_max = std::min(value.rlim_max, before.rlim_max);
    value.rlim_cur = std::min(value.rlim_cur, value.rlim_max);
  }
  if (::setrlimit(static_cast<__rlimit_resource>(resource), &value) != 0) return no_sandbox(what, errno);
  return {};
}

Result<void> set_limits(const SandboxLimits& limits) {
  struct ResourceLimit {
    int resource;
    rlim_t soft;
    rlim_t hard;
    const char* what;
  };
  const ResourceLimit all[] = {
// AddressSanitizer and ThreadSanitizer reserve terabytes of addresses.
#if !defined(PRISMESH_ADDRESS_SANITIZER) && !defined(PRISMESH_THREAD_SANITIZER)
    {RLIMIT_AS, limits.memory_bytes, limits.memory_bytes, "the limit of memory"},
#endif
    // At the soft limit SIGXCPU says why the process ends; who ignores it ends a second later.
    {RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1, "the limit of processor time"},
    {RLIMIT_NOFILE, kOpenFiles, kOpenFiles, "the limit of open files"},
    {RLIMIT_FSIZE, 0, 0, "the limit of written bytes"},
    {RLIMIT_CORE, 0, 0, "the limit of core files"},
  };
  for (const ResourceLimit& each : all)
    if (Result<void> set = limit(each.resource, each.soft, each.hard, each.what); !set) return set;
  // Writing beyond the limit is an error to tell, not a reason to end.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGXCPU, SIG_DFL);
  return {};
}

/// Closes all descriptors but the kept ones and standard error, standard output too: the filter of system calls lets nobody write to it.
Result<void> close_others(const SandboxDescriptors& kept) {
  std::array<unsigned, 4> stay{STDERR_FILENO, static_cast<unsigned>(kept.folder), static_cast<unsigned>(kept.socket),
                               static_cast<unsigned>(kept.memory)};
  std::sort(stay.begin(), stay.end());
  unsigned first = 0;
  for (const unsigned each : stay) {
    if (each > first && ::syscall(SYS_close_range, first, each - 1, 0) != 0) return no_sandbox("closing descriptors", errno);
    first = std::max(first, each + 1);
  }
  if (::syscall(SYS_close_range, first, ~0U, 0) != 0) return no_sandbox("closing descriptors", errno);
  return {};
}

// --- Landlock: what may be done with files ---

/// All rights that a kernel's version of Landlock knows: what isn't allowed then is forbidden. Rights of later versions than the headers of
/// Debian 12 know are written as numbers.
std::uint64_t known_rights(int version) {
  std::uint64_t rights = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;
  constexpr std::uint64_t kRefer = std::uint64_t{1} << 13;     // of version 2
  constexpr std::uint64_t kTruncate = std::uint64_t{1} << 14;  // of version 3
  constexpr std::uint64_t kDevices = std::uint64_t{1} << 15;   // of version 5
  if (version >= 2) rights |= kRefer;
  if (version >= 3) rights |= kTruncate;
  if (version >= 5) rights |= kDevices;
  return rights;
}

/// Allows reading files beneath the folder only. Nothing: done; a sentence: the kernel can't.
Result<std::string> restrict_files(int folder) {
  const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1)
    return std::string(
        "this kernel has no Landlock: a deck that takes its reader over could read other files of the reader's user, and empty them");
  landlock_ruleset_attr rules{};
  rules.handled_access_fs = known_rights(static_cast<int>(version));
  const ipc::Descriptor ruleset(static_cast<int>(::syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0)));
  if (!ruleset) return no_sandbox("making rules for files", errno);
  landlock_path_beneath_attr beneath{};
  beneath.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
  beneath.parent_fd = folder;
  if (::syscall(SYS_landlock_add_rule, ruleset.get(), LANDLOCK_RULE_PATH_BENEATH, &beneath, 0) != 0)
    return no_sandbox("a rule for files", errno);
  if (::syscall(SYS_landlock_restrict_self, ruleset.get(), 0) != 0) return no_sandbox("rules for files", errno);
  return std::string();
}

// --- the filter of system calls ---

class CallFilter {
 public:
  CallFilter() : context_(::seccomp_init(SCMP_ACT_ERRNO(EPERM))) {
    if (context_ == nullptr) failure_ = ENOMEM;
  }
  CallFilter(const CallFilter&) = delete;
  CallFilter& operator=(const CallFilter&) = delete;
  ~CallFilter() {
    if (context_ != nullptr) ::seccomp_release(context_);
  }

  void allow(std::initializer_list<int> calls) {
    for (const int call : calls) add(SCMP_ACT_ALLOW, call, {});
  }
  /// Only where the argument with this number, as far as `mask` has bits, is `value`.
  struct Argument {
    unsigned number;
    std::uint64_t mask;
    std::uint64_t value;
  };
  void allow_where(int call, const Argument& is) { add(SCMP_ACT_ALLOW, call, {compared(is)}); }
  void allow_where(int call, const Argument& is, const Argument& and_is) { add(SCMP_ACT_ALLOW, call, {compared(is), compared(and_is)}); }
  void answer(int call, int code) { add(SCMP_ACT_ERRNO(static_cast<std::uint16_t>(code)), call, {}); }
  /// 0, or the first error.
  int load() {
    if (failure_ == 0) failure_ = -::seccomp_load(context_);
    return failure_;
  }

 private:
  static scmp_arg_cmp compared(const Argument& is) { return {is.number, SCMP_CMP_MASKED_EQ, is.mask, is.value}; }
  void add(std::uint32_t action, int call, std::initializer_list<scmp_arg_cmp> where) {
    if (failure_ == 0) failure_ = -::seccomp_rule_add_array(context_, action, call, static_cast<unsigned>(where.size()), std::data(where));
  }

  scmp_filter_ctx context_;
  int failure_ = 0;
};

/// Of a number that the kernel takes as an int.
constexpr std::uint64_t kIntBits = 0xffff'ffff;

/// Sockets, programs, other processes, names of files, rights, clocks: all that isn't here is refused with EPERM.
Result<void> restrict_calls(const SandboxDescriptors& kept) {
  CallFilter filter;
  // Memory, none of it executable.
  filter.allow({SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise)});
  constexpr CallFilter::Argument kNotExecutable{2, PROT_EXEC, 0};
  // No file is mapped but the memory to fill: a file that is open could be written so.
  filter.allow_where(SCMP_SYS(mmap), kNotExecutable, {3, MAP_ANONYMOUS, MAP_ANONYMOUS});
  filter.allow_where(SCMP_SYS(mmap), kNotExecutable, {4, kIntBits, static_cast<std::uint64_t>(kept.memory)});
  filter.allow_where(SCMP_SYS(mprotect), kNotExecutable);
  // Threads of this process. The library tries clone3 first; its flags can't be seen by a filter.
  constexpr std::uint64_t kThread = CLONE_THREAD | CLONE_VM;
  filter.allow_where(SCMP_SYS(clone), {0, kThread, kThread});
  filter.answer(SCMP_SYS(clone3), ENOSYS);
  filter.allow({SCMP_SYS(futex), SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(sched_yield), SCMP_SYS(sched_getaffinity),
                SCMP_SYS(gettid), SCMP_SYS(getpid), SCMP_SYS(membarrier), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn),
                SCMP_SYS(sigaltstack), SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(restart_syscall)});
  // abort() signals the process itself.
  filter.allow_where(SCMP_SYS(tgkill), {0, kIntBits, static_cast<std::uint64_t>(::getpid())});
  filter.allow({SCMP_SYS(clock_gettime), SCMP_SYS(clock_nanosleep), SCMP_SYS(nanosleep), SCMP_SYS(getrandom)});
  // Files: by openat2 alone, whose users say that a path must stay beneath the folder. Landlock sees to it.
  filter.allow({SCMP_SYS(openat2), SCMP_SYS(read), SCMP_SYS(pread64), SCMP_SYS(close), SCMP_SYS(fstat)});
  filter.allow_where(SCMP_SYS(newfstatat), {3, AT_EMPTY_PATH, AT_EMPTY_PATH});
  // The answer.
  filter.allow_where(SCMP_SYS(write), {0, kIntBits, STDERR_FILENO});
  filter.allow_where(SCMP_SYS(sendmsg), {0, kIntBits, static_cast<std::uint64_t>(kept.socket)});
  filter.allow({SCMP_SYS(poll), SCMP_SYS(ppoll)});
  filter.allow_where(SCMP_SYS(ftruncate), {0, kIntBits, static_cast<std::uint64_t>(kept.memory)});
  filter.allow_where(SCMP_SYS(fcntl), {1, kIntBits, F_ADD_SEALS});
#if defined(PRISMESH_ADDRESS_SANITIZER)
  // UndefinedBehaviorSanitizer finds out whether memory is there by writing it to a pipe.
  filter.allow({SCMP_SYS(pipe), SCMP_SYS(pipe2), SCMP_SYS(write)});
#endif
  if (const int code = filter.load(); code != 0) return no_sandbox("the filter of system calls", code);
  return {};
}

}  // namespace

Result<std::vector<std::string>> lock_in(const SandboxDescriptors& kept, const SandboxLimits& limits) {
  if (Result<void> closed = close_others(kept); !closed) return fail(std::move(closed.error()));
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return no_sandbox("no new privileges", errno);
  // Other processes of the same user can't look into it either.
  if (::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) != 0) return no_sandbox("no dump", errno);
  if (Result<void> set = set_limits(limits); !set) return fail(std::move(set.error()));
  std::vector<std::string> unguarded;
  Result<std::string> files = restrict_files(kept.folder);
  if (!files) return fail(std::move(files.error()));
  if (!files->empty()) unguarded.push_back(std::move(*files));
  if (Result<void> restricted = restrict_calls(kept); !restricted) return fail(std::move(restricted.error()));
  return unguarded;
}

}  // namespace prismesh::importer
