#include "daemon/deviced/pen/guard_process.h"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "drivers/haptic_pen/framed/frame.h"

namespace prismesh::deviced::pen {
namespace {

using drivers::haptic_pen::framed::ForceFrame;
using drivers::haptic_pen::framed::FrameBytes;
using drivers::haptic_pen::framed::Sender;

/// Above the loop's, so that a loop that never sleeps can't keep the guard from running.
constexpr int kGuardPriority = 45;
constexpr std::int64_t kLookNs = 1'000'000;
/// A line that waits for the next process gets a zero frame so often.
constexpr std::int64_t kKeepNs = 20'000'000;
constexpr int kLastZeros = 5;
/// A USB device takes a packet within this, or never.
constexpr unsigned kUsbPatienceMs = 20;

volatile sig_atomic_t told_to_end = 0;
void note_end(int) { told_to_end = 1; }

std::int64_t now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

void close_others(int a, int b) {
  const unsigned low = static_cast<unsigned>(std::min(a, b)), high = static_cast<unsigned>(std::max(a, b));
  if (low > 0) ::syscall(SYS_close_range, 0u, low - 1, 0u);
  if (high > low + 1) ::syscall(SYS_close_range, low + 1, high - 1, 0u);
  ::syscall(SYS_close_range, high + 1, ~0u, 0u);
}

class Guard {
 public:
  Guard(GuardPage& page, int socket, int parent) : page_(page), socket_(socket), parent_(parent) {}

  [[noreturn]] void run() {
    changed_ns_ = now_ns();
    for (;;) {
      wait();
      while (!orphan_ && take_word()) {
      }
      // While the other process lives it says when to end: systemd tells both at once.
      if (orphan_ && told_to_end != 0) end();
      if (line_ >= 0) look();
      if (orphan_ && line_ < 0) ::_exit(0);
    }
  }

 private:
  void wait() {
    pollfd watched{orphan_ ? -1 : socket_, POLLIN, 0};
    const timespec pause{0, static_cast<long>(kLookNs)};
    ::ppoll(&watched, 1, line_ >= 0 ? &pause : nullptr, &unblocked());
  }

  /// Signals come only while it waits, so that none is missed.
  static const sigset_t& unblocked() {
    static const sigset_t kNone = [] {
      sigset_t none;
      sigemptyset(&none);
      return none;
    }();
    return kNone;
  }

