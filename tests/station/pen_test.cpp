// The haptic pen from end to end: a device in the test, the pen's process, the model server and the kiosk between them.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "ipc/model/client.h"
#include "tests/station/scripted_pen.h"
#include "tests/station/station_test_case.h"
#include "tests/support/places.h"

namespace prismesh::test {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kMiddle = kFirstNode + (kSheetSide / 2) * kSheetSide + kSheetSide / 2;

class PenTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    device_ = std::make_unique<ScriptedPen>(station_->folder() / "pen");
    station_->start_kiosk();
  }
  void TearDown() override {
    if (HasFailure() && pen_) std::fprintf(stderr, "--- what the pen's process said ---\n%s", pen_->standard_error().c_str());
    pen_.reset();
    device_.reset();
    StationTestCase::TearDown();
  }
  void start_pen(const std::string& more = {}) {
    const std::filesystem::path settings = station_->folder() / "pen.toml";
    std::ofstream(settings) << "[haptic_pen]\ndriver = \"simulated\"\nport = \"" << (station_->folder() / "pen").string() << "\"\n" << more;
    run_pen(settings);
  }
  void run_pen(const std::filesystem::path& settings) {
    pen_ = std::make_unique<Process>(std::vector<std::string>{(programs_folder() / "prismesh-deviced").string(), "--only", "pen",
                                                              "--runtime-dir", (station_->folder() / "run").string(), "--state-dir",
                                                              (station_->folder() / "pen-state").string(), "--config", settings.string()},
                                     std::map<std::string, std::string>{{"XDG_CONFIG_HOME", (station_->folder() / "config").string()}});
  }
  void kill_pen() {
    pen_->kill(SIGKILL);
    EXPECT_EQ(pen_->wait_for_exit(), 128 + SIGKILL);
  }

  /// Where the model is in the pen's space, as the kiosk has told it last.
  struct Place {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    Vector3d shift_mm = Vector3d::Zero();
    double scale = 0;
    Vector3d to_pen(const Point& at) const { return scale * (turn * Vector3d(at.data())) + shift_mm; }
  };
  static Place place_from(const std::string& said) {
    std::stringstream line(said);
    std::string word;
    Place place;
    line >> word >> word >> word >> word >> place.turn.w() >> place.turn.x() >> place.turn.y() >> place.turn.z() >> word;
    line >> place.shift_mm.x() >> place.shift_mm.y() >> place.shift_mm.z() >> word >> place.scale;
    EXPECT_TRUE(line) << "the kiosk hasn't said where the model is: " << said;
    return place;
  }

  Process& kiosk() { return station_->kiosk(); }
  /// Waits for a line; false if the pen's process ended before, or an armed pen latched.
  bool said(const std::string& beginning) {
    line_ = kiosk().wait_until([&](const std::string& line) {
      return line.starts_with(beginning) || line.starts_with("pen disconnected") || (armed_ && line == "pen state latched");
    });
    return line_.starts_with(beginning);
  }
  bool placed() {
    if (!said("pen placed ")) return false;
    place_ = place_from(line_);
    return true;
  }
  /// Does it with a pen that is placed and feels. On a busy machine the pen's guard may end a process that stands still; a station starts
  /// it again, and so does this, and begins anew. `what` returns false where the process has ended.
  void with_pen(const std::function<bool()>& what, const std::string& settings = {}) {
    for (int tries = 0; tries < 5; ++tries) {
      bool there = pen_ != nullptr && pen_->running();
      if (!there) {
        device_->buttons(0);
        armed_ = false;
        start_pen(settings);
        there = placed() && said("pen feels");
      }
      if (there && what()) return;
      if (pen_->running()) pen_->kill(SIGTERM);
      pen_->wait_for_exit();
    }
    FAIL() << "the pen's process ended again and again";
  }
  bool take(std::int64_t node) {
    device_->move_to(place_.to_pen(nodes_.at(node)));
    device_->buttons(ScriptedPen::kFirst);
    if (!said("pen takes ")) return false;
    EXPECT_EQ(line_, "pen takes " + std::to_string(node));
    return said("drag begun ");
  }
  bool pull(std::int64_t node, const Vector3d& by_mm) {
    device_->move_to(place_.to_pen(nodes_.at(node)) + by_mm);
    return said("drag shown ");
  }
  bool release() {
    device_->buttons(0);
    return said("drag committed");
  }

  /// What made the document's states, in their order, without the first.
  std::vector<std::string> edits() {
    auto client = ipc::Client::connect(ipc::model_socket_path(station_->folder() / "run"), "test").value();
    const auto answer = client.call(ipc::GetState{}).value();
    std::vector<std::string> made;
    for (const ipc::ListedGeneration& each : std::get<ipc::DocumentState>(answer).generations) made.push_back(each.made_by);
    if (!made.empty()) made.erase(made.begin());
    return made;
  }
  Vector3d node_now(std::int64_t id) {
    auto client = ipc::Client::connect(ipc::model_socket_path(station_->folder() / "run"), "test").value();
    const auto view = client.snapshot().value();
    for (std::size_t n = 0; n < view->node_count(); ++n)
      if (view->node_id(n) == id) return view->position(n);
    ADD_FAILURE() << "no node " << id;
    return Vector3d::Zero();
  }
  static std::size_t moves_in(const std::vector<std::string>& edits) {
    return static_cast<std::size_t>(std::count(edits.begin(), edits.end(), "move"));
  }

  std::string line_;  ///< waited for last
  bool armed_ = false;
  Place place_;
  std::unique_ptr<ScriptedPen> device_;
  std::unique_ptr<Process> pen_;
};

