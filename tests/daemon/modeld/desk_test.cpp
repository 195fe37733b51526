// Who may do what when: the desk with a loop that the test turns by hand, so that each order of events can be had.
#include "daemon/modeld/desk.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include <gtest/gtest.h>

#include "ipc/snapshot.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

using namespace mesh::document;

/// Remembers what clients are told. What the worker posts waits until the test lets it run.
class HandTurnedLoop final : public Outlet {
 public:
  struct Told {
    ipc::Answer answer;
    std::vector<ipc::Descriptor> descriptors;
  };
  void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& answer, std::vector<ipc::Descriptor> descriptors) override {
    answers_[{client, number}] = Told{answer, std::move(descriptors)};
  }
  void tell(ipc::ClientId, const ipc::Event& event) override { events_.push_back(event); }
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
  /// Lets what is posted run until the client has its answer.
  Told& until_answered(ipc::ClientId client, std::uint64_t number) {
    while (!answers_.contains({client, number})) {
      await();
      if (::testing::Test::HasFatalFailure()) break;
      turn();
    }
    return answers_[{client, number}];
  }
  std::vector<ipc::DragEnded> ended_drags() const {
    std::vector<ipc::DragEnded> ended;
    for (const ipc::Event& event : events_)
      if (const auto* drag = std::get_if<ipc::DragEnded>(&event)) ended.push_back(*drag);
    return ended;
  }
  /// One piece of what is posted.
  void turn() {
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
  std::map<std::pair<ipc::ClientId, std::uint64_t>, Told> answers_;
  std::vector<ipc::Event> events_;
};

constexpr ipc::ClientId kOne = 1, kOther = 2;

class DeskTest : public ::testing::Test {
 protected:
  void SetUp() override {
    desk_.arrived(kOne);
    desk_.arrived(kOther);
    ipc::Open open;
    open.path = folder_.sheet().string();
    ask<ipc::State>(kOne, open);
  }
  /// Asks and waits for the answer.
  template <class A>
  A ask(ipc::ClientId client, ipc::Request request) {
    const std::uint64_t number = begin(client, std::move(request));
    HandTurnedLoop::Told& told = loop_.until_answered(client, number);
    if (const auto* failed = std::get_if<ipc::Failed>(&told.answer)) ADD_FAILURE() << failed->message;
    return std::get<A>(told.answer);
  }
  std::uint64_t begin(ipc::ClientId client, ipc::Request request) {
    desk_.request(client, ++number_, std::move(request), 100);
    return number_;
  }
  static ipc::BeginDrag drag() {
    Translate translate;
    translate.shaping.on = "1313";
    return {translate};
  }
  static ipc::DragStep step(std::uint64_t drag, std::uint64_t sequence, double up) { return {drag, sequence, {0, 0, up}, 0, 0}; }
  /// Where views see the node that is dragged.
  double height() {
    HandTurnedLoop::Told& told = loop_.until_answered(kOne, begin(kOne, ipc::GetSnapshot{}));
    const auto& snapshot = std::get<ipc::Snapshot>(told.answer);
    std::vector<std::shared_ptr<const ipc::Mapping>> segments;
    for (std::size_t i = 0; i < snapshot.segments.size(); ++i)
      segments.push_back(std::make_shared<const ipc::Mapping>(ipc::Mapping::map(told.descriptors[i + 1], false).value()));
    const auto view = ipc::SnapshotView::map(told.descriptors[0], segments).value();
    desk_.request(kOne, 0, ipc::ReturnSnapshot{snapshot.lease}, 0);
    for (std::size_t n = 0; n < view->node_count(); ++n)
      if (view->node_id(n) == 1313) return view->position(n).z();
    ADD_FAILURE() << "the node isn't there";
    return 0;
  }

  test::Folder folder_;
  ipc::SnapshotPublisher publisher_{1};
  Bench bench_{StateFolder(folder_.state()), publisher_, std::size_t{1} << 30};
  HandTurnedLoop loop_;
  Worker worker_;
  Desk desk_{loop_, worker_, bench_, publisher_};
  std::uint64_t number_ = 0;
};

TEST_F(DeskTest, AClientThatGoesWhileItsDragBeginsLeavesNoDragBehind) {
  begin(kOne, drag());
  loop_.await();
  desk_.left(kOne);
  const auto until_ended = [&] {
    while (loop_.ended_drags().empty()) {
      loop_.await();
      loop_.turn();
    }
  };
  until_ended();
  EXPECT_EQ(loop_.ended_drags().front().why, "its client has gone");
  EXPECT_GT(ask<ipc::DragBegun>(kOther, drag()).drag, 0u) << "others may drag";
}

TEST_F(DeskTest, AStepThatComesAfterANewerOneIsLeftOut) {
  const double before = height();
  const std::uint64_t held = ask<ipc::DragBegun>(kOne, drag()).drag;
  begin(kOne, step(held, 2, 0.5));
  begin(kOne, step(held, 1, 0.25));
  ask<ipc::Edited>(kOne, ipc::CommitDrag{held});
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(DeskTest, AStepOfAnEarlierDragDoesNotMoveTheNextOne) {
  const double before = height();
  const std::uint64_t first = ask<ipc::DragBegun>(kOne, drag()).drag;
  ask<ipc::Done>(kOne, ipc::CancelDrag{first});
  const std::uint64_t second = ask<ipc::DragBegun>(kOne, drag()).drag;
  begin(kOne, step(second, 1, 0.5));
  begin(kOne, step(first, 2, 0.25));
  ask<ipc::Edited>(kOne, ipc::CommitDrag{second});
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(DeskTest, WhatComesAfterTheCommitDoesNotMoveIt) {
  const double before = height();
  const std::uint64_t held = ask<ipc::DragBegun>(kOne, drag()).drag;
  begin(kOne, step(held, 1, 0.5));
  const std::uint64_t commit = begin(kOne, ipc::CommitDrag{held});
  begin(kOne, step(held, 2, 0.25));
  loop_.until_answered(kOne, commit);
  EXPECT_EQ(height(), before + 0.5);
}

TEST_F(DeskTest, OnlyItsHolderReturnsASnapshot) {
  const std::uint64_t lease = ask<ipc::Snapshot>(kOne, ipc::GetSnapshot{}).lease;
  begin(kOther, ipc::ReturnSnapshot{lease});
  ask<ipc::Done>(kOne, ipc::Close{});
  EXPECT_GT(publisher_.bytes_held(), 0u) << "one still looks at it";
  begin(kOne, ipc::ReturnSnapshot{lease});
  EXPECT_EQ(publisher_.bytes_held(), 0u);
}

}  // namespace
}  // namespace prismesh::modeld
