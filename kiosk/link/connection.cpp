#include "kiosk/link/connection.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "ipc/wire/failure.h"
#include "kiosk/link/notice_words.h"

namespace prismesh::kiosk::link {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kFirstBackOff = 100 * kMillisecond;
constexpr std::int64_t kMaxBackOff = 2000 * kMillisecond;

/// Whether the server tells how far it is with it, and can be asked to stop.
bool can_be_stopped(const ipc::Request& request) {
  return std::holds_alternative<ipc::Open>(request) || std::holds_alternative<ipc::Save>(request) ||
         std::holds_alternative<ipc::ApplyEdit>(request) || std::holds_alternative<ipc::GetField>(request) ||
         std::holds_alternative<ipc::GetContacts>(request);
}

}  // namespace

Connection::Connection(std::filesystem::path socket, Clock& clock, notices::Trace trace, LinkNotices& notices)
    : socket_(std::move(socket)), clock_(clock), trace_(trace), notices_(notices) {}

void Connection::turn() {
  if (!client_) try_connect();
  if (client_) read();
}

int Connection::patience_ms() const {
  if (client_) return -1;
  return static_cast<int>(std::max<std::int64_t>(0, (next_attempt_ns_ - clock_.now_ns() + kMillisecond - 1) / kMillisecond));
}

void Connection::try_connect() {
  const std::int64_t now = clock_.now_ns();
  if (now < next_attempt_ns_) return;
  Result<ipc::Client> client = ipc::Client::connect(socket_, "prismesh-kiosk");
  if (!client) {
    back_off_ns_ = std::clamp(back_off_ns_ * 2, kFirstBackOff, kMaxBackOff);
    next_attempt_ns_ = now + back_off_ns_;
    return;
  }
  client_ = std::move(*client);
  back_off_ns_ = 0;
  ++changes_;
  ++number_;
  trace_.line("connected");
  for (ConnectionListener* listener : listeners_) listener->connected();
}

void Connection::lost(const Error& error) {
  client_.reset();
  waiting_.clear();
  progress_.lost();
  for (ConnectionListener* listener : listeners_) listener->lost();
  next_attempt_ns_ = clock_.now_ns();
  ++changes_;
  trace_.line("disconnected " + error.text());
}

void Connection::ask(const ipc::Request& request, Then then) {
  if (!client_) return notices_.say(notice_of_missing_server());
  if (guard_ && !guard_(request)) {
    if (then) then(ipc::failed_from({"", 0, "this would read or write files, which are closed here"}));
    return;
  }
  const Result<std::uint64_t> sent = client_->send(request);
  if (!sent) return lost(sent.error());
  const bool can_stop = can_be_stopped(request);
  if (can_stop) progress_.asked();
  waiting_.emplace(*sent, Waiting{std::move(then), can_stop});
}

void Connection::question(const ipc::Request& request, Then then) {
  if (client_) ask(request, std::move(then));
}

void Connection::follow_pen(const ipc::FollowPen& request, const ipc::Descriptor& pen, Then then) {
  if (!client_) return;
  const Result<std::uint64_t> sent = client_->send_follow_pen(request, pen);
  if (!sent) return lost(sent.error());
  waiting_.emplace(*sent, Waiting{std::move(then), false});
}

void Connection::tell(const ipc::Request& request) {
  if (!client_ || (guard_ && !guard_(request))) return;
  if (const Result<std::uint64_t> sent = client_->send(request); !sent) lost(sent.error());
}

void Connection::stop(bool keep) {
  if (client_ && progress_.works_for_us()) ask(ipc::Cancel{keep}, [](const ipc::Answer&) {});  // it may be over already
}

void Connection::read() {
  if (Result<void> polled = client_->poll(); !polled) return lost(polled.error());
  while (client_) {
    if (const std::optional<ipc::Event> event = client_->next_event()) {
      ++changes_;
      progress_.heard(*event);
      for (ConnectionListener* listener : listeners_) listener->heard(*event);
      continue;
    }
    const std::optional<ipc::Client::Reply> reply = client_->next_reply();
    if (!reply) break;
    auto node = waiting_.extract(reply->request);
    if (node.empty()) continue;
    ++changes_;
    const Waiting& waited = node.mapped();
    if (waited.can_stop) progress_.answered();
    if (waited.then) waited.then(reply->answer);
  }
}

}  // namespace prismesh::kiosk::link
