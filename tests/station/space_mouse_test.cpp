// A SpaceMouse from end to end: a server in the test that speaks as spacenavd does, the kiosk and the model server.
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

#include "ipc/model/client.h"
#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

constexpr std::int64_t kMiddleOfSheet = kFirstNode + (kSheetSide / 2) * kSheetSide + kSheetSide / 2;

/// Sends events to the one program that connects.
class SpnavServer {
 public:
  explicit SpnavServer(std::filesystem::path path) : path_(std::move(path)) {
    listening_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string text = path_.string();
    std::copy_n(text.begin(), std::min(text.size(), sizeof address.sun_path - 1), address.sun_path);
    EXPECT_EQ(::bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(listening_, 8), 0);
  }
  ~SpnavServer() {
    drop();
    ::close(listening_);
    std::filesystem::remove(path_);
  }
  SpnavServer(const SpnavServer&) = delete;
  SpnavServer& operator=(const SpnavServer&) = delete;

  bool accept() {
    pollfd waiting{listening_, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count())) != 1) return false;
    client_ = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    return client_ >= 0;
  }
  void drop() {
    if (client_ >= 0) ::close(client_);
    client_ = -1;
  }
  /// x to the right, y up, z away from the user, and turns about them; 350 is full.
  void motion(std::array<std::int32_t, 6> axes) { send({0, axes[0], axes[1], axes[2], axes[3], axes[4], axes[5], 16}); }
  void rest() { motion({}); }
  void press(std::int32_t button) {
    send({1, button, 0, 0, 0, 0, 0, 0});
    send({2, button, 0, 0, 0, 0, 0, 0});
  }

 private:
  void send(const std::array<std::int32_t, 8>& event) const {
    EXPECT_EQ(::send(client_, event.data(), sizeof event, MSG_NOSIGNAL), static_cast<ssize_t>(sizeof event));
  }

  std::filesystem::path path_;
  int listening_ = -1;
  int client_ = -1;
};

class SpaceMouseTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    const std::filesystem::path path = station_->folder() / "spnav.sock";
    ::setenv("SPNAV_SOCKET", path.c_str(), 1);
    server_ = std::make_unique<SpnavServer>(path);
    station_->start_kiosk();
    ASSERT_TRUE(server_->accept());
    ASSERT_TRUE(traced("space mouse view spacenavd")) << kiosk().all_output();
  }
  void TearDown() override {
    ::unsetenv("SPNAV_SOCKET");
    StationTestCase::TearDown();
  }
  Process& kiosk() { return station_->kiosk(); }
  /// The line came, or comes.
  bool traced(const std::string& beginning) {
    return kiosk().last("space mouse ").starts_with(beginning) || !kiosk().wait_for(beginning).empty();
  }
  std::array<double, 2> middle_on(const std::string& aim_line) { return Station::aim_from(aim_line).pixel_of(nodes_.at(kMiddleOfSheet)); }
  std::array<double, 2> middle_now() { return station_->settled_aim().pixel_of(nodes_.at(kMiddleOfSheet)); }
  /// Waits until the sheet's middle is so far from `from`.
  bool goes(const std::array<double, 2>& from, const std::function<bool(double right, double down)>& wanted) {
    const std::string line = kiosk().wait_until([&](const std::string& each) {
      if (!each.starts_with("aim ")) return false;
      const auto at = middle_on(each);
      return wanted(at[0] - from[0], at[1] - from[1]);
    });
    return !line.empty();
  }
  std::vector<std::string> edits() {
    auto client = ipc::Client::connect(ipc::model_socket_path(station_->folder() / "run"), "test").value();
    const auto answer = client.call(ipc::GetState{}).value();
    std::vector<std::string> made;
    for (const ipc::ListedGeneration& each : std::get<ipc::DocumentState>(answer).generations) made.push_back(each.made_by);
    return made;
  }
  std::size_t translations() {
    const auto all = edits();
    return static_cast<std::size_t>(std::count(all.begin(), all.end(), "translate"));
  }

  std::unique_ptr<SpnavServer> server_;
};

