#include "drivers/haptic_pen/inverse3/service_link.h"

#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "base/clock.h"
#include "base/ring.h"
#include "drivers/haptic_pen/inverse3/messages.h"

namespace prismesh::drivers::haptic_pen::inverse3 {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using LinkError = boost::system::error_code;

constexpr std::chrono::milliseconds kConnectTime{300};
/// The last zero may wait so long for room.
constexpr std::int64_t kDrainNs = 20'000'000;
constexpr std::chrono::milliseconds kRoomAgain{1};
/// The service has so long to read it and to hang up as well.
constexpr std::int64_t kHangUpNs = 200'000'000;
/// Messages of the guard's, and what else may still be answered.
constexpr std::size_t kMaxUnanswered = 64;

/// Forces are written in one call to the system each, under the gate: a guard may stop the process anywhere, and continues with a frame of
/// its own. So Beast only opens the connection and reads.
class WebsocketLink final : public ServiceLink {
 public:
  WebsocketLink(std::uint16_t port, port::UsbGate gate, int realtime_priority)
      : port_(port), gate_(std::move(gate)), realtime_priority_(realtime_priority), wake_(io_), timer_(io_), stream_(io_) {}

  ~WebsocketLink() override {
    if (thread_.joinable()) {
      asio::post(io_, [this] { finish(); });
      thread_.join();
    }
    if (descriptor_ >= 0) hang_up();
    LinkError ignored;
    stream_.next_layer().close(ignored);
  }

  Result<void> connect() {
    stream_.read_message_max(kMaxMessageBytes);
    stage_ = Stage::connecting;
    stream_.next_layer().async_connect({asio::ip::address_v4::loopback(), port_}, [this](const LinkError& error) {
      if (error) return stop_connecting(error);
      stage_ = Stage::greeting;
      stream_.next_layer().set_option(tcp::no_delay(true), connect_error_);
      stream_.async_handshake(fmt::format("localhost:{}", port_), "/", [this](const LinkError& refused) {
        if (refused) return stop_connecting(refused);
        stage_ = Stage::listing;
        stream_.async_read(buffer_, [this](const LinkError& lost, std::size_t) {
          if (lost) return stop_connecting(lost);
          stage_ = Stage::connected;
        });
      });
    });
    io_.run_for(kConnectTime);
    if (stage_ != Stage::connected) return fail("", connect_sentence());
    Result<ServiceState> state = read_message(received());
    if (!state) return fail("", fmt::format("what listens on port {} {}", port_, state.error().message));
    Result<std::string> device = choose_device(*state);
    if (!device) return fail(std::move(device.error()));
    device_id_ = std::move(*device);
    since_3_5_ = state->has_session;
    zero_frame_ = text_frame(force_message(device_id_, Eigen::Vector3d::Zero(), since_3_5_));
    buffer_.clear();
    descriptor_ = stream_.next_layer().native_handle();
    LinkError refused;
    stream_.next_layer().native_non_blocking(true, refused);
    const int wake = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (refused || wake < 0) return fail("", std::string("the Inverse3's connection can't be used: ") + std::strerror(errno));
    wake_.assign(wake);
    io_.restart();
    thread_ = std::thread([this] { run(); });
    return {};
  }

  bool put(const LinkForce& force) override {
    if (!forces_.push(force)) return false;
    const std::uint64_t one = 1;
    return ::write(wake_.native_handle(), &one, sizeof one) == sizeof one || errno == EAGAIN;
  }
  std::optional<LinkAnswer> take() override { return answers_.pop(); }
  std::uint64_t handled() const override { return handled_.load(); }
  LinkEnd end() const override { return end_.load(); }
  int descriptor() const override { return descriptor_; }
  const std::vector<std::byte>& zero_frame() const override { return zero_frame_; }

 private:
  using Stream = websocket::stream<tcp::socket>;
  enum class Stage : std::uint8_t { connecting, greeting, listing, connected };

