#include "ipc/client.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

#include <poll.h>
#include <unistd.h>

#include "ipc/line_socket.h"
#include "ipc/messages_json.h"

namespace prismesh::ipc {

namespace {

using Time = std::chrono::steady_clock;

constexpr std::chrono::seconds kGreetingPatience{10};

/// Leases of views that have died, perhaps on another thread, to be given back with the next message.
struct Returns {
  std::mutex mutex;
  std::vector<std::uint64_t> leases;
};

/// poll(2) until the socket is ready or the time has come; false: the time has come.
Result<bool> wait_for(int socket, short what, Time::time_point until) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Time::now()).count();
    pollfd ready{socket, what, 0};
    const int status = ::poll(&ready, 1, static_cast<int>(std::clamp<long long>(left, 0, 1'000'000)));
    if (status > 0) return true;
    if (status == 0 && Time::now() >= until) return false;
    if (status < 0 && errno != EINTR) return fail("", std::string("poll: ") + std::strerror(errno));
  }
}

}  // namespace

std::filesystem::path runtime_directory(const std::optional<std::filesystem::path>& override) {
  if (override) return *override;
  if (const char* folder = std::getenv("RUNTIME_DIRECTORY"); folder != nullptr && *folder != 0) {
    // systemd separates several by colons; the first is ours.
    const std::string all = folder;
    return all.substr(0, all.find(':'));
  }
  if (const char* folder = std::getenv("XDG_RUNTIME_DIR"); folder != nullptr && *folder != 0)
    return std::filesystem::path(folder) / "prismesh";
  return "/tmp/prismesh-" + std::to_string(::geteuid());
}

std::filesystem::path model_socket_path(const std::optional<std::filesystem::path>& override) {
  return runtime_directory(override) / "model.sock";
}

struct Client::State {
  State(Descriptor descriptor, std::filesystem::path where)
      : path(std::move(where)), socket(std::move(descriptor), {std::size_t{64} << 20, 253}) {}

  std::filesystem::path path;
  LineSocket socket;
  std::uint64_t next_number = 1;
  ipc::Welcome welcome;
  std::optional<StatePageReader> page;
  std::deque<Event> events;
  std::deque<Reply> replies;
  std::map<std::uint64_t, std::vector<Descriptor>> riders;  ///< by the number of the request they answer
  std::map<std::uint64_t, std::uint64_t> drag_requests;     ///< drag -> request, of drags whose preview wasn't taken
  std::map<std::uint64_t, std::uint64_t> lease_requests;    ///< lease -> request, of snapshots that weren't taken
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> segments;
  std::shared_ptr<Returns> returns = std::make_shared<Returns>();

  tl::unexpected<Error> lost(const Error& why) const { return fail(path.string(), "the document's daemon is gone (" + why.message + ")"); }

  Result<std::uint64_t> queue(const Request& request) {
    Result<std::string> line = encode_request(next_number, request);
    if (!line) return fail(std::move(line.error()));
    socket.queue(std::move(*line));
    return next_number++;
  }

  Result<void> flush() {
    std::vector<std::uint64_t> leases;
    {
      const std::lock_guard lock(returns->mutex);
      leases.swap(returns->leases);
    }
    for (const std::uint64_t lease : leases)
      if (Result<std::uint64_t> queued = queue(ReturnSnapshot{lease}); !queued) return fail(std::move(queued.error()));
    if (Result<bool> flushed = socket.flush(); !flushed) return lost(flushed.error());
    return {};
  }

  Result<void> sort_in(std::string_view line) {
    Result<FromDaemon> message = decode_from_daemon(line);
    if (!message) return fail(path.string(), message.error().text());
    Result<std::vector<Descriptor>> descriptors = socket.take_descriptors(message->descriptors);
    if (!descriptors) return lost(descriptors.error());
    if (auto* event = std::get_if<Event>(&message->message)) {
      events.push_back(std::move(*event));
      return {};
    }
    auto& answer = std::get<Answer>(message->message);
    if (!descriptors->empty()) riders[message->to] = std::move(*descriptors);
    if (const auto* begun = std::get_if<DragBegun>(&answer)) drag_requests[begun->drag] = message->to;
    if (const auto* snapshot = std::get_if<Snapshot>(&answer)) lease_requests[snapshot->lease] = message->to;
    replies.push_back({message->to, std::move(answer)});
    return {};
  }

