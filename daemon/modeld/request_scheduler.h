// Schedules the clients' requests: gives the worker one at a time and queues edits while a drag is under way. Used by the loop's thread
// only.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/modeld/request_handler.h"
#include "daemon/modeld/worker.h"
#include "ipc/model/messages.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/server.h"

namespace prismesh::modeld {

/// Sends messages to the clients, and posts work from the worker back to the loop.
class ClientChannel {
 public:
  virtual ~ClientChannel() = default;
  virtual void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& answer, std::vector<ipc::Descriptor> descriptors) = 0;
  virtual void tell(ipc::ClientId client, const ipc::Event& event) = 0;
  virtual void tell_all(const ipc::Event& event) = 0;
  /// The document that is open, or none, is another state of itself or another one.
  virtual void shown(const PublishedState&) {}
  /// Whether somebody wants to feel drags.
  virtual bool follows_pen() const { return false; }
  /// A step of a drag, if `follows_pen`; nothing: the drag is over.
  virtual void felt(const std::optional<DragFeel>&) {}
  /// Queues `work` for the loop's thread. May be called from any thread.
  virtual void post(std::function<void()> work) = 0;
};

class RequestScheduler {
 public:
  RequestScheduler(ClientChannel& channel, Worker& worker, RequestHandler& handler, ipc::SnapshotPublisher& publisher)
      : channel_(channel), worker_(worker), handler_(handler), publisher_(publisher) {}

  /// Reopens the deck that was open when the daemon ended.
  void start(std::function<void(const ipc::Answer&)> when_done);
  void arrived(ipc::ClientId client);
  /// Cancels the client's drag, returns its snapshots and drops its waiting requests.
  void left(ipc::ClientId client);
  /// `bytes`: memory of the request while it waits.
  void request(ipc::ClientId client, std::uint64_t number, ipc::Request request, std::size_t bytes);

  /// All fields but those of the process.
  ipc::Health health() const;

 private:
  struct Client {
    std::size_t waiting = 0;
    std::size_t waiting_bytes = 0;
    std::set<std::uint64_t> leases;
  };
  struct Waiting {
    ipc::ClientId client = 0;
    std::uint64_t number = 0;
    ipc::Request request;
    std::size_t bytes = 0;
  };
  struct Ending {
    std::uint64_t number = 0;
    bool commit = false;
  };
  struct HeldDrag {
    std::uint64_t number = 0;
    ipc::ClientId owner = 0;
    std::uint64_t last_sequence = 0;
    std::optional<ipc::DragStep> newest;  ///< not computed yet; a newer step replaces it
    std::optional<Ending> ending;
    bool orphaned = false;
  };

  void refuse(ipc::ClientId client, std::uint64_t number, const std::string& why);
  void line_up(ipc::ClientId client, std::uint64_t number, ipc::Request request, std::size_t bytes);
  void take_step(ipc::ClientId client, const ipc::DragStep& step);
  void end_drag(ipc::ClientId client, std::uint64_t number, std::uint64_t drag, bool commit);
  void give_snapshot(ipc::ClientId client, std::uint64_t number, const ipc::GetSnapshot& request);
  void share_camera(ipc::ClientId client, const ipc::ShareCamera& shared);
  void give_back(ipc::ClientId client, std::uint64_t lease);
  void cancel(ipc::ClientId client, std::uint64_t number, const ipc::Cancel& cancel);
  ipc::DocumentState state() const;

  /// Starts the next piece of work if none is under way.
  void pump();
  void pump_drag();
  void begin(Waiting next);
  void run(std::function<Outcome()> work, std::function<void(Outcome&)> then);
  /// What happens to long work when the client that asked for it leaves.
  enum class OnDeath : std::uint8_t { stops, goes_on };
  void run_long(const Waiting& next, std::string what, OnDeath on_death, const std::function<Outcome(const Progress&)>& work);
  void begin_drag(const Waiting& next, const mesh::document::Edit& edit);
  void finish(ipc::ClientId client, std::uint64_t number, Outcome& outcome);
  void tell(Outcome& outcome);
  void take_published(Outcome& outcome);
  Progress watch(std::string what);

  ClientChannel& channel_;
  Worker& worker_;
  RequestHandler& handler_;  ///< used on the worker's thread only
  ipc::SnapshotPublisher& publisher_;
  PublishedState published_;
  std::map<ipc::ClientId, Client> clients_;
  std::deque<Waiting> waiting_;
  std::optional<HeldDrag> drag_;
  std::uint64_t next_drag_ = 1;
  bool running_ = false;
  bool stepping_ = false;  ///< a drag's step is running: too short to report busy
  double progress_ = 0;
  std::string reported_;  ///< the work whose progress clients were last told; empty: none
  struct Long {
    ipc::ClientId asker = 0;
    OnDeath on_death = OnDeath::stops;
  };
  std::optional<Long> long_;             ///< the work under way, if the asking client may cancel it
  std::atomic<bool> keeps_ = false;      ///< whoever stops the work wants what it has reached; set before `cancelled_`
  std::atomic<bool> cancelled_ = false;  ///< asks the worker to stop the work under way
};

}  // namespace prismesh::modeld
