// Which client may do what, and when: the scheduler with a loop that the test runs step by step, so that it can produce any order of
// events.
#include "daemon/modeld/request_scheduler.h"
#include "base/clock.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include <gtest/gtest.h>

#include "ipc/model/snapshot.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/support/few_descriptors.h"

namespace prismesh::modeld {
namespace {

using namespace mesh::document;

/// Records the messages to clients. Work posted by the worker waits until the test runs it.
class ManualLoop final : public ClientChannel {
 public:
  struct Received {
    ipc::Answer answer;
    std::vector<ipc::Descriptor> descriptors;
  };
  void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& answer, std::vector<ipc::Descriptor> descriptors) override {
    answers_[{client, number}] = Received{answer, std::move(descriptors)};
  }
  void tell(ipc::ClientId client, const ipc::Event& event) override {
    events_.push_back(event);
    received_.push_back(client);
  }
  void tell_all(const ipc::Event& event) override { events_.push_back(event); }
  void post(std::function<void()> work) override {
    const std::lock_guard lock(mutex_);
    posted_.push_back(std::move(work));
    changed_.notify_all();
  }

  /// Waits until something is posted.
  void await() {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, std::chrono::seconds(60), [&] { return !posted_.empty(); })) << "the worker posted nothing";
  }
  /// Runs posted work until the client has its answer.
  Received& wait_for_answer(ipc::ClientId client, std::uint64_t number) {
    while (!answers_.contains({client, number})) {
      await();
      if (::testing::Test::HasFatalFailure()) break;
      run_one();
    }
    return answers_[{client, number}];
  }
  /// Runs posted work until clients are told of the progress of work that is under way.
  ipc::ProgressMade wait_for_progress() {
    for (events_.clear();;) {
      for (const ipc::Event& event : events_)
        if (const auto* made = std::get_if<ipc::ProgressMade>(&event); made != nullptr && made->fraction < 1) return *made;
      await();
      if (::testing::Test::HasFatalFailure()) return {};
      run_one();
    }
  }
  std::vector<ipc::DragEnded> ended_drags() const {
    std::vector<ipc::DragEnded> ended;
    for (const ipc::Event& event : events_)
      if (const auto* drag = std::get_if<ipc::DragEnded>(&event)) ended.push_back(*drag);
    return ended;
  }
  /// The clients that received messages not meant for all.
  const std::vector<ipc::ClientId>& received() const { return received_; }
  /// Runs one posted item.
  void run_one() {
    std::function<void()> work;
    {
      const std::lock_guard lock(mutex_);
      work = std::move(posted_.front());
      posted_.pop_front();
    }
    work();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> posted_;
  std::map<std::pair<ipc::ClientId, std::uint64_t>, Received> answers_;
  std::vector<ipc::Event> events_;
  std::vector<ipc::ClientId> received_;
};

constexpr ipc::ClientId kOne = 1, kOther = 2;

class RequestSchedulerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    scheduler_.arrived(kOne);
    scheduler_.arrived(kOther);
    ipc::Open open;
    open.path = folder_.sheet().string();
    ask<ipc::DocumentState>(kOne, open);
  }
  /// Sends a request and waits for its answer.
  template <class A>
  A ask(ipc::ClientId client, ipc::Request request) {
    const std::uint64_t number = begin(client, std::move(request));
    ManualLoop::Received& received = loop_.wait_for_answer(client, number);
    if (const auto* failed = std::get_if<ipc::Failed>(&received.answer)) ADD_FAILURE() << failed->message;
    return std::get<A>(received.answer);
  }
  std::uint64_t begin(ipc::ClientId client, ipc::Request request, std::size_t bytes = 100) {
    scheduler_.request(client, ++number_, std::move(request), bytes);
    return number_;
  }
  /// Returns the sentence with which a request is refused.
  std::string refusal(ipc::ClientId client, ipc::Request request, std::size_t bytes = 100) {
    const std::uint64_t number = begin(client, std::move(request), bytes);
    const auto* failed = std::get_if<ipc::Failed>(&loop_.wait_for_answer(client, number).answer);
    return failed != nullptr ? failed->message : "accepted";
  }
  static ipc::BeginDrag drag() {
    Translate translate;
    translate.shaping.on = "1313";
    return {translate};
  }
  static ipc::DragStep step(std::uint64_t drag, std::uint64_t sequence, double up) { return {drag, sequence, {0, 0, up}, 0, 0}; }
  /// The snapshot that views see.
  std::shared_ptr<const ipc::SnapshotView> view(const ipc::GetSnapshot& request = {}) {
    ManualLoop::Received& received = loop_.wait_for_answer(kOne, begin(kOne, request));
    const auto& snapshot = std::get<ipc::Snapshot>(received.answer);
    std::vector<std::shared_ptr<const ipc::Mapping>> segments;
    for (std::size_t i = 0; i < snapshot.segments.size(); ++i)
      segments.push_back(std::make_shared<const ipc::Mapping>(ipc::Mapping::map(received.descriptors[i + 1], false).value()));
    scheduler_.request(kOne, 0, ipc::ReturnSnapshot{snapshot.lease}, 0);
    return ipc::SnapshotView::map(received.descriptors[0], segments).value();
  }
  /// The height at which views see the dragged node.
  double height(const ipc::GetSnapshot& request = {}) {
    const std::shared_ptr<const ipc::SnapshotView> seen = view(request);
    for (std::size_t n = 0; n < seen->node_count(); ++n)
      if (seen->node_id(n) == 1313) return seen->position(n).z();
    ADD_FAILURE() << "the node isn't there";
    return 0;
  }

  test::Folder folder_;
  ipc::SnapshotPublisher publisher_{1};
  ManualClock clock_;
  RequestHandler handler_{StateFolder(folder_.state()), publisher_, std::size_t{1} << 30, clock_};
  ManualLoop loop_;
  Worker worker_;
  RequestScheduler scheduler_{loop_, worker_, handler_, publisher_};
  std::uint64_t number_ = 0;
};

TEST_F(RequestSchedulerTest, a_client_that_leaves_while_its_drag_begins_leaves_no_drag) {
  begin(kOne, drag());
  loop_.await();
  scheduler_.left(kOne);
  const auto until_ended = [&] {
    while (loop_.ended_drags().empty()) {
      loop_.await();
      loop_.run_one();
    }
  };
  until_ended();
  EXPECT_EQ(loop_.ended_drags().front().why, "its client has gone");
  EXPECT_GT(ask<ipc::DragBegun>(kOther, drag()).drag, 0u) << "others may drag";
}

