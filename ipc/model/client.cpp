#include "ipc/model/client.h"

#include <map>
#include <mutex>
#include <utility>

#include "ipc/model/messages_json.h"
#include "ipc/wire/connection.h"

namespace prismesh::ipc {

namespace {

/// Leases of destroyed views, perhaps of another thread, to return with the next message.
struct Returns {
  std::mutex mutex;
  std::vector<std::uint64_t> leases;
};

struct ModelProtocol {
  static constexpr const char* kDaemon = "the document's daemon";
  using Request = ipc::Request;
  using Answer = ipc::Answer;
  using Event = ipc::Event;
  using Reply = Client::Reply;
  static Result<std::string> encode(std::uint64_t number, const Request& request) { return encode_request(number, request); }
  static Result<FromDaemon> decode(std::string_view line) { return decode_from_daemon(line); }
};

}  // namespace

std::filesystem::path model_socket_path(const std::optional<std::filesystem::path>& override) {
  return runtime_directory(override) / "model.sock";
}

struct Client::Impl final : Connection<ModelProtocol> {
  using Connection::Connection;

  std::uint64_t hello = 0;
  ipc::Welcome welcome;
  std::optional<StatePageReader> page;
  std::map<std::uint64_t, std::uint64_t> drag_requests;   ///< drag -> request, of drags whose preview wasn't taken
  std::map<std::uint64_t, std::uint64_t> lease_requests;  ///< lease -> request, of snapshots that weren't taken
  std::map<std::uint64_t, std::uint64_t> field_requests;  ///< field -> request, of fields that weren't taken
  std::optional<std::uint64_t> pen_request;               ///< whose page with fields wasn't taken
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> segments;
  /// Segments of the previous snapshot, kept because a second request under way may rely on them.
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> earlier_segments;
  std::shared_ptr<Returns> returns = std::make_shared<Returns>();

  std::vector<Request> due() override {
    std::vector<std::uint64_t> leases;
    {
      const std::lock_guard lock(returns->mutex);
      leases.swap(returns->leases);
    }
    std::vector<Request> requests;
    for (const std::uint64_t lease : leases) requests.emplace_back(ReturnSnapshot{lease});
    return requests;
  }

  void arrived(std::uint64_t to, const Answer& answer) override {
    if (const auto* begun = std::get_if<DragBegun>(&answer)) drag_requests[begun->drag] = to;
    if (const auto* made = std::get_if<FieldMade>(&answer)) field_requests[made->field] = to;
    if (const auto* snapshot = std::get_if<Snapshot>(&answer)) lease_requests[snapshot->lease] = to;
    if (!std::holds_alternative<PenFollowed>(answer)) return;
    if (pen_request) take_descriptors_of(*pen_request);  // nobody wants the older page any more
    pen_request = to;
  }

