// The kiosk's connection to a simulated model server that answers when the test allows it.
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "base/progress.h"
#include "ipc/model/messages_json.h"
#include "ipc/model/snapshot_publisher.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/server.h"
#include "kiosk/link/model_link.h"
#include "tests/ipc/model/small_document.h"

namespace prismesh::kiosk::link {
namespace {

using notices::Notice;
using notices::Trace;

using namespace std::chrono_literals;

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "prismesh-link-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path socket() const { return path_ / "model.sock"; }

 private:
  std::filesystem::path path_;
};

/// Has one document open and keeps requests for a snapshot waiting until `give`. What takes long, it is halfway through until it is asked
/// to stop.
class SlowServer final : public ipc::ServerHandler {
 public:
  explicit SlowServer(const std::filesystem::path& socket)
      : page_(ipc::StatePage::create().value()),
        document_(ipc::test::grid_document(4, 3)),
        server_(ipc::Server::listen(socket, *this).value()) {
    thread_ = std::thread([this] { server_.run(); });
  }
  ~SlowServer() override {
    server_.stop();
    thread_.join();
  }
  SlowServer(const SlowServer&) = delete;
  SlowServer& operator=(const SlowServer&) = delete;

  void connected(ipc::ClientId) override {}
  void disconnected(ipc::ClientId, const std::string&) override {}
  void line(ipc::ClientId client, std::string_view text) override {
    const auto request = ipc::decode_request(text);
    ASSERT_TRUE(request) << request.error().message;
    if (std::holds_alternative<ipc::Hello>(request->request)) {
      std::vector<ipc::Descriptor> descriptors;
      descriptors.push_back(page_.descriptor().duplicate().value());
      answer(client, request->number, ipc::Welcome{ipc::kProtocolVersion, "test", client}, std::move(descriptors));
    } else if (std::holds_alternative<ipc::GetState>(request->request)) {
      ipc::DocumentState state;
      state.open = true;
      state.path = document_.path;
      state.generation = document_.current().number;
      answer(client, request->number, state, {});
    } else if (std::holds_alternative<ipc::GetSnapshot>(request->request)) {
      const std::lock_guard lock(mutex_);
      client_ = client;
      asked_ = request->number;
      ++times_asked_;
      changed_.notify_all();
    } else if (const auto* cancel = std::get_if<ipc::Cancel>(&request->request)) {
      answer(client, request->number, ipc::Done{}, {});
      if (long_ == 0) return;
      if (cancel->keep)
        answer(client, std::exchange(long_, 0), stopped_and_kept(), {});
      else
        answer(client, std::exchange(long_, 0), ipc::Failed{"", 0, cancelled().message}, {});
    } else {
      long_ = request->number;
      const auto* edit = std::get_if<ipc::ApplyEdit>(&request->request);
      const bool repairs = edit != nullptr && std::holds_alternative<mesh::document::Repair>(edit->edit);
      const ipc::ProgressMade repairing{"repair", 0.5, "round 3, 41 of 1109 bad elements left", 25};
      server_.send(client, ipc::encode_event(repairs ? repairing : ipc::ProgressMade{"open", 0.5, "", 0}), {});
    }
  }
  /// Waits until a snapshot has been asked for.
  bool asked() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 30s, [&] { return asked_ != 0; });
  }
  int times_asked() {
    const std::lock_guard lock(mutex_);
    return times_asked_;
  }
  void give() {
    server_.post([this] {
      std::uint64_t number = 0;
      {
        const std::lock_guard lock(mutex_);
        number = std::exchange(asked_, 0);
      }
      ipc::PublishedSnapshot published = publisher_.publish(document_, false).value();
      ipc::Snapshot snapshot{published.lease, document_.current().number, published.segments, published.segments};
      std::vector<ipc::Descriptor> descriptors;
      descriptors.push_back(std::move(published.table));
      for (const std::uint64_t segment : snapshot.new_segments) descriptors.push_back(publisher_.segment(segment).value());
      answer(client_, number, snapshot, std::move(descriptors));
    });
  }

 private:
  static ipc::Edited stopped_and_kept() {
    ipc::Edited edited;
    edited.report.edit = "repair";
    edited.report.notes = {"stopped in round 3"};
    return edited;
  }
  void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& what, std::vector<ipc::Descriptor> descriptors) {
    const std::size_t count = descriptors.size();
    server_.send(client, ipc::encode_answer(number, what, count), std::move(descriptors));
  }

  ipc::StatePage page_;
  mesh::document::Document document_;
  ipc::SnapshotPublisher publisher_{1};
  std::mutex mutex_;
  std::condition_variable changed_;
  ipc::ClientId client_ = 0;
  std::uint64_t asked_ = 0;
  std::uint64_t long_ = 0;  ///< the server's thread's alone
  int times_asked_ = 0;
  ipc::Server server_;
  std::thread thread_;
};