TEST_F(RequestSchedulerTest, skips_a_step_that_comes_after_a_newer_one) {
  const double before = height();
  const std::uint64_t held = ask<ipc::DragBegun>(kOne, drag()).drag;
  begin(kOne, step(held, 2, 0.5));
  begin(kOne, step(held, 1, 0.25));
  ask<ipc::Edited>(kOne, ipc::CommitDrag{held});
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(RequestSchedulerTest, a_step_of_an_earlier_drag_does_not_move_the_next_one) {
  const double before = height();
  const std::uint64_t first = ask<ipc::DragBegun>(kOne, drag()).drag;
  ask<ipc::Done>(kOne, ipc::CancelDrag{first});
  const std::uint64_t second = ask<ipc::DragBegun>(kOne, drag()).drag;
  begin(kOne, step(second, 1, 0.5));
  begin(kOne, step(first, 2, 0.25));
  ask<ipc::Edited>(kOne, ipc::CommitDrag{second});
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(RequestSchedulerTest, steps_after_the_commit_have_no_effect) {
  const double before = height();
  const std::uint64_t held = ask<ipc::DragBegun>(kOne, drag()).drag;
  begin(kOne, step(held, 1, 0.5));
  const std::uint64_t commit = begin(kOne, ipc::CommitDrag{held});
  begin(kOne, step(held, 2, 0.25));
  loop_.wait_for_answer(kOne, commit);
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(RequestSchedulerTest, only_its_holder_can_return_a_snapshot) {
  const std::uint64_t lease = ask<ipc::Snapshot>(kOne, ipc::GetSnapshot{}).lease;
  begin(kOther, ipc::ReturnSnapshot{lease});
  ask<ipc::Done>(kOne, ipc::Close{});
  EXPECT_GT(publisher_.bytes_held(), 0u) << "one still looks at it";
  begin(kOne, ipc::ReturnSnapshot{lease});
  EXPECT_EQ(publisher_.bytes_held(), 0u);
}

TEST_F(RequestSchedulerTest, one_drag_at_a_time_ended_only_by_its_own_number) {
  // A drag that still waits for another request also counts.
  Translate translate;
  translate.shaping.on = "1314";
  begin(kOne, ipc::ApplyEdit{translate});
  const std::uint64_t beginning = begin(kOne, drag());
  EXPECT_EQ(refusal(kOther, drag()), "another view is dragging; try again when it has let go");
  const std::uint64_t held = std::get<ipc::DragBegun>(loop_.wait_for_answer(kOne, beginning).answer).drag;
  EXPECT_EQ(refusal(kOne, drag()), "you are dragging already; commit or cancel that drag first");
  EXPECT_EQ(refusal(kOther, drag()), "another view is dragging; try again when it has let go");
  const std::string other = std::to_string(held + 1), own = std::to_string(held);
  EXPECT_EQ(refusal(kOne, ipc::CommitDrag{held + 1}), "you hold no drag " + other);
  EXPECT_EQ(refusal(kOther, ipc::CancelDrag{held}), "you hold no drag " + own);
  const std::uint64_t commit = begin(kOne, ipc::CommitDrag{held});
  EXPECT_EQ(refusal(kOne, ipc::CancelDrag{held}), "you hold no drag " + own) << "it is being committed";
  loop_.wait_for_answer(kOne, commit);
  EXPECT_GT(ask<ipc::DragBegun>(kOther, drag()).drag, held) << "now it is the other's turn";
}

TEST_F(RequestSchedulerTest, a_watching_client_that_leaves_does_not_end_anothers_drag) {
  const double before = height();
  const std::uint64_t held = ask<ipc::DragBegun>(kOne, drag()).drag;
  scheduler_.left(kOther);
  begin(kOther, step(held, 7, 9));
  begin(kOne, step(held, 1, 0.5));
  ask<ipc::Edited>(kOne, ipc::CommitDrag{held});
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(RequestSchedulerTest, waiting_requests_are_limited_in_number_and_size) {
  const ipc::GetQuality any;
  const std::uint64_t held = ask<ipc::DragBegun>(kOne, drag()).drag;  // edits wait until it ends
  Translate translate;
  translate.shaping.on = "1314";
  const auto edit = [&](std::size_t bytes) { return begin(kOther, ipc::ApplyEdit{translate}, bytes); };
  std::uint64_t newest = 0;
  for (int i = 0; i < 256; ++i) newest = edit(10);
  const std::string full = "too many requests of yours are waiting; wait for some answers first";
  EXPECT_EQ(refusal(kOther, any), full);
  EXPECT_EQ(refusal(kOne, ipc::CommitDrag{held + 1}), "you hold no drag " + std::to_string(held + 1)) << "what needn't wait is answered";
  ask<ipc::Done>(kOne, ipc::CancelDrag{held});
  loop_.wait_for_answer(kOther, newest);
  const std::uint64_t again = ask<ipc::DragBegun>(kOne, drag()).drag;
  edit(std::size_t{20} << 20);
  EXPECT_EQ(refusal(kOther, ipc::ApplyEdit{translate}, std::size_t{13} << 20), full);
  const std::uint64_t last = edit(std::size_t{12} << 20);
  ask<ipc::Done>(kOne, ipc::CancelDrag{again});
  ASSERT_TRUE(std::holds_alternative<ipc::Edited>(loop_.wait_for_answer(kOther, last).answer)) << "what was answered no longer counts";
}

TEST_F(RequestSchedulerTest, snapshots_are_limited_in_number_and_to_existing_states) {
  ipc::GetSnapshot gone;
  gone.generation = 4711;
  EXPECT_EQ(refusal(kOne, gone), "the history has no state 4711 any more");
  std::uint64_t lease = 0;
  for (int i = 0; i < 256; ++i) lease = ask<ipc::Snapshot>(kOne, ipc::GetSnapshot{}).lease;
  EXPECT_EQ(refusal(kOne, ipc::GetSnapshot{}), "you hold too many snapshots; return some first");
  ask<ipc::Snapshot>(kOther, ipc::GetSnapshot{});
  begin(kOne, ipc::ReturnSnapshot{lease});
  ask<ipc::Snapshot>(kOne, ipc::GetSnapshot{});
}

TEST_F(RequestSchedulerTest, only_the_requesting_client_can_cancel) {
  EXPECT_EQ(refusal(kOne, ipc::Cancel{}), "nothing of yours is under way that can be stopped");
  Translate translate;
  translate.shaping.on = "1313";
  const std::uint64_t edit = begin(kOne, ipc::ApplyEdit{translate});
  EXPECT_EQ(refusal(kOther, ipc::Cancel{}), "nothing of yours is under way that can be stopped");
  loop_.wait_for_answer(kOne, edit);
  EXPECT_EQ(refusal(kOne, ipc::Cancel{}), "nothing of yours is under way that can be stopped") << "it is done";
}

TEST_F(RequestSchedulerTest, a_repair_says_how_far_it_is_and_the_first_cancel_says_whether_it_is_kept) {
  const std::string bend = R"({"edit":"translate","by":[3,3,9],"on":"1000-1400:37","falloff":{"profile":"constant"}})";
  ask<ipc::Edited>(kOne, ipc::ApplyEdit{parse_edit(bend).value()});
  for (const bool keep : {false, true}) {
    Repair all;
    all.scope = Scope::all;
    const std::uint64_t repair = begin(kOne, ipc::ApplyEdit{all});
    const ipc::ProgressMade made = loop_.wait_for_progress();
    EXPECT_EQ(made.what, "repair");
    EXPECT_EQ(made.doing.rfind("round 1, ", 0), 0u) << made.doing;
    begin(kOne, ipc::Cancel{keep});
    begin(kOne, ipc::Cancel{!keep});
    const ipc::Answer& answer = loop_.wait_for_answer(kOne, repair).answer;
    if (keep) {
      ASSERT_TRUE(std::holds_alternative<ipc::Edited>(answer)) << std::get<ipc::Failed>(answer).message;
      EXPECT_TRUE(std::get<ipc::Edited>(answer).report.stopped);
    } else {
      ASSERT_TRUE(std::holds_alternative<ipc::Failed>(answer));
      EXPECT_EQ(std::get<ipc::Failed>(answer).message, "cancelled");
    }
  }
}

TEST_F(RequestSchedulerTest, waiting_requests_are_executed_in_order) {
  Translate up;
  up.shaping.on = "1313";
  up.by = {0, 0, 0.5};
  const std::uint64_t held = ask<ipc::DragBegun>(kOther, drag()).drag;
  const double before = height();
  const std::uint64_t first = begin(kOne, ipc::ApplyEdit{up});
  begin(kOne, ipc::ApplyEdit{Undo{}});
  const std::uint64_t last = begin(kOne, ipc::ApplyEdit{up});
  ask<ipc::Done>(kOther, ipc::CancelDrag{held});
  ASSERT_TRUE(std::holds_alternative<ipc::Edited>(loop_.wait_for_answer(kOne, last).answer));
  EXPECT_TRUE(std::holds_alternative<ipc::Edited>(loop_.wait_for_answer(kOne, first).answer));
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(RequestSchedulerTest, a_drag_begins_with_the_grabbed_node_and_the_outward_direction) {
  const ipc::DragBegun begun = ask<ipc::DragBegun>(kOne, drag());
  EXPECT_EQ(begun.grab, 1313);
  EXPECT_EQ(begun.base_generation, ask<ipc::DocumentState>(kOther, ipc::GetState{}).generation);
  EXPECT_EQ(begun.nodes, 1u);
  const test::Point out = test::sheet_normal(begun.grab_position);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(begun.normal[axis], out[axis], 0.02);
}

TEST_F(RequestSchedulerTest, views_see_the_reported_state) {
  struct Step {
    const char* edit;  ///< null: a save in place
    bool changed, hidden, locked, can_undo, can_redo;
    std::uint64_t selected;
  };
  const Step steps[] = {
      {R"({"edit":"translate","by":[0,0,3],"on":"1313","falloff":{"profile":"constant"}})", true, false, false, true, false, 0},
      {R"({"edit":"select","expr":"1001-1010"})", true, false, false, true, false, 10},
      {nullptr, false, false, false, true, false, 10},
      {R"({"edit":"lock","on":"7"})", false, false, true, true, false, 10},
      {R"({"edit":"hide","on":"7"})", false, true, true, true, false, 0},
      {R"({"edit":"undo"})", false, false, true, true, true, 10},
      {R"({"edit":"undo"})", false, false, false, true, true, 10},
      {R"({"edit":"undo"})", false, false, false, true, true, 0},
      {R"({"edit":"undo"})", true, false, false, false, true, 0},
  };
  for (const Step& step : steps) {
    SCOPED_TRACE(step.edit == nullptr ? "save" : step.edit);
    if (step.edit == nullptr)
      ask<ipc::Saved>(kOther, ipc::Save{});
    else
      ask<ipc::Edited>(kOther, ipc::ApplyEdit{parse_edit(step.edit).value()});
    const auto state = ask<ipc::DocumentState>(kOne, ipc::GetState{});
    const std::shared_ptr<const ipc::SnapshotView> seen = view();
    const ipc::SnapshotInfo& info = seen->info();
    EXPECT_EQ(info.generation, state.generation);
    EXPECT_EQ(info.document, (folder_.path() / "sheet.k").string());
    EXPECT_EQ(info.counts, state.counts);
    EXPECT_EQ(info.nodes, 625u);
    for (const bool changed : {info.changed, state.changed}) EXPECT_EQ(changed, step.changed);
    for (const bool can_undo : {info.can_undo, state.can_undo}) EXPECT_EQ(can_undo, step.can_undo);
    for (const bool can_redo : {info.can_redo, state.can_redo}) EXPECT_EQ(can_redo, step.can_redo);
    for (const std::uint64_t selected : {info.selected_nodes, state.selected_nodes}) EXPECT_EQ(selected, step.selected);
    ASSERT_EQ(info.parts.size(), 1u);
    EXPECT_EQ(info.parts[0].hidden, step.hidden);
    EXPECT_EQ(info.parts[0].locked, step.locked);
    std::uint64_t marked = 0;
    for (std::size_t n = 0; n < seen->node_count(); ++n) marked += seen->selected(n) ? 1 : 0;
    EXPECT_EQ(marked, step.selected);
  }
  EXPECT_EQ(refusal(kOther, ipc::ApplyEdit{Undo{}}), "there is nothing to undo");
}

TEST_F(RequestSchedulerTest, goes_to_any_state_in_one_request_and_lists_them) {
  const double before = height();
  Translate up;
  up.shaping.on = "1313";
  up.by = {0, 0, 0.5};
  for (int i = 0; i < 3; ++i) ask<ipc::Edited>(kOne, ipc::ApplyEdit{up});
  const auto all = ask<ipc::History>(kOther, ipc::GetHistory{});
  ASSERT_EQ(all.generations.size(), 4u);
  EXPECT_EQ(all.generations[0].made_by, "open");
  EXPECT_EQ(all.generations[3].made_by, "translate");
  EXPECT_EQ(all.generation, all.generations[3].number);
  const auto back = ask<ipc::Edited>(kOther, ipc::GoTo{all.generations[1].number});
  EXPECT_EQ(back.generation, all.generations[1].number);
  EXPECT_EQ(back.report.edit, "undo");
  EXPECT_EQ(height(), before + 0.5);
  const auto now = ask<ipc::History>(kOne, ipc::GetHistory{});
  EXPECT_EQ(now.generation, all.generations[1].number);
  EXPECT_EQ(now.generations.size(), 4u) << "the newer ones can be redone";
  EXPECT_EQ(ask<ipc::Edited>(kOne, ipc::GoTo{all.generation}).report.edit, "redo");
  EXPECT_EQ(height(), before + 1.5);
  ask<ipc::Edited>(kOne, ipc::GoTo{all.generations[1].number});
  ask<ipc::Edited>(kOne, ipc::ApplyEdit{up});
  const auto left = ask<ipc::History>(kOne, ipc::GetHistory{});
  ASSERT_EQ(left.branches.size(), 1u);
  EXPECT_EQ(left.branches[0].number, 1u);
  EXPECT_EQ(left.branches[0].fork, all.generations[1].number);
  ASSERT_EQ(left.branches[0].generations.size(), 2u);
  EXPECT_EQ(left.branches[0].generations[1].number, all.generation);
  EXPECT_EQ(left.branches[0].generations[1].made_by, "translate");
  ask<ipc::Edited>(kOne, ipc::GoTo{all.generation});
  EXPECT_EQ(height(), before + 1.5) << "of the branch";
  EXPECT_EQ(refusal(kOne, ipc::GoTo{12345}), "the history has no state 12345 any more");
  ask<ipc::Done>(kOne, ipc::Close{true});
  EXPECT_EQ(refusal(kOne, ipc::GoTo{all.generation}), "no document is open");
  EXPECT_TRUE(ask<ipc::History>(kOne, ipc::GetHistory{}).generations.empty());
}

TEST_F(RequestSchedulerTest, shows_an_earlier_state_and_does_not_resend_what_the_client_has) {
  const double before = height();
  const std::uint64_t first = ask<ipc::DocumentState>(kOne, ipc::GetState{}).generation;
  Translate up;
  up.shaping.on = "1313";
  up.by = {0, 0, 0.5};
  ask<ipc::Edited>(kOne, ipc::ApplyEdit{up});
  ipc::GetSnapshot earlier;
  earlier.generation = first;
  EXPECT_EQ(height(earlier), before);
  EXPECT_EQ(view(earlier)->info().generation, first);
  EXPECT_EQ(height(), before + 0.5);
  const auto whole = ask<ipc::Snapshot>(kOne, ipc::GetSnapshot{});
  EXPECT_EQ(whole.new_segments, whole.segments);
  ipc::GetSnapshot known;
  known.have_segments = whole.segments;
  ManualLoop::Received& again = loop_.wait_for_answer(kOne, begin(kOne, known));
  EXPECT_EQ(std::get<ipc::Snapshot>(again.answer).segments, whole.segments);
  EXPECT_TRUE(std::get<ipc::Snapshot>(again.answer).new_segments.empty());
  EXPECT_EQ(again.descriptors.size(), 1u) << "the table alone";
}

TEST_F(RequestSchedulerTest, a_snapshot_for_which_there_are_no_descriptors_is_refused_and_holds_nothing) {
  int free = 0;
  std::string why;
  for (; free < 20; ++free) {
    {
      const test::FewDescriptors few(free);
      why = refusal(kOne, ipc::GetSnapshot{});
    }
    if (why == "accepted") break;
    EXPECT_NE(why.find("Too many open files"), std::string::npos) << why;
  }
  EXPECT_GT(free, 1) << "the table and each segment take one";
  EXPECT_LT(free, 20);
  ask<ipc::Done>(kOther, ipc::Close{});
  EXPECT_GT(publisher_.bytes_held(), 0u) << "the snapshot that was sent";
  scheduler_.left(kOne);
  EXPECT_EQ(publisher_.bytes_held(), 0u) << "those that were refused hold nothing";
}

TEST_F(RequestSchedulerTest, waiting_requests_of_a_client_that_left_are_dropped) {
  const double before = height();
  const std::uint64_t held = ask<ipc::DragBegun>(kOne, drag()).drag;
  Translate up;
  up.shaping.on = "1313";
  up.by = {0, 0, 0.5};
  begin(kOther, ipc::ApplyEdit{up});
  scheduler_.left(kOther);
  ask<ipc::Done>(kOne, ipc::CancelDrag{held});
  EXPECT_EQ(height(), before);
  EXPECT_EQ(refusal(kOne, ipc::ApplyEdit{Undo{}}), "there is nothing to undo");
}

TEST_F(RequestSchedulerTest, snapshots_of_a_client_that_left_are_returned) {
  ask<ipc::Snapshot>(kOne, ipc::GetSnapshot{});
  ask<ipc::Done>(kOther, ipc::Close{});
  EXPECT_GT(publisher_.bytes_held(), 0u);
  scheduler_.left(kOne);
  EXPECT_EQ(publisher_.bytes_held(), 0u);
  EXPECT_EQ(scheduler_.health().clients, 1u);
}

TEST_F(RequestSchedulerTest, refuses_requests_that_are_invalid_or_too_early) {
  ask<ipc::Done>(kOne, ipc::Close{});
  EXPECT_EQ(refusal(kOne, ipc::GetSnapshot{}), "no document is open");
  EXPECT_FALSE(ask<ipc::DocumentState>(kOne, ipc::GetState{}).busy);
  ipc::Open open;
  open.path = folder_.sheet().string();
  const std::uint64_t opening = begin(kOther, open);
  EXPECT_EQ(refusal(kOne, ipc::GetSnapshot{}), "the document is still being opened");
  EXPECT_TRUE(ask<ipc::DocumentState>(kOne, ipc::GetState{}).busy);
  loop_.wait_for_answer(kOther, opening);
  EXPECT_FALSE(ask<ipc::DocumentState>(kOne, ipc::GetState{}).busy);
  EXPECT_EQ(refusal(kOne, ipc::Hello{}), "this can't be asked now") << "a second greeting";
}

TEST_F(RequestSchedulerTest, a_camera_is_shared_with_the_others) {
  begin(kOne, ipc::ShareCamera{});
  EXPECT_EQ(loop_.received(), (std::vector<ipc::ClientId>{kOther}));
}

}  // namespace
}  // namespace prismesh::modeld