TEST_F(PenTest, a_grabbed_node_goes_where_the_pen_takes_it_as_one_edit) {
  station_->select_middle();
  const Vector3d by_mm(2, 3, 4);
  Vector3d goal;
  with_pen(
      [&] {
        EXPECT_EQ(place_.scale, 0.5);
        if (!take(kMiddle) || !pull(kMiddle, by_mm)) return false;
        // What is drawn is where the pen is.
        goal = Vector3d(nodes_.at(kMiddle).data()) + place_.turn.conjugate() * by_mm / place_.scale;
        const std::array<double, 2> pixel = station_->pixel_of({goal.x(), goal.y(), goal.z()});
        const auto is_there = [&](const std::string& line) {
          std::stringstream words(line);
          std::string pen, tip, how;
          double x = 0, y = 0;
          return words >> pen >> tip >> x >> y >> how && tip == "tip" && how == "holds" && std::hypot(x - pixel[0], y - pixel[1]) < 1;
        };
        const auto is_there_or_gone = [&](const std::string& line) { return is_there(line) || line.starts_with("pen disconnected"); };
        if (!is_there(kiosk().last("pen tip ")) && !is_there(kiosk().wait_until(is_there_or_gone))) {
          EXPECT_FALSE(pen_->running()) << kiosk().last("pen tip ") << " instead of " << pixel[0] << " " << pixel[1];
          return false;
        }
        station_->show_people("pen");
        return release();
      },
      "workspace_scale = 0.5\n");
  EXPECT_EQ(moves_in(edits()), 1u);
  EXPECT_LT((node_now(kMiddle) - goal).norm(), 0.01) << node_now(kMiddle).transpose();
}

TEST_F(PenTest, what_isnt_selected_is_moved_with_its_region_and_a_turned_view_goes_with_the_pen) {
  int presses = 0;
  with_pen([&] {
    // From above and from in front in turn, so that each try turns the view.
    const bool above = ++presses % 2 == 1;
    station_->key(above ? "5" : "1");
    if (!placed()) return false;
    const Vector3d toward = above ? Vector3d(0, 0, 1) : Vector3d(0, -1, 0);
    EXPECT_LT((place_.turn * toward - Vector3d::UnitZ()).norm(), 1e-6);
    // The clutch moves the pen's space: the same node is elsewhere then.
    const Vector3d before = place_.shift_mm;
    device_->move_to(Vector3d::Zero());
    device_->buttons(ScriptedPen::kSecond);
    device_->move_to({0, 0, 15});
    device_->buttons(0);
    do {
      if (!placed()) return false;
    } while ((place_.shift_mm - before - Vector3d(0, 0, 15)).norm() > 0.1);
    if (!take(kMiddle) || !pull(kMiddle, place_.turn * Vector3d(0, 0, 6))) return false;
    return release();
  });
  EXPECT_EQ(edits(), std::vector<std::string>{"move"}) << "no selection was made";
  EXPECT_NEAR(node_now(kMiddle).z(), nodes_.at(kMiddle)[2] + 6, 0.01);
}