  /// False if nothing has come.
  bool take_word() {
    GuardMessage told;
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
    iovec part{&told, sizeof told};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t got = ::recvmsg(socket_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (got < 0) return errno == EINTR;
    if (got == 0) {
      orphan_ = true;
      write_zero();
      return false;
    }
    if (got != sizeof told) return true;
    if (told.word == GuardWord::end) end();
    write_zero();  // the last word on a line is a zero, whatever the loop has sent
    drop_line();
    const cmsghdr* header = CMSG_FIRSTHDR(&message);
    if (header == nullptr || header->cmsg_type != SCM_RIGHTS) return true;
    std::memcpy(&line_, CMSG_DATA(header), sizeof line_);
    told_ = told;
    page_.holds_line = 1;
    changed_ns_ = now_ns();
    return true;
  }

  void look() {
    const std::int64_t now = now_ns();
    if (orphan_) return keep_at_zero(now);
    if (const std::uint64_t beats = page_.beats.load(); beats != beats_) {
      beats_ = beats;
      changed_ns_ = now;
    }
    if (tripped_) {
      if (page_.is_tripped()) return write_zero();
      tripped_ = false;
      changed_ns_ = now;
    }
    if (now - changed_ns_ > kMaxSilenceNs) trip(now);
  }

  void trip(std::int64_t now) {
    LineToken free = LineToken::idle;
    if (!page_.token.compare_exchange_strong(free, LineToken::tripped)) {
      // It was stopped while it wrote, and its frame could come at any time after a zero. It can't come from a process that has ended.
      if (::getppid() == parent_) ::kill(parent_, SIGKILL);
      page_.token = LineToken::tripped;
    }
    tripped_ = true;
    page_.silence_ns = now - changed_ns_;
    page_.trips.fetch_add(1);
    write_zero();
  }

  void keep_at_zero(std::int64_t now) {
    if (orphan_since_ns_ == 0) orphan_since_ns_ = now;
    if (told_.word == GuardWord::stream && now - orphan_since_ns_ > 10 * kKeepNs) return end_stream();
    if (now - orphan_since_ns_ > 10 * kKeepNs && now - wrote_ns_ < kKeepNs) return;
    write_zero();
  }

  void write_zero() {
    if (line_ < 0) return;
    wrote_ns_ = now_ns();
    if (told_.word == GuardWord::usb) return write_usb_zero();
    if (told_.word == GuardWord::stream) return write_stream_zero();
    ForceFrame zero;
    zero.number = ++number_;
    zero.valid_ms = 1000;
    zero.sender = Sender::guard;
    const FrameBytes bytes = drivers::haptic_pen::framed::encode(zero);
    const ssize_t put = ::write(line_, bytes.data(), bytes.size());
    if (put == static_cast<ssize_t>(bytes.size())) page_.zeros.fetch_add(1);
    if (put < 0 && errno != EAGAIN && errno != EINTR) drop_line();
  }

  void write_usb_zero() {
    usbdevfs_bulktransfer bulk{};
    bulk.ep = told_.endpoint;
    bulk.len = told_.zero_bytes;
    bulk.timeout = kUsbPatienceMs;
    bulk.data = told_.zero.data();
    const int put = ::ioctl(line_, USBDEVFS_BULK, &bulk);
    if (put == static_cast<int>(bulk.len)) page_.zeros.fetch_add(1);
    if (put < 0 && errno != ETIMEDOUT && errno != EINTR) drop_line();
  }

  void write_stream_zero() {
    const ssize_t put = ::send(line_, told_.zero.data(), told_.zero_bytes, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (put == told_.zero_bytes) page_.zeros.fetch_add(1);
    // After a part of it nothing more would be understood.
    else if (put >= 0 || (errno != EAGAIN && errno != EINTR))
      end_stream();
  }

  /// The service sees that its client has gone. Nobody reads its answers any more, and the next process connects anew.
  void end_stream() {
    ::shutdown(line_, SHUT_RDWR);
    drop_line();
  }

  void drop_line() {
    if (line_ >= 0) ::close(line_);
    line_ = -1;
    page_.holds_line = 0;
    tripped_ = false;
  }

  [[noreturn]] void end() {
    for (int i = 0; i < kLastZeros; ++i) write_zero();
    ::_exit(0);
  }

  GuardPage& page_;
  int socket_, parent_, line_ = -1;
  bool orphan_ = false, tripped_ = false;
  std::uint64_t beats_ = 0;
  std::int64_t changed_ns_ = 0, orphan_since_ns_ = 0, wrote_ns_ = 0;
  std::uint8_t number_ = 0;
  GuardMessage told_;  ///< how the line was given
};

}  // namespace

void run_guard(GuardPage& page, int socket, int lock, int parent) {
  ::prctl(PR_SET_NAME, "pen guard");
  ::prctl(PR_SET_DUMPABLE, 0);
  ::prctl(PR_SET_PDEATHSIG, 0);
  struct sigaction ends {};
  ends.sa_handler = note_end;
  ::sigaction(SIGTERM, &ends, nullptr);
  // A closing terminal and Ctrl-C reach both processes: the other one ends in order, and then says so.
  ::signal(SIGINT, SIG_IGN);
  ::signal(SIGHUP, SIG_IGN);
  ::signal(SIGPIPE, SIG_IGN);
  sigset_t term;
  sigemptyset(&term);
  sigaddset(&term, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &term, nullptr);
  close_others(socket, lock);
  struct flock whole {};
  whole.l_type = F_WRLCK;
  ::fcntl(lock, F_SETLK, &whole);
  ::mlockall(MCL_CURRENT);
  sched_param priority{};
  priority.sched_priority = kGuardPriority;
  ::sched_setscheduler(0, SCHED_FIFO, &priority);
  Guard(page, socket, parent).run();
}

}  // namespace prismesh::deviced::pen