  Result<std::vector<Descriptor>> take_descriptors_for(std::map<std::uint64_t, std::uint64_t>& requests, std::uint64_t key,
                                                       const char* what) {
    const auto request = requests.extract(key);
    std::vector<Descriptor> taken = request ? take_descriptors_of(request.mapped()) : std::vector<Descriptor>();
    if (taken.empty()) return fail(path().string(), std::string("no ") + what + " came, or it was taken before");
    return taken;
  }
};

Client::Client(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;
Client::~Client() = default;

Result<Client> Client::begin(const std::filesystem::path& socket, const std::string& program) {
  Result<Descriptor> connected = connect_to(socket, "start the document's daemon with `./station run` or `prismesh-modeld`");
  if (!connected) return fail(std::move(connected.error()));
  Client client(std::make_unique<Impl>(std::move(*connected), socket));
  const Result<std::uint64_t> hello = client.send(Hello{kProtocolVersion, program});
  if (!hello) return fail(hello.error());
  client.impl_->hello = *hello;
  return client;
}

Result<bool> Client::greeted(std::chrono::milliseconds patience) {
  if (impl_->page) return true;
  return impl_->take_welcome(impl_->hello, patience, impl_->welcome, impl_->page);
}

Result<Client> Client::connect(const std::filesystem::path& socket, const std::string& program) {
  return welcomed(begin(socket, program), socket);
}

Result<std::uint64_t> Client::send(const Request& request) { return impl_->send(request); }

Result<Answer> Client::call(const Request& request, std::chrono::milliseconds patience) { return impl_->call(request, patience); }

Result<void> Client::poll(std::chrono::milliseconds patience) {
  const Result<bool> turned = impl_->turn(std::chrono::steady_clock::now() + patience);
  if (!turned) return fail(turned.error());
  return {};
}

std::optional<Event> Client::next_event() { return impl_->next_event(); }
std::optional<Client::Reply> Client::next_reply() { return impl_->next_reply(); }

Result<std::shared_ptr<const SnapshotView>> Client::snapshot() {
  GetSnapshot request;
  for (const auto& [id, mapping] : impl_->segments) request.have_segments.push_back(id);
  const Result<Answer> answer = call(request);
  if (!answer) return fail(answer.error());
  const auto* snapshot = std::get_if<Snapshot>(&*answer);
  if (snapshot == nullptr) return fail(impl_->path().string(), "the daemon answered something else than a snapshot");
  return take_snapshot(*snapshot);
}

std::vector<std::uint64_t> Client::segments() const {
  std::vector<std::uint64_t> ids;
  for (const auto& [id, mapping] : impl_->segments) ids.push_back(id);
  return ids;
}

Result<std::shared_ptr<const SnapshotView>> Client::take_snapshot(const Snapshot& answer) {
  Result<std::vector<Descriptor>> descriptors = impl_->take_descriptors_for(impl_->lease_requests, answer.lease, "snapshot");
  if (!descriptors) return fail(std::move(descriptors.error()));
  // From here on the lease is returned whatever happens.
  std::shared_ptr<void> lease(nullptr, [returns = std::weak_ptr(impl_->returns), number = answer.lease](void*) {
    const std::shared_ptr<Returns> alive = returns.lock();
    if (!alive) return;
    const std::lock_guard lock(alive->mutex);
    alive->leases.push_back(number);
  });
  if (descriptors->size() != answer.new_segments.size() + 1)
    return fail(impl_->path().string(), "a snapshot came with the wrong number of segments");
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> known = impl_->segments;
  known.insert(impl_->earlier_segments.begin(), impl_->earlier_segments.end());
  for (std::size_t i = 0; i < answer.new_segments.size(); ++i) {
    Result<Mapping> mapping = Mapping::map((*descriptors)[i + 1], false);
    if (!mapping) return fail(std::move(mapping.error()));
    known[answer.new_segments[i]] = std::make_shared<const Mapping>(std::move(*mapping));
  }
  std::vector<std::shared_ptr<const Mapping>> segments;
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> used;
  for (const std::uint64_t id : answer.segments) {
    const auto found = known.find(id);
    if (found == known.end()) return fail(impl_->path().string(), "a segment of the snapshot is missing");
    segments.push_back(found->second);
    used.insert(*found);
  }
  Result<std::shared_ptr<const SnapshotView>> view = SnapshotView::map(descriptors->front(), segments);
  if (!view) return fail(std::move(view.error()));
  impl_->earlier_segments = std::exchange(impl_->segments, std::move(used));
  // The caller's pointer keeps both the view and the lease.
  auto both = std::make_shared<std::pair<std::shared_ptr<void>, std::shared_ptr<const SnapshotView>>>(std::move(lease), std::move(*view));
  return std::shared_ptr<const SnapshotView>(both, both->second.get());
}

Result<std::shared_ptr<const FieldValues>> Client::take_field(const FieldMade& made) {
  const Result<std::vector<Descriptor>> descriptors = impl_->take_descriptors_for(impl_->field_requests, made.field, "field");
  if (!descriptors) return fail(descriptors.error());
  Result<std::shared_ptr<const FieldValues>> values = FieldValues::map(descriptors->front());
  if (values && ((*values)->generation() != made.generation || (*values)->on_nodes() != made.on_nodes))
    return fail(impl_->path().string(), "a field's values are of something else than it says");
  return values;
}

Result<PreviewReader> Client::take_preview(const DragBegun& begun) {
  const Result<std::vector<Descriptor>> descriptors = impl_->take_descriptors_for(impl_->drag_requests, begun.drag, "preview");
  if (!descriptors) return fail(descriptors.error());
  return PreviewReader::map(descriptors->front());
}

Result<std::uint64_t> Client::send_follow_pen(const FollowPen& request, const Descriptor& pen) {
  Result<Descriptor> theirs = pen.duplicate();
  if (!theirs) return fail(std::move(theirs.error()));
  std::vector<Descriptor> descriptors;
  descriptors.push_back(std::move(*theirs));
  return impl_->send(request, std::move(descriptors));
}

Result<Descriptor> Client::take_pen_field() {
  const std::optional<std::uint64_t> request = std::exchange(impl_->pen_request, std::nullopt);
  std::vector<Descriptor> fields = request ? impl_->take_descriptors_of(*request) : std::vector<Descriptor>();
  if (fields.size() != 1) return fail(impl_->path().string(), "no page for the pen's field came, or it was taken before");
  return std::move(fields.front());
}

Result<Descriptor> Client::follow_pen(const FollowPen& request, const Descriptor& pen, std::chrono::milliseconds patience) {
  const Result<std::uint64_t> number = send_follow_pen(request, pen);
  if (!number) return fail(number.error());
  if (const Result<Answer> answer = impl_->wait(*number, patience); !answer) return fail(answer.error());
  return take_pen_field();
}

const Welcome& Client::welcome() const { return impl_->welcome; }
std::optional<Health> Client::health() const { return impl_->page->health(); }
int Client::descriptor() const { return impl_->descriptor(); }

}  // namespace prismesh::ipc