TEST_F(PenTest, what_ends_a_grab_early_leaves_no_edit) {
  station_->select_middle();
  const auto begin = [&] { return take(kMiddle) && pull(kMiddle, {0, 3, 0}); };
  with_pen([&] {
    if (!begin()) return false;
    station_->key("Escape");
    if (!said("drag cancelled")) return false;
    device_->move_to(place_.to_pen(nodes_.at(kMiddle)));  // the button is still down: nothing is taken
    device_->buttons(0);
    return true;
  });
  with_pen([&] {
    if (!begin()) return false;
    kill_pen();
    EXPECT_FALSE(kiosk().wait_for("drag cancelled").empty());
    return true;
  });
  with_pen([&] {
    if (!begin()) return false;
    device_->unplug();
    const bool cancelled = said("drag cancelled");
    device_->buttons(0);
    device_->plug_in();
    return cancelled && said("pen state disarmed");
  });
  with_pen([&] {
    if (!begin()) return false;
    station_->kill_model_server();
    EXPECT_FALSE(kiosk().wait_for("drag lost").empty());
    device_->buttons(0);
    station_->start_model_server();
    return placed() && said("pen feels");
  });
  EXPECT_EQ(moves_in(edits()), 0u);
  EXPECT_EQ(station_->save_copy("untouched.k"), original_);
  with_pen([&] { return begin() && release(); });
  EXPECT_EQ(moves_in(edits()), 1u) << "all is well again";
}

TEST_F(PenTest, an_armed_pen_marks_the_shell_that_it_touches_and_takes_its_nearest_node) {
  const Point outward = sheet_normal(nodes_.at(kMiddle));
  with_pen([&] {
    const Vector3d node = place_.to_pen(nodes_.at(kMiddle)), normal = place_.turn * Vector3d(outward.data());
    bool touches = false;
    // On a busy machine the pen may latch between two steps.
    for (int tries = 0; tries < 20 && !touches; ++tries) {
      device_->move_to(node + 8 * normal);
      if (!pen_->running()) return false;
      if (kiosk().last("pen state ") != "pen state armed") {
        kiosk().skip_lines();
        station_->key("ctrl+shift+p");
        kiosk().wait_until([](const std::string& line) {
          return line.starts_with("pen state ") || line.starts_with("pen refused ") || line.starts_with("pen disconnected");
        });
        if (kiosk().last("pen state ") != "pen state armed") continue;
      }
      device_->move_to(node - 3 * normal);
      touches = kiosk().last("pen tip ").ends_with("touches");
    }
    EXPECT_TRUE(touches) << kiosk().last("pen tip ");
    armed_ = true;
    if (!kiosk().last("reads ").ends_with("none")) station_->key("Escape");  // the notice about the deck
    station_->show_people("pen-touches");
    // Beyond the reach of a press in the air: it is the touched shell's corner that is taken.
    device_->move_to(node - 6 * normal);
    device_->buttons(ScriptedPen::kFirst);
    if (!said("pen takes ") || line_ == "pen takes nothing") return false;  // a field that came late fades, and it lets go
    EXPECT_EQ(line_, "pen takes " + std::to_string(kMiddle));
    device_->move_to(node + 6 * normal);
    return said("drag shown ") && release();
  });
  EXPECT_NEAR((node_now(kMiddle) - Vector3d(nodes_.at(kMiddle).data())).norm(), 12, 0.01);
}

TEST_F(PenTest, without_a_configured_pen_the_model_server_isnt_asked) {
  const std::filesystem::path settings = station_->folder() / "nothing.toml";
  std::ofstream(settings) << "";
  run_pen(settings);
  ASSERT_FALSE(kiosk().wait_for("pen state none").empty());
  station_->key("5");
  ASSERT_FALSE(kiosk().wait_for("aim ").empty());
  kill_pen();
  ASSERT_FALSE(kiosk().wait_for("pen disconnected").empty());
  start_pen();
  ASSERT_FALSE(kiosk().wait_for("pen placed ").empty());
  const std::string said = kiosk().all_output();
  EXPECT_GT(said.find("pen placed "), said.find("pen disconnected")) << "not before there was a pen";
}

}  // namespace
}  // namespace prismesh::test
