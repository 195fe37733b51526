// A tick of the pen's loop allocates, locks and logs nothing: this program counts its calls of operator new and pthread_mutex_lock, and the
// kernel counts all system calls but those that read and write the pen's line.
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/port/open_port.h"
#include "drivers/port/pty_pair.h"
#include "tests/daemon/deviced/pen/pen_loop_rig.h"

namespace {
thread_local std::size_t allocations = 0, locks = 0;

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

/// Takes the place of the library's for this program.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  ++locks;
  int status = 0;
  while ((status = ::pthread_mutex_trylock(mutex)) == EBUSY) ::sched_yield();
  return status;
}

namespace prismesh::deviced::pen {
namespace {

volatile sig_atomic_t other_calls = 0;
void count_call(int) { other_calls = other_calls + 1; }

/// From now on this thread's calls but these are counted instead of made: reading, ioctl, poll, writing to the two ends of the line, ending
/// the process.
bool count_other_calls(int line, int device) {
  struct sigaction counts {};
  counts.sa_handler = count_call;
  ::sigaction(SIGSYS, &counts, nullptr);
  std::vector<sock_filter> rules{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  const auto allow_if = [&rules](unsigned value) {
    rules.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1));
    rules.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  };
  for (const unsigned call : {SYS_read, SYS_ioctl, SYS_poll, SYS_exit_group, SYS_rt_sigreturn}) allow_if(call);
  rules.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_write, 1, 0));
  rules.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  rules.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[0])));
  allow_if(static_cast<unsigned>(line));
  allow_if(static_cast<unsigned>(device));
  rules.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  const sock_fprog program{static_cast<unsigned short>(rules.size()), rules.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

enum Found { kNothing = 0, kAllocations = 1, kLocks = 2, kCalls = 4, kMissingStages = 8, kNoFilter = 16 };

/// Ticks in all stages, on a real pseudo-terminal, with something done beside each tick. Returns what was found that a tick mustn't do;
/// looks for other calls only if they are to be counted.
int what_ticks_do(const std::function<void()>& beside, bool counts_calls) {
  drivers::port::PtyPair pair = drivers::port::open_pty_pair().value();
  const auto line = drivers::port::open_port(pair.slave_path, 115'200).value();
  GuardPage guard;
  GuardedPort guarded(*line, guard);
  drivers::haptic_pen::framed::FramedPen pen(guarded, drivers::haptic_pen::framed::simulated_limits({}));
  drivers::haptic_pen::framed::SimulatedDevice device(*pair.master, {}, PenLoopRig::hand);
  FieldReader fields;
  ipc::HapticFieldPage field_page = ipc::HapticFieldPage::create().value();
  field_page.publish(*std::make_unique<HapticField>());
  fields.attach(ipc::HapticFieldPageReader::map(field_page.descriptor()).value());
  ipc::PenPage page = ipc::PenPage::create().value();
  PenLoop loop({}, pen, fields, guard, page, {}, {});
  std::int64_t now = 1'000'000'000;
  unsigned stages = 0;
  ::usleep(50'000);  // until the field was copied
  if (counts_calls && !count_other_calls(line->descriptor(), pair.master->descriptor())) ::_exit(kNoFilter);
  const std::size_t allocations_before = allocations, locks_before = locks;
  for (int i = 0; i < 4000; ++i) {
    now += i % 1000 == 899 ? 20'000'000 : 1'000'000;
    device.step(now);
    // The kernel passes the pose on in its own time.
    for (int waiting = 0, turn = 0; waiting == 0 && turn < 100'000; ++turn) ::ioctl(line->descriptor(), FIONREAD, &waiting);
    if (i % 300 == 50) loop.send(RequestArm{});
    if (i % 300 == 150) loop.send(UseFeel{});
    if (i % 1000 == 370) loop.send(RequestDisarm{});
    if (i % 1000 == 700) guard.token = LineToken::tripped;
    loop.tick(now);
    beside();
    stages |= 1U << static_cast<unsigned>(page.state().stage);
  }
  constexpr unsigned kStages = 1U << static_cast<unsigned>(ipc::PenStage::disarmed) | 1U << static_cast<unsigned>(ipc::PenStage::armed) |
                               1U << static_cast<unsigned>(ipc::PenStage::latched);
  const int found = (allocations != allocations_before ? kAllocations : 0) | (locks != locks_before ? kLocks : 0) |
                    (other_calls > 0 ? kCalls : 0) | ((stages & kStages) != kStages ? kMissingStages : 0);
  // What follows would be trapped, and before _exit the sanitizer asks for the signal stack.
  if (counts_calls) ::syscall(SYS_exit_group, found);
  return found;
}

/// Ticks once without the filter before: at the first use of each class the sanitizer asks the kernel whether its memory can be read.
[[noreturn]] void exit_with_what_ticks_do(const std::function<void()>& beside) {
  what_ticks_do(beside, false);
  ::_exit(what_ticks_do(beside, true));
}

TEST(PenTickDeathTest, allocates_locks_and_logs_nothing) {
  EXPECT_EXIT(exit_with_what_ticks_do([] {}), testing::ExitedWithCode(kNothing), "");
}

TEST(PenTickDeathTest, would_be_found_to_allocate_lock_or_log) {
  // Rarely, so that the sanitizer's allocator has the memory and needn't ask the kernel, which would be trapped.
  EXPECT_EXIT(exit_with_what_ticks_do([calls = 0]() mutable {
                if (++calls % 1000 != 0) return;
                auto* volatile memory = new int(1);
                delete memory;
              }),
              testing::ExitedWithCode(kAllocations), "");
  EXPECT_EXIT(exit_with_what_ticks_do([] {
                static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
                ::pthread_mutex_lock(&mutex);
                ::pthread_mutex_unlock(&mutex);
              }),
              testing::ExitedWithCode(kLocks), "");
  EXPECT_EXIT(exit_with_what_ticks_do([] { (void)!::write(STDERR_FILENO, "", 0); }), testing::ExitedWithCode(kCalls), "");
}

}  // namespace
}  // namespace prismesh::deviced::pen
