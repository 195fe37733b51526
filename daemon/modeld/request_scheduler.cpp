#include "daemon/modeld/request_scheduler.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <new>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "base/log.h"
#include "mesh/document/edit_kinds.h"

namespace prismesh::modeld {

namespace {

ipc::History history_of(const PublishedState& published) {
  ipc::History history{published.state.generation, published.state.generations, {}};
  if (!published.document) return history;
  for (const mesh::document::Branch& branch : published.document->branches) {
    ipc::HistoryBranch& told = history.branches.emplace_back(ipc::HistoryBranch{branch.number, branch.fork, {}});
    for (const auto& state : branch.states) told.generations.push_back({state->number, state->made_by});
  }
  return history;
}

constexpr std::size_t kMaxWaiting = 256;
constexpr std::size_t kMaxWaitingBytes = std::size_t{32} << 20;
constexpr std::size_t kMaxLeases = 256;
constexpr std::int64_t kProgressPeriodNs = 100'000'000;

constexpr const char* kNoMemory = "there isn't enough memory to do this; everything is as it was";

/// Runs the work and turns exceptions into Failed answers. Work that throws has changed nothing.
Outcome done_or_failed(const std::function<Outcome()>& work) {
  Outcome failed;
  try {
    return work();
  } catch (const std::bad_alloc&) {
    failed.answer = ipc::Failed{"", 0, kNoMemory};
  } catch (const std::exception& problem) {
    failed.answer =
        ipc::Failed{"", 0, std::string("this failed by a fault of the program (") + problem.what() + "); everything is as it was"};
  }
  logging::error("{}", std::get<ipc::Failed>(failed.answer).message);
  return failed;
}

/// Retries until there is memory: without this post the scheduler would wait for ever.
void post_in_any_case(ClientChannel& channel, const std::function<void()>& work) {
  for (;;) {
    try {
      return channel.post(work);
    } catch (const std::bad_alloc&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
}

}  // namespace

void RequestScheduler::start(std::function<void(const ipc::Answer&)> when_done) {
  run([this, progress = watch("open")] { return handler_.reopen(progress); },
      [this, when_done = std::move(when_done)](Outcome& outcome) {
        tell(outcome);
        when_done(outcome.answer);
      });
}

void RequestScheduler::arrived(ipc::ClientId client) { clients_.try_emplace(client); }

void RequestScheduler::left(ipc::ClientId client) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  for (const std::uint64_t lease : found->second.leases) publisher_.release(lease);
  clients_.erase(found);
  std::erase_if(waiting_, [&](const Waiting& each) { return each.client == client; });
  if (drag_ && drag_->owner == client) drag_->orphaned = true;
  if (long_ && long_->asker == client && long_->on_death == OnDeath::stops) cancelled_ = true;
  pump();
}

void RequestScheduler::request(ipc::ClientId client, std::uint64_t number, ipc::Request request, std::size_t bytes) {
  if (!clients_.contains(client)) return;
  if (const auto* step = std::get_if<ipc::DragStep>(&request)) return take_step(client, *step);
  if (const auto* commit = std::get_if<ipc::CommitDrag>(&request)) return end_drag(client, number, commit->drag, true);
  if (const auto* cancel = std::get_if<ipc::CancelDrag>(&request)) return end_drag(client, number, cancel->drag, false);
  if (const auto* returned = std::get_if<ipc::ReturnSnapshot>(&request)) return give_back(client, returned->lease);
  if (const auto* snapshot = std::get_if<ipc::GetSnapshot>(&request)) return give_snapshot(client, number, *snapshot);
  if (const auto* camera = std::get_if<ipc::ShareCamera>(&request)) return share_camera(client, *camera);
  if (const auto* cancelled = std::get_if<ipc::Cancel>(&request)) return cancel(client, number, *cancelled);
  if (std::holds_alternative<ipc::GetHistory>(request)) return channel_.answer(client, number, history_of(published_), {});
  if (std::holds_alternative<ipc::GetState>(request)) return channel_.answer(client, number, state(), {});
  line_up(client, number, std::move(request), bytes);
}

void RequestScheduler::refuse(ipc::ClientId client, std::uint64_t number, const std::string& why) {
  channel_.answer(client, number, ipc::Failed{"", 0, why}, {});
}

void RequestScheduler::line_up(ipc::ClientId client, std::uint64_t number, ipc::Request request, std::size_t bytes) {
  Client& from = clients_[client];
  if (from.waiting >= kMaxWaiting || from.waiting_bytes + bytes > kMaxWaitingBytes)
    return refuse(client, number, "too many requests of yours are waiting; wait for some answers first");
  if (std::holds_alternative<ipc::BeginDrag>(request)) {
    const bool another_waits = std::any_of(waiting_.begin(), waiting_.end(),
                                           [](const Waiting& each) { return std::holds_alternative<ipc::BeginDrag>(each.request); });
    if (drag_ && drag_->owner == client) return refuse(client, number, "you are dragging already; commit or cancel that drag first");
    if (drag_ || another_waits) return refuse(client, number, "another view is dragging; try again when it has let go");
  }
  ++from.waiting;
  from.waiting_bytes += bytes;
  waiting_.push_back({client, number, std::move(request), bytes});
  pump();
}

void RequestScheduler::take_step(ipc::ClientId client, const ipc::DragStep& step) {
  // A step has no answer, so one that arrives after the end of its drag is ignored.
  if (!drag_ || drag_->owner != client || drag_->number != step.drag || drag_->ending || step.sequence <= drag_->last_sequence) return;
  drag_->last_sequence = step.sequence;
  drag_->newest = step;
  pump();
}

void RequestScheduler::end_drag(ipc::ClientId client, std::uint64_t number, std::uint64_t drag, bool commit) {
  if (!drag_ || drag_->owner != client || drag_->number != drag || drag_->ending)
    return refuse(client, number, "you hold no drag " + std::to_string(drag));
  drag_->ending = Ending{number, commit};
  if (!commit) drag_->newest.reset();
  pump();
}

void RequestScheduler::give_snapshot(ipc::ClientId client, std::uint64_t number, const ipc::GetSnapshot& request) {
  if (!published_.document) return refuse(client, number, running_ ? "the document is still being opened" : "no document is open");
  Client& to = clients_[client];
  if (to.leases.size() >= kMaxLeases) return refuse(client, number, "you hold too many snapshots; return some first");
  const mesh::document::Document& document = *published_.document;
  std::size_t at = document.cursor;
  if (request.generation) {
    at = 0;
    while (at < document.generations.size() && document.generations[at]->number != *request.generation) ++at;
    if (at == document.generations.size())
      return refuse(client, number, "the history has no state " + std::to_string(*request.generation) + " any more");
  }
  Result<ipc::PublishedSnapshot> published = publisher_.publish_other(document, at, published_.state.changed);
  if (!published) return channel_.answer(client, number, ipc::Failed{published.error().file, 0, published.error().message}, {});
  ipc::Snapshot snapshot{published->lease, document.generations[at]->number, published->segments, {}};
  std::vector<ipc::Descriptor> descriptors;
  descriptors.push_back(std::move(published->table));
  for (const std::uint64_t segment : snapshot.segments) {
    if (std::find(request.have_segments.begin(), request.have_segments.end(), segment) != request.have_segments.end()) continue;
    Result<ipc::Descriptor> descriptor = publisher_.segment(segment);
    if (!descriptor) {
      publisher_.release(snapshot.lease);
      return refuse(client, number, descriptor.error().text());
    }
    snapshot.new_segments.push_back(segment);
    descriptors.push_back(std::move(*descriptor));
  }
  to.leases.insert(snapshot.lease);
  channel_.answer(client, number, snapshot, std::move(descriptors));
}

/// For views that move together: each client decides whether to follow.
void RequestScheduler::share_camera(ipc::ClientId client, const ipc::ShareCamera& shared) {
  std::vector<ipc::ClientId> others;  // a copy: a message that cuts its client off changes the map
  for (const auto& [other, facts] : clients_)
    if (other != client) others.push_back(other);
  for (const ipc::ClientId other : others) channel_.tell(other, ipc::CameraMoved{client, shared.camera});
}

void RequestScheduler::give_back(ipc::ClientId client, std::uint64_t lease) {
  // A client can return only its own leases.
  if (clients_[client].leases.erase(lease) > 0) publisher_.release(lease);
}

void RequestScheduler::cancel(ipc::ClientId client, std::uint64_t number, const ipc::Cancel& cancel) {
  if (!long_ || long_->asker != client) return refuse(client, number, "nothing of yours is under way that can be stopped");
  if (!cancelled_) keeps_ = cancel.keep;
  cancelled_ = true;
  channel_.answer(client, number, ipc::Done{}, {});
}

ipc::DocumentState RequestScheduler::state() const {
  ipc::DocumentState state = published_.state;
  state.busy = running_ && !stepping_;
  return state;
}

ipc::Health RequestScheduler::health() const {
  ipc::Health health;
  health.generation = published_.state.generation;
  health.clients = clients_.size();
  health.progress = progress_;
  health.open = published_.state.open;
  health.busy = running_ && !stepping_;
  health.dragging = drag_.has_value();
  return health;
}

void RequestScheduler::pump() {
  if (running_) return;
  if (drag_) return pump_drag();
  if (waiting_.empty()) return;
  Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  Client& from = clients_[next.client];
  --from.waiting;
  from.waiting_bytes -= next.bytes;
  const ipc::ClientId client = next.client;
  const std::uint64_t number = next.number;
  try {
    begin(std::move(next));
  } catch (const std::bad_alloc&) {
    refuse(client, number, kNoMemory);
  }
}

/// While a drag is under way no other request runs. Runs its newest step first, then its end.
void RequestScheduler::pump_drag() {
  HeldDrag& drag = *drag_;
  const auto over = [this](ipc::ClientId client, std::uint64_t number) {
    return [this, client, number](Outcome& outcome) {
      drag_.reset();
      finish(client, number, outcome);
      channel_.felt({});
    };
  };
  if (drag.orphaned) return run([this] { return handler_.cancel_drag("its client has gone"); }, over(0, 0));
  if (drag.newest) {
    const ipc::DragStep step = *std::exchange(drag.newest, std::nullopt);
    stepping_ = true;
    return run([this, step, for_pen = channel_.follows_pen()] { return handler_.step_drag(step, for_pen); },
               [this](Outcome& outcome) {
                 if (outcome.felt) channel_.felt(outcome.felt);
               });
  }
  if (!drag.ending) return;
  const Ending ending = *drag.ending;
  run([this, ending] { return ending.commit ? handler_.commit_drag() : handler_.cancel_drag("it was cancelled"); },
      over(drag.owner, ending.number));
}

void RequestScheduler::begin(Waiting next) {
  const auto answer = [this, client = next.client, number = next.number](Outcome& outcome) { finish(client, number, outcome); };
  if (auto* open = std::get_if<ipc::Open>(&next.request))
    run_long(next, "open", OnDeath::goes_on,
             [this, request = std::move(*open)](const Progress& progress) { return handler_.open(request, progress); });
  else if (auto* edit = std::get_if<ipc::ApplyEdit>(&next.request))
    run_long(next, std::string(mesh::document::name(edit->edit)), OnDeath::stops,
             [this, edit = std::move(edit->edit)](const Progress& progress) { return handler_.edit(edit, progress); });
  else if (auto* target = std::get_if<ipc::GoTo>(&next.request))
    run_long(next, "Going through the history", OnDeath::goes_on,
             [this, request = *target](const Progress& progress) { return handler_.go_to(request, progress); });
  else if (auto* count = std::get_if<ipc::Count>(&next.request))
    run_long(next, "Counting", OnDeath::stops,
             [this, request = std::move(*count)](const Progress& progress) { return handler_.count(request, progress); });
  else if (auto* quality = std::get_if<ipc::GetQuality>(&next.request))
    run([this, request = std::move(*quality)] { return handler_.quality(request); }, answer);
  else if (auto* find = std::get_if<ipc::FindShells>(&next.request))
    run([this, request = std::move(*find)] { return handler_.find(request); }, answer);
  else if (auto* preview = std::get_if<ipc::PreviewEdit>(&next.request))
    run([this, request = std::move(*preview)] { return handler_.preview(request); }, answer);
  else if (auto* edges = std::get_if<ipc::FindFollowedEdges>(&next.request))
    run([this, request = std::move(*edges)] { return handler_.followed_edges(request); }, answer);
  else if (auto* field = std::get_if<ipc::GetField>(&next.request))
    run_long(next, "Comparing", OnDeath::stops,
             [this, request = std::move(*field)](const Progress& progress) { return handler_.field(request, progress); });
  else if (auto* contacts = std::get_if<ipc::GetContacts>(&next.request))
    run_long(next, "Looking for contact", OnDeath::stops,
             [this, request = std::move(*contacts)](const Progress& progress) { return handler_.contacts(request, progress); });
  else if (auto* welds = std::get_if<ipc::GetWeldChecks>(&next.request))
    run([this, request = *welds] { return handler_.weld_checks(request); }, answer);
  else if (auto* save = std::get_if<ipc::Save>(&next.request))
    run_long(next, "Saving", OnDeath::goes_on,
             [this, request = std::move(*save)](const Progress& progress) { return handler_.save(request, progress); });
  else if (auto* close = std::get_if<ipc::Close>(&next.request))
    run([this, request = *close] { return handler_.close(request); }, answer);
  else if (auto* drag = std::get_if<ipc::BeginDrag>(&next.request))
    begin_drag(next, drag->edit);
  else
    refuse(next.client, next.number, "this can't be asked now");
}

void RequestScheduler::run_long(const Waiting& next, std::string what, OnDeath on_death,
                                const std::function<Outcome(const Progress&)>& work) {
  long_ = Long{next.client, on_death};
  cancelled_ = false;
  keeps_ = false;
  run([work, progress = watch(std::move(what))] { return work(progress); },
      [this, client = next.client, number = next.number](Outcome& outcome) {
        long_.reset();
        cancelled_ = false;
        finish(client, number, outcome);
      });
}

void RequestScheduler::begin_drag(const Waiting& next, const mesh::document::Edit& edit) {
  const std::uint64_t drag = next_drag_++;
  run([this, drag, edit] { return handler_.begin_drag(drag, edit); },
      [this, drag, client = next.client, number = next.number](Outcome& outcome) {
        if (std::holds_alternative<ipc::DragBegun>(outcome.answer)) {
          drag_ = HeldDrag{};
          drag_->number = drag;
          drag_->owner = client;
          drag_->orphaned = !clients_.contains(client);
        }
        finish(client, number, outcome);
      });
}

void RequestScheduler::run(std::function<Outcome()> work, std::function<void(Outcome&)> then) {
  // Shared: a posted function must be copyable, and descriptors aren't.
  auto outcome = std::make_shared<Outcome>();
  auto over = [this, outcome, then = std::move(then)] {
    running_ = false;
    stepping_ = false;
    progress_ = 0;
    then(*outcome);
    // Whatever the outcome, clients that were told of progress are told that the work is over.
    if (!reported_.empty()) channel_.tell_all(ipc::ProgressMade{std::exchange(reported_, {}), 1, {}, 0});
    pump();
  };
  worker_.run([this, work = std::move(work), outcome, over = std::move(over)] {
    *outcome = done_or_failed(work);
    post_in_any_case(channel_, over);
  });
  running_ = true;
}

void RequestScheduler::finish(ipc::ClientId client, std::uint64_t number, Outcome& outcome) {
  take_published(outcome);
  // Answers first: before others see the new generation, its edit is acknowledged.
  if (clients_.contains(client)) channel_.answer(client, number, outcome.answer, std::move(outcome.descriptors));
  tell(outcome);
}

void RequestScheduler::take_published(Outcome& outcome) {
  if (!outcome.published) return;
  published_ = std::move(*outcome.published);
  outcome.published.reset();
  channel_.shown(published_);
  if (!published_.document) ::malloc_trim(0);  // a large model leaves much on the heap, which nobody else could use
}

void RequestScheduler::tell(Outcome& outcome) {
  take_published(outcome);
  for (const ipc::Event& event : outcome.events) channel_.tell_all(event);
}

Progress RequestScheduler::watch(std::string what) {
  const std::int64_t began_ns = MonotonicClock().now_ns();  // `run` begins the work at once
  const auto listener = [this, what = std::move(what), began_ns, last_ns = std::int64_t{0}](double fraction, const Doing& doing) mutable {
    worker_.show_progress();
    MonotonicClock clock;
    if (const std::int64_t now_ns = clock.now_ns(); now_ns - last_ns > kProgressPeriodNs) {
      last_ns = now_ns;
      const auto seconds = static_cast<std::uint64_t>((now_ns - began_ns) / 1'000'000'000);
      channel_.post([this, made = ipc::ProgressMade{what, fraction, doing ? doing() : std::string(), seconds}] {
        progress_ = made.fraction;
        reported_ = made.what;
        channel_.tell_all(made);
      });
    }
    return !worker_.stopping() && !cancelled_;
  };
  return {listener, [this] { return keeps_.load(); }};
}

}  // namespace prismesh::modeld