  /// A connection that is closed while answers wait in it is reset, and the service may lose a zero that it hasn't read. So they are read.
  void hang_up() const {
    ::shutdown(descriptor_, SHUT_WR);
    const std::int64_t by_ns = clock_.now_ns() + kHangUpNs;
    std::array<char, 4096> unread{};
    for (ssize_t got = 1; got != 0 && clock_.now_ns() < by_ns;) {
      pollfd waits{descriptor_, POLLIN, 0};
      (void)::poll(&waits, 1, 1);
      got = ::recv(descriptor_, unread.data(), unread.size(), MSG_DONTWAIT);
      if (got < 0 && errno != EAGAIN && errno != EINTR) return;
    }
  }

  void stop_connecting(const LinkError& error) {
    connect_error_ = error;
    io_.stop();
  }

  std::string connect_sentence() const {
    if (stage_ == Stage::connecting && connect_error_ == asio::error::connection_refused)
      return fmt::format("nothing listens on port {}: start the Haply Inverse Service (systemctl start haply-inverse-service)", port_);
    if (stage_ == Stage::connecting && connect_error_)
      return fmt::format("port {} of this machine can't be reached ({}): may the pen's process use the network? docs/devices/haptic-pen.md",
                         port_, connect_error_.message());
    if (connect_error_) return fmt::format("what listens on port {} isn't a Haply Inverse Service: {}", port_, connect_error_.message());
    return fmt::format("what listens on port {} doesn't answer: restart the Haply Inverse Service", port_);
  }

  std::string_view received() const { return {static_cast<const char*>(buffer_.data().data()), buffer_.data().size()}; }

  void run() {
    ::pthread_setname_np(::pthread_self(), "inverse3 link");
    if (realtime_priority_ > 0) {
      sched_param priority{};
      priority.sched_priority = realtime_priority_;
      ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority);  // where it isn't granted, it does without
    }
    wait_for_force();
    receive();
    io_.run();
  }

  void wait_for_force() {
    wake_.async_read_some(asio::buffer(wakes_), [this](const LinkError& error, std::size_t) {
      if (error || end_ != LinkEnd::none) return;
      while (const auto force = forces_.pop()) {
        newest_ = *force;
        ++popped_;
      }
      send_newest();
      wait_for_force();
    });
  }

  void receive() {
    stream_.async_read(buffer_, [this](const LinkError& error, std::size_t) {
      if (error) return stop(LinkEnd::closed);
      take_answer();
      buffer_.clear();
      if (end_ != LinkEnd::none) return;
      // A force may have waited for this answer.
      send_newest();
      receive();
    });
  }

  void take_answer() {
    const std::int64_t now_ns = clock_.now_ns();
    const Result<ServiceState> state = read_message(received());
    if (!state) return stop(LinkEnd::bad_reply);
    const DeviceState* device = nullptr;
    for (const DeviceState& one : state->devices)
      if (one.id == device_id_) device = &one;
    if (device == nullptr || !device->powered || device->turned) return stop(LinkEnd::unplugged);
    if (asked_.empty()) return;
    LinkAnswer answer;
    answer.asked_ns = asked_.front();
    asked_.pop_front();
    answer.answered_ns = now_ns;
    answer.ready = device->ready;
    answer.has_position = device->position_m.has_value();
    if (device->position_m) Eigen::Map<Eigen::Vector3d>(answer.position_m.data()) = *device->position_m;
    // Of two grips nobody could say which is on the device.
    if (state->grips.size() == 1) {
      const GripState& grip = state->grips.front();
      answer.buttons = grip.buttons;
      answer.has_orientation = grip.orientation.has_value();
      if (grip.orientation)
        answer.orientation = {grip.orientation->w(), grip.orientation->x(), grip.orientation->y(), grip.orientation->z()};
    }
    answers_.push(answer);  // a loop that doesn't take them has ended
  }

  void send_newest() {
    if (!newest_ || end_ != LinkEnd::none) return;
    const std::int64_t now_ns = clock_.now_ns();
    Eigen::Vector3d newton = Eigen::Map<const Eigen::Vector3d>(newest_->newton.data());
    if (newest_->valid_until_ns < now_ns) newton.setZero();
    const bool zero = newton.isZero(0);
    const bool ends_force = zero && sent_force_;
    if (asked_.size() >= (ends_force ? kMaxUnanswered : kMaxAsked)) {
      // It waits for an answer, and isn't stuck: the bytes of the others are gone.
      handled_ = popped_;
      return;
    }
    if (!write(zero ? zero_frame_ : text_frame(force_message(device_id_, newton, since_3_5_)))) return;
    asked_.push_back(newest_->asked_ns);
    sent_force_ = !zero;
    handled_ = popped_;
    const std::int64_t ends_ns = newest_->valid_until_ns;
    newest_.reset();
    if (sent_force_) end_force_at(ends_ns, now_ns);
  }