TEST_F(SpaceMouseTest, moves_the_view_while_it_is_pushed_and_fits_it) {
  const auto from = middle_now();
  server_->motion({350, 0, 0, 0, 0, 0});
  EXPECT_TRUE(goes(from, [](double right, double) { return right > 60; })) << "pushed once: it goes on";
  server_->rest();
  const auto right = middle_now();
  EXPECT_NEAR(right[1], from[1], 1);
  EXPECT_EQ(middle_now(), right) << "it rests";
  server_->motion({0, 350, 0, 0, 0, 0});
  EXPECT_TRUE(goes(right, [](double, double down) { return down < -40; }));
  server_->rest();
  middle_now();
  server_->press(0);
  ASSERT_FALSE(kiosk().wait_for("space mouse fits").empty());
  const auto fitted = middle_now();
  EXPECT_NEAR(fitted[0], from[0], 2);
  EXPECT_NEAR(fitted[1], from[1], 2);
  EXPECT_EQ(translations(), 0u);
}

TEST_F(SpaceMouseTest, moves_the_selection_after_its_second_button_until_it_rests) {
  station_->select_middle();
  const auto view = middle_now();
  server_->press(1);
  ASSERT_TRUE(traced("space mouse move spacenavd"));
  EXPECT_TRUE(says("SpaceMouse", "it moves the view"));
  EXPECT_TRUE(says("status SpaceMouse: selection", "moves the selection"));
  server_->motion({0, 200, 0, 0, 0, 0});
  const std::string takes = kiosk().wait_for("space mouse takes ");
  ASSERT_FALSE(takes.empty());
  const std::int64_t grab = std::stoll(takes.substr(std::string_view("space mouse takes ").size()));
  ASSERT_FALSE(kiosk().wait_for("drag shown 20 ").empty());
  station_->show_people("space-mouse");
  server_->rest();
  ASSERT_FALSE(kiosk().wait_for("drag committed").empty());
  EXPECT_EQ(translations(), 1u);
  EXPECT_EQ(middle_now(), view) << "the view stays";
  const auto moved = nodes_of_deck(station_->save_copy("moved.k"));
  const auto aim = station_->settled_aim();
  const auto before = aim.pixel_of(nodes_.at(grab)), after = aim.pixel_of(moved.at(grab));
  EXPECT_LT(after[1], before[1] - 2) << "pushed up, it went up on the screen";
  EXPECT_NEAR(after[0], before[0], 1);
  server_->press(1);
  EXPECT_TRUE(traced("space mouse view spacenavd"));
}

TEST_F(SpaceMouseTest, what_ends_a_move_early_leaves_no_edit) {
  server_->press(1);
  ASSERT_TRUE(traced("space mouse move spacenavd"));
  server_->motion({350, 0, 0, 0, 0, 0});
  ASSERT_FALSE(kiosk().wait_for("space mouse takes nothing").empty()) << "nothing is selected";
  server_->rest();
  station_->key("Escape");
  station_->select_middle();
  const std::string original = station_->save_copy("before.k");
  server_->motion({350, 0, 0, 0, 0, 0});
  ASSERT_FALSE(kiosk().wait_for("drag shown ").empty());
  station_->key("Escape");
  ASSERT_FALSE(kiosk().wait_for("drag cancelled").empty());
  server_->rest();
  station_->settled_aim();
  server_->motion({350, 0, 0, 0, 0, 0});
  ASSERT_FALSE(kiosk().wait_for("drag shown ").empty());
  server_->drop();  // as if it were unplugged
  ASSERT_FALSE(kiosk().wait_for("drag cancelled").empty());
  ASSERT_TRUE(server_->accept()) << "it is looked for again";
  EXPECT_TRUE(traced("space mouse move spacenavd"));
  EXPECT_EQ(translations(), 0u);
  EXPECT_EQ(station_->save_copy("after.k"), original);
}

}  // namespace
}  // namespace prismesh::test