  Result<void> receive() {
    const Result<bool> received = socket.receive();
    if (!received) return lost(received.error());
    while (const std::optional<std::string_view> line = socket.next_line())
      if (Result<void> sorted = sort_in(*line); !sorted) return sorted;
    return {};
  }

  /// One round of sending and receiving, waiting for something to do until `until`.
  Result<bool> turn(Time::time_point until) {
    if (Result<void> flushed = flush(); !flushed) return fail(std::move(flushed.error()));
    const auto what = static_cast<short>(socket.queued_bytes() > 0 ? POLLIN | POLLOUT : POLLIN);
    const Result<bool> ready = wait_for(socket.descriptor(), what, until);
    if (!ready) return fail(ready.error());
    if (!*ready) return false;
    if (Result<void> received = receive(); !received) return fail(std::move(received.error()));
    return true;
  }

  std::optional<Answer> take_reply(std::uint64_t number) {
    const auto found = std::find_if(replies.begin(), replies.end(), [&](const Reply& reply) { return reply.request == number; });
    if (found == replies.end()) return std::nullopt;
    Answer answer = std::move(found->answer);
    replies.erase(found);
    return answer;
  }

  Result<std::vector<Descriptor>> take_riders(std::map<std::uint64_t, std::uint64_t>& requests, std::uint64_t key, const char* what) {
    const auto request = requests.find(key);
    if (request == requests.end() || !riders.contains(request->second))
      return fail(path.string(), std::string("no ") + what + " came, or it was taken before");
    std::vector<Descriptor> taken = std::move(riders[request->second]);
    riders.erase(request->second);
    requests.erase(request);
    return taken;
  }
};

Client::Client(std::unique_ptr<State> state) : state_(std::move(state)) {}
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;
Client::~Client() = default;

Result<Client> Client::connect(const std::filesystem::path& socket, const std::string& program) {
  Result<Descriptor> connected = connect_to(socket);
  if (!connected) return fail(std::move(connected.error()));
  Client client(std::make_unique<State>(std::move(*connected), socket));
  Result<Answer> answer = client.call(Hello{kProtocolVersion, program}, kGreetingPatience);
  if (!answer) return fail(std::move(answer.error()));
  const auto* welcome = std::get_if<Welcome>(&*answer);
  if (welcome == nullptr) return fail(socket.string(), "what listens there isn't the document's daemon");
  State& state = *client.state_;
  state.welcome = *welcome;
  if (state.riders.empty() || state.riders.begin()->second.empty())
    return fail(socket.string(), "the daemon's welcome lacks the state page");
  Result<StatePageReader> page = StatePageReader::map(state.riders.begin()->second.front());
  if (!page) return fail(std::move(page.error()));
  state.page = std::move(*page);
  state.riders.clear();
  return client;
}

Result<std::uint64_t> Client::send(const Request& request) {
  Result<std::uint64_t> number = state_->queue(request);
  if (!number) return number;
  if (Result<void> flushed = state_->flush(); !flushed) return fail(std::move(flushed.error()));
  return number;
}

Result<Answer> Client::call(const Request& request, std::chrono::milliseconds patience) {
  const Result<std::uint64_t> number = send(request);
  if (!number) return fail(number.error());
  const Time::time_point until = Time::now() + patience;
  for (;;) {
    if (std::optional<Answer> answer = state_->take_reply(*number)) {
      if (auto* failed = std::get_if<Failed>(&*answer)) return fail(std::move(failed->file), failed->line, std::move(failed->message));
      return std::move(*answer);
    }
    const Result<bool> turned = state_->turn(until);
    if (!turned) return fail(turned.error());
    if (!*turned)
      return fail(state_->path.string(), "the document's daemon didn't answer in " + std::to_string(patience.count() / 1000) + " s");
  }
}