  /// Sends zero when the force has become old and no other has followed.
  void end_force_at(std::int64_t ends_ns, std::int64_t now_ns) {
    timer_.expires_after(std::chrono::nanoseconds(std::max<std::int64_t>(ends_ns - now_ns, 0)));
    timer_.async_wait([this](const LinkError& error) {
      if (error || !sent_force_) return;
      // Also where a newer force waits for an answer: the one that was sent may not be held for longer.
      newest_ = LinkForce{{}, clock_.now_ns(), 0};
      send_newest();
    });
  }

  /// All of it, or nothing and false.
  bool write(const std::vector<std::byte>& frame) {
    if (!gate_.begin()) {
      stop(LinkEnd::guarded);
      return false;
    }
    const ssize_t put = ::send(descriptor_, frame.data(), frame.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    const int error = errno;
    gate_.end();
    if (put == static_cast<ssize_t>(frame.size())) return true;
    if (put < 0 && (error == EAGAIN || error == EINTR)) {
      timer_.expires_after(kRoomAgain);
      timer_.async_wait([this](const LinkError& cancelled) {
        if (!cancelled) send_newest();
      });
      return false;
    }
    // A part of a frame: no further one would be understood.
    stop(LinkEnd::closed);
    return false;
  }

  void stop(LinkEnd why) {
    LinkEnd none = LinkEnd::none;
    if (!end_.compare_exchange_strong(none, why)) return;
    // The service may still hold a force for a device that it has lost, or that answers in riddles.
    if (sent_force_ && why != LinkEnd::guarded && why != LinkEnd::closed && gate_.begin()) {
      (void)::send(descriptor_, zero_frame_.data(), zero_frame_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      gate_.end();
    }
    io_.stop();
  }

  /// The pen is put down: the last word is a zero.
  void finish() {
    const std::int64_t by_ns = clock_.now_ns() + kDrainNs;
    while (end_ == LinkEnd::none && sent_force_ && clock_.now_ns() < by_ns) {
      newest_ = LinkForce{{}, clock_.now_ns(), 0};
      send_newest();
      if (sent_force_) std::this_thread::sleep_for(kRoomAgain);
    }
    io_.stop();
  }

  std::uint16_t port_;
  port::UsbGate gate_;
  int realtime_priority_;
  mutable MonotonicClock clock_;
  asio::io_context io_{1};
  asio::posix::stream_descriptor wake_;
  asio::steady_timer timer_;
  Stream stream_;
  beast::flat_buffer buffer_;
  Stage stage_ = Stage::connecting;
  LinkError connect_error_;
  int descriptor_ = -1;
  std::string device_id_;
  bool since_3_5_ = false;
  std::vector<std::byte> zero_frame_;
  std::array<std::uint64_t, 1> wakes_{};
  // Between the threads.
  Ring<LinkForce, 64> forces_;
  Ring<LinkAnswer, 64> answers_;
  std::atomic<std::uint64_t> handled_ = 0;
  std::atomic<LinkEnd> end_ = LinkEnd::none;
  // Of the link's thread.
  std::optional<LinkForce> newest_;
  std::uint64_t popped_ = 0;
  std::deque<std::int64_t> asked_;  ///< times of the questions without an answer
  bool sent_force_ = false;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<ServiceLink>> ServiceLink::open(std::uint16_t port, port::UsbGate gate, int realtime_priority) {
  auto link = std::make_unique<WebsocketLink>(port, std::move(gate), realtime_priority);
  if (Result<void> connected = link->connect(); !connected) return fail(std::move(connected.error()));
  return link;
}

}  // namespace prismesh::drivers::haptic_pen::inverse3
