// A client's connection to a daemon, for any set of messages: sends requests, receives answers and events. Never blocks longer than the
// caller allows. Only the sources of the daemons' clients include it.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <poll.h>

#include "ipc/wire/envelope.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/greeting_patience.h"
#include "ipc/wire/line_socket.h"

namespace prismesh::ipc {

/// Waits (poll(2)) until the socket is ready or the time has come; false if the time has come.
Result<bool> wait_for_socket(int socket, short what, std::chrono::steady_clock::time_point until);

/// Waits for the welcome of a client at most kGreetingPatience; `client` is the result of its class's `begin`.
template <class AnyClient>
Result<AnyClient> welcomed(Result<AnyClient> client, const std::filesystem::path& socket) {
  if (!client) return client;
  const Result<bool> greeted = client->greeted(kGreetingPatience);
  if (!greeted) return fail(greeted.error());
  if (!*greeted)
    return fail(socket.string(), "the daemon didn't answer the greeting in " + std::to_string(kGreetingPatience.count()) + " s");
  return client;
}

/// `Protocol` names the daemon (`kDaemon`), its types (Request, Answer, Event, Reply) and their lines (`encode`, `decode`).
template <class Protocol>
class Connection {
 public:
  using Request = typename Protocol::Request;
  using Answer = typename Protocol::Answer;
  using Event = typename Protocol::Event;
  using Reply = typename Protocol::Reply;
  using Time = std::chrono::steady_clock;

  Connection(Descriptor descriptor, std::filesystem::path where)
      : path_(std::move(where)), socket_(std::move(descriptor), {std::size_t{64} << 20, 253}) {}
  virtual ~Connection() = default;

  /// Sends without waiting; returns the request's number.
  Result<std::uint64_t> send(const Request& request, std::vector<Descriptor> descriptors = {}) {
    Result<std::uint64_t> number = queue(request, std::move(descriptors));
    if (!number) return number;
    if (Result<void> flushed = flush(); !flushed) return fail(std::move(flushed.error()));
    return number;
  }

  /// Waits for the answer to a request that was sent. A Failed answer is an Error.
  Result<Answer> wait(std::uint64_t number, std::chrono::milliseconds patience) {
    const Time::time_point until = Time::now() + patience;
    for (;;) {
      if (std::optional<Answer> answer = take_reply(number)) {
        if (const auto* failed = std::get_if<Failed>(&*answer)) return fail(error_from(*failed));
        return std::move(*answer);
      }
      const Result<bool> turned = turn(until);
      if (!turned) return fail(turned.error());
      if (!*turned)
        return fail(path_.string(), std::string(Protocol::kDaemon) + " didn't answer in " + std::to_string(patience.count() / 1000) + " s");
    }
  }

  Result<Answer> call(const Request& request, std::chrono::milliseconds patience) {
    const Result<std::uint64_t> number = send(request);
    if (!number) return fail(number.error());
    return wait(*number, patience);
  }

  /// Sends and receives once, waiting until `until` for something to do; false if the time has come.
  Result<bool> turn(Time::time_point until) {
    if (Result<void> flushed = flush(); !flushed) return fail(std::move(flushed.error()));
    const auto what = static_cast<short>(socket_.queued_bytes() > 0 ? POLLIN | POLLOUT : POLLIN);
    const Result<bool> ready = wait_for_socket(socket_.descriptor(), what, until);
    if (!ready) return fail(ready.error());
    if (!*ready) return false;
    if (Result<void> received = receive(); !received) return fail(std::move(received.error()));
    return true;
  }

  /// Takes the answer to a hello and its state page; false if none arrived within `patience`.
  template <class Welcome, class Page>
  Result<bool> take_welcome(std::uint64_t hello, std::chrono::milliseconds patience, Welcome& welcome, std::optional<Page>& page) {
    const Time::time_point until = Time::now() + patience;
    while (!answered(hello)) {
      const Result<bool> turned = turn(until);
      if (!turned) return fail(turned.error());
      if (!*turned) return false;
    }
    const Result<Answer> answer = wait(hello, std::chrono::milliseconds(0));
    if (!answer) return fail(answer.error());
    const auto* welcomed = std::get_if<Welcome>(&*answer);
    if (welcomed == nullptr) return fail(path_.string(), std::string("what listens there isn't ") + Protocol::kDaemon);
    const std::vector<Descriptor> descriptors = take_descriptors_of(hello);
    if (descriptors.empty()) return fail(path_.string(), "the state page is missing in the daemon's welcome");
    Result<Page> mapped = Page::map(descriptors.front());
    if (!mapped) return fail(std::move(mapped.error()));
    welcome = *welcomed;
    page = std::move(*mapped);
    return true;
  }