/// Turns until `done`; false when that takes too long.
template <class Done>
bool turn_until(ModelLink& link, const Done& done) {
  const auto until = std::chrono::steady_clock::now() + 30s;
  while (!done()) {
    if (std::chrono::steady_clock::now() > until) return false;
    link.turn();
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

TEST(ModelLinkTest, a_server_that_lets_a_snapshot_wait_does_not_hold_up_the_picture) {
  const Folder folder;
  SlowServer server(folder.socket());
  MonotonicClock clock;
  ModelLink link(folder.socket(), std::nullopt, clock, Trace(nullptr));
  ASSERT_TRUE(turn_until(link, [&] { return !link.document.up_to_date(); }));
  ASSERT_TRUE(server.asked());
  for (int turn = 0; turn < 20; ++turn) link.turn();  // would not come back if it waited for the answer
  EXPECT_EQ(link.document.snapshot(), nullptr);
  EXPECT_FALSE(link.document.up_to_date());
  EXPECT_EQ(server.times_asked(), 1);
  server.give();
  ASSERT_TRUE(turn_until(link, [&] { return link.document.snapshot() != nullptr; }));
  EXPECT_TRUE(link.document.up_to_date());
  EXPECT_EQ(link.document.snapshot()->shell_count(), 12u);
}

TEST(ModelLinkTest, whatever_takes_long_can_be_stopped_and_says_so) {
  const Folder folder;
  SlowServer server(folder.socket());
  MonotonicClock clock;
  ModelLink link(folder.socket(), std::nullopt, clock, Trace(nullptr));
  ASSERT_TRUE(turn_until(link, [&] { return link.connection.connected(); }));
  EXPECT_FALSE(link.connection.progress().can_stop());
  std::string field_answer;
  const std::vector<std::pair<const char*, std::function<void()>>> works = {
      {"opening", [&] { link.deck.open("other.k"); }},
      {"saving", [&] { link.deck.save(ipc::Save{}, {}, [](const ipc::Answer&) {}); }},
      {"an edit", [&] { link.edits.send(mesh::document::Undo{}); }},
      {"a field",
       [&] {
         link.connection.question(ipc::GetField{}, [&](const ipc::Answer& answer) {
           if (const auto* failed = std::get_if<ipc::Failed>(&answer)) field_answer = failed->message;
         });
       }},
      {"a search for contact", [&] { link.connection.question(ipc::GetContacts{}, [](const ipc::Answer&) {}); }},
  };
  for (const auto& [name, begin] : works) {
    SCOPED_TRACE(name);
    begin();
    ASSERT_TRUE(turn_until(link, [&] { return link.connection.progress().fraction() == 0.5 && link.connection.progress().can_stop(); }));
    EXPECT_NE(link.connection.progress().words().find("Esc stops it"), std::string::npos) << link.connection.progress().words();
    link.connection.stop();
    ASSERT_TRUE(turn_until(link, [&] { return link.connection.progress().words().empty(); })) << link.connection.progress().words();
    EXPECT_FALSE(link.connection.progress().can_stop());
  }
  EXPECT_EQ(field_answer, cancelled().message);
  std::vector<std::string> said;
  for (const Notice& notice : link.notices.take()) {
    EXPECT_EQ(notice.kind, Notice::Kind::information) << notice.text;
    said.push_back(notice.text);
  }
  EXPECT_EQ(said, (std::vector<std::string>{"Stopped: other.k was not opened.", "Stopped: nothing was saved.",
                                            "Stopped: the model is as it was."}));
}

TEST(ModelLinkTest, a_repair_says_how_far_it_is_and_can_be_stopped_and_kept) {
  const Folder folder;
  SlowServer server(folder.socket());
  MonotonicClock clock;
  ModelLink link(folder.socket(), std::nullopt, clock, Trace(nullptr));
  ASSERT_TRUE(turn_until(link, [&] { return link.connection.connected(); }));
  for (const bool keep : {false, true}) {
    link.edits.send(mesh::document::Repair{});
    ASSERT_TRUE(turn_until(link, [&] { return link.connection.progress().fraction() == 0.5 && link.connection.progress().can_stop(); }));
    EXPECT_EQ(link.connection.progress().words(),
              "Repairing: round 3, 41 of 1109 bad elements left, 25 s\nEsc stops and discards it, Shift+Esc stops and keeps it");
    link.connection.stop(keep);
    ASSERT_TRUE(turn_until(link, [&] { return link.connection.progress().words().empty(); })) << link.connection.progress().words();
    const std::vector<Notice> said = link.notices.take();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_EQ(said[0].kind, Notice::Kind::information);
    if (keep)
      EXPECT_EQ(said[0].text, "Repaired: nothing was changed\nstopped in round 3");
    else
      EXPECT_EQ(said[0].text, "Stopped: the model is as it was.");
  }
}

}  // namespace
}  // namespace prismesh::kiosk::link
