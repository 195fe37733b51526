// Who may do what when: takes the clients' requests, lets the worker do one thing at a time, holds edits back while a drag is
// under way. Everything here belongs to the loop's thread.
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
#include "ipc/messages.h"
#include "ipc/server.h"
#include "ipc/state_page.h"

namespace prismesh::modeld {

/// The way to the clients, and from the worker back to the loop.
class Outlet {
 public:
  virtual ~Outlet() = default;
  virtual void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& answer, std::vector<ipc::Descriptor> descriptors) = 0;
  virtual void tell(ipc::ClientId client, const ipc::Event& event) = 0;
  virtual void tell_all(const ipc::Event& event) = 0;
  /// From any thread: runs in the loop, soon.
  virtual void post(std::function<void()> work) = 0;
};

class RequestScheduler {
 public:
  RequestScheduler(Outlet& outlet, Worker& worker, RequestHandler& handler, ipc::SnapshotPublisher& publisher)
      : outlet_(outlet), worker_(worker), handler_(handler), publisher_(publisher) {}

  /// Opens again what was open in the last life.
  void start(std::function<void(const ipc::Answer&)> when_done);
  void arrived(ipc::ClientId client);
  /// The client's drag is cancelled, its snapshots are returned, what it still waits for is dropped.
  void left(ipc::ClientId client);
  /// `bytes` is what the request takes while it waits.
  void request(ipc::ClientId client, std::uint64_t number, ipc::Request request, std::size_t bytes);

  /// All but the process's own figures.
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
    std::optional<ipc::DragStep> newest;  ///< not worked out yet; a newer one replaces it
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
  void cancel(ipc::ClientId client, std::uint64_t number);
  ipc::DocumentState state() const;

  /// Starts the next piece of work if none is under way.
  void pump();
  void pump_drag();
  void begin(Waiting next);
  void run(std::function<Outcome()> work, std::function<void(Outcome&)> then);
  /// Whether long work outlives the client that asked for it.
  enum class OnDeath : std::uint8_t { stops, goes_on };
  void run_long(const Waiting& next, std::string what, OnDeath on_death, const std::function<Outcome(const Progress&)>& work);
  void begin_drag(const Waiting& next, const mesh::document::Edit& edit);
  void finish(ipc::ClientId client, std::uint64_t number, Outcome& outcome);
  void tell(Outcome& outcome);
  Progress watch(std::string what);

  Outlet& outlet_;
  Worker& worker_;
  RequestHandler& handler_;  ///< the worker's
  ipc::SnapshotPublisher& publisher_;
  PublishedState published_;
  std::map<ipc::ClientId, Client> clients_;
  std::deque<Waiting> waiting_;
  std::optional<HeldDrag> drag_;
  std::uint64_t next_drag_ = 1;
  bool running_ = false;
  bool stepping_ = false;  ///< what runs is a drag's step: too short to call it busy
  double progress_ = 0;
  std::string told_;  ///< what clients have been told the progress of
  struct Long {
    ipc::ClientId asker = 0;
    OnDeath on_death = OnDeath::stops;
  };
  std::optional<Long> long_;             ///< the work under way, if its asker may stop it
  std::atomic<bool> cancelled_ = false;  ///< it is to stop; the worker looks at it
};

}  // namespace prismesh::modeld