  std::optional<Event> next_event() {
    if (events_.empty()) return std::nullopt;
    Event event = std::move(events_.front());
    events_.pop_front();
    return event;
  }
  std::optional<Reply> next_reply() {
    if (replies_.empty()) return std::nullopt;
    Reply reply = std::move(replies_.front());
    replies_.pop_front();
    return reply;
  }
  bool answered(std::uint64_t number) const { return find_reply(number) != replies_.end(); }
  /// The descriptors that came with the answer to a request; empty if there were none or they were taken.
  std::vector<Descriptor> take_descriptors_of(std::uint64_t number) {
    auto node = descriptors_.extract(number);
    return node ? std::move(node.mapped()) : std::vector<Descriptor>();
  }

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return socket_.descriptor(); }

 protected:
  /// Requests to send with the next message.
  virtual std::vector<Request> due() { return {}; }
  /// Called for each answer before it is put among the replies.
  virtual void arrived(std::uint64_t, const Answer&) {}

 private:
  tl::unexpected<Error> lost(const Error& why) const {
    return fail(path_.string(), std::string(Protocol::kDaemon) + " is gone (" + why.message + ")");
  }

  Result<std::uint64_t> queue(const Request& request, std::vector<Descriptor> descriptors = {}) {
    Result<std::string> line = Protocol::encode(next_number_, request);
    if (!line) return fail(std::move(line.error()));
    socket_.queue(std::move(*line), std::move(descriptors));
    return next_number_++;
  }

  Result<void> flush() {
    for (const Request& request : due())
      if (Result<std::uint64_t> queued = queue(request); !queued) return fail(std::move(queued.error()));
    if (Result<bool> flushed = socket_.flush(); !flushed) return lost(flushed.error());
    return {};
  }

  Result<void> receive() {
    const Result<bool> received = socket_.receive();
    if (!received) return lost(received.error());
    while (const std::optional<std::string_view> line = socket_.next_line())
      if (Result<void> sorted = sort_in(*line); !sorted) return sorted;
    return {};
  }

  Result<void> sort_in(std::string_view line) {
    Result<Said<Answer, Event>> message = Protocol::decode(line);
    if (!message) return fail(path_.string(), message.error().text());
    Result<std::vector<Descriptor>> descriptors = socket_.take_descriptors(message->descriptors);
    if (!descriptors) return lost(descriptors.error());
    if (auto* event = std::get_if<Event>(&message->message)) {
      events_.push_back(std::move(*event));
      return {};
    }
    auto& answer = std::get<Answer>(message->message);
    if (!descriptors->empty()) descriptors_[message->to] = std::move(*descriptors);
    arrived(message->to, answer);
    replies_.push_back({message->to, std::move(answer)});
    return {};
  }

  auto find_reply(std::uint64_t number) const {
    return std::find_if(replies_.begin(), replies_.end(), [&](const Reply& reply) { return reply.request == number; });
  }

  std::optional<Answer> take_reply(std::uint64_t number) {
    const auto found = find_reply(number);
    if (found == replies_.end()) return std::nullopt;
    const auto place = replies_.begin() + (found - replies_.cbegin());
    Answer answer = std::move(place->answer);
    replies_.erase(place);
    return answer;
  }

  std::filesystem::path path_;
  LineSocket socket_;
  std::uint64_t next_number_ = 1;
  std::deque<Event> events_;
  std::deque<Reply> replies_;
  std::map<std::uint64_t, std::vector<Descriptor>> descriptors_;  ///< by the number of the request they answer
};

}  // namespace prismesh::ipc