Result<void> Client::poll(std::chrono::milliseconds patience) {
  const Result<bool> turned = state_->turn(Time::now() + patience);
  if (!turned) return fail(turned.error());
  return {};
}

std::optional<Event> Client::next_event() {
  if (state_->events.empty()) return std::nullopt;
  Event event = std::move(state_->events.front());
  state_->events.pop_front();
  return event;
}

std::optional<Client::Reply> Client::next_reply() {
  if (state_->replies.empty()) return std::nullopt;
  Reply reply = std::move(state_->replies.front());
  state_->replies.pop_front();
  return reply;
}

Result<std::shared_ptr<const SnapshotView>> Client::snapshot() {
  GetSnapshot request;
  for (const auto& [id, mapping] : state_->segments) request.have_segments.push_back(id);
  const Result<Answer> answer = call(request);
  if (!answer) return fail(answer.error());
  const auto* snapshot = std::get_if<Snapshot>(&*answer);
  if (snapshot == nullptr) return fail(state_->path.string(), "the daemon answered something else than a snapshot");
  return take_snapshot(*snapshot);
}

std::vector<std::uint64_t> Client::segments() const {
  std::vector<std::uint64_t> ids;
  for (const auto& [id, mapping] : state_->segments) ids.push_back(id);
  return ids;
}

Result<std::shared_ptr<const SnapshotView>> Client::take_snapshot(const Snapshot& answer) {
  Result<std::vector<Descriptor>> descriptors = state_->take_riders(state_->lease_requests, answer.lease, "snapshot");
  if (!descriptors) return fail(std::move(descriptors.error()));
  // Whatever happens from here, the lease goes back.
  std::shared_ptr<void> lease(nullptr, [returns = std::weak_ptr(state_->returns), number = answer.lease](void*) {
    const std::shared_ptr<Returns> alive = returns.lock();
    if (!alive) return;
    const std::lock_guard lock(alive->mutex);
    alive->leases.push_back(number);
  });
  if (descriptors->size() != answer.new_segments.size() + 1)
    return fail(state_->path.string(), "a snapshot came with the wrong number of segments");
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> known = state_->segments;
  for (std::size_t i = 0; i < answer.new_segments.size(); ++i) {
    Result<Mapping> mapping = Mapping::map((*descriptors)[i + 1], false);
    if (!mapping) return fail(std::move(mapping.error()));
    known[answer.new_segments[i]] = std::make_shared<const Mapping>(std::move(*mapping));
  }
  std::vector<std::shared_ptr<const Mapping>> segments;
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> used;
  for (const std::uint64_t id : answer.segments) {
    const auto found = known.find(id);
    if (found == known.end()) return fail(state_->path.string(), "a snapshot lacks a segment");
    segments.push_back(found->second);
    used.insert(*found);
  }
  Result<std::shared_ptr<const SnapshotView>> view = SnapshotView::map(descriptors->front(), segments);
  if (!view) return fail(std::move(view.error()));
  state_->segments = std::move(used);
  // The caller's pointer keeps both the view and the lease.
  auto both = std::make_shared<std::pair<std::shared_ptr<void>, std::shared_ptr<const SnapshotView>>>(std::move(lease), std::move(*view));
  return std::shared_ptr<const SnapshotView>(both, both->second.get());
}

Result<PreviewReader> Client::take_preview(const DragBegun& begun) {
  const Result<std::vector<Descriptor>> descriptors = state_->take_riders(state_->drag_requests, begun.drag, "preview");
  if (!descriptors) return fail(descriptors.error());
  return PreviewReader::map(descriptors->front());
}

const Welcome& Client::welcome() const { return state_->welcome; }
std::optional<Health> Client::health() const { return state_->page->health(); }
int Client::descriptor() const { return state_->socket.descriptor(); }

}  // namespace prismesh::ipc
