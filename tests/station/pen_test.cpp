// The haptic pen from end to end: a device in the test, the pen's process, the model server and the kiosk between them.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
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
  Place next_place() { return place_from(kiosk().wait_for("pen placed ")); }

  Process& kiosk() { return station_->kiosk(); }
  void take(std::int64_t node, const Place& place) {
    device_->move_to(place.to_pen(nodes_.at(node)));
    device_->buttons(ScriptedPen::kFirst);
    ASSERT_EQ(kiosk().wait_for("pen takes "), "pen takes " + std::to_string(node)) << kiosk().all_output();
    ASSERT_FALSE(kiosk().wait_for("drag begun ").empty());
  }
  void pull(std::int64_t node, const Place& place, const Vector3d& by_mm) {
    device_->move_to(place.to_pen(nodes_.at(node)) + by_mm);
    ASSERT_FALSE(kiosk().wait_for("drag shown ").empty());
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

  std::unique_ptr<ScriptedPen> device_;
  std::unique_ptr<Process> pen_;
};

TEST_F(PenTest, a_grabbed_node_goes_where_the_pen_takes_it_as_one_edit) {
  station_->select_middle();
  start_pen("workspace_scale = 0.5\n");
  const Place place = next_place();
  EXPECT_EQ(place.scale, 0.5);
  ASSERT_FALSE(kiosk().wait_for("pen feels").empty());
  take(kMiddle, place);
  const Vector3d by_mm(2, 3, 4);
  pull(kMiddle, place, by_mm);
  // What is drawn is where the pen is.
  const Vector3d goal = Vector3d(nodes_.at(kMiddle).data()) + place.turn.conjugate() * by_mm / place.scale;
  const std::array<double, 2> pixel = station_->pixel_of({goal.x(), goal.y(), goal.z()});
  const auto is_there = [&](const std::string& line) {
    std::stringstream words(line);
    std::string pen, tip, how;
    double x = 0, y = 0;
    return words >> pen >> tip >> x >> y >> how && tip == "tip" && how == "holds" && std::hypot(x - pixel[0], y - pixel[1]) < 1;
  };
  if (!is_there(kiosk().last("pen tip "))) {
    EXPECT_FALSE(kiosk().wait_until(is_there).empty()) << kiosk().last("pen tip ") << " instead of " << pixel[0] << " " << pixel[1];
  }
  station_->show_people("pen");
  device_->buttons(0);
  ASSERT_FALSE(kiosk().wait_for("drag committed").empty());
  EXPECT_EQ(moves_in(edits()), 1u);
  EXPECT_LT((node_now(kMiddle) - goal).norm(), 0.01) << node_now(kMiddle).transpose();
}

TEST_F(PenTest, what_isnt_selected_is_moved_with_its_region_and_a_turned_view_goes_with_the_pen) {
  start_pen();
  Place place = next_place();
  station_->key("5");
  place = next_place();
  ASSERT_LT((place.turn * Vector3d::UnitZ() - Vector3d::UnitZ()).norm(), 1e-6) << "from above";
  // The clutch moves the pen's space: the same node is elsewhere then.
  device_->buttons(ScriptedPen::kSecond);
  device_->move_to({0, 0, 15});
  device_->buttons(0);
  const auto moved = [&](const std::string& line) {
    return line.starts_with("pen placed ") && (place_from(line).shift_mm - place.shift_mm - Vector3d(0, 0, 15)).norm() < 0.1;
  };
  const std::string clutched = kiosk().wait_until(moved);
  ASSERT_FALSE(clutched.empty()) << kiosk().last("pen placed ");
  place = place_from(clutched);
  take(kMiddle, place);
  pull(kMiddle, place, {0, 0, 6});
  device_->buttons(0);
  ASSERT_FALSE(kiosk().wait_for("drag committed").empty());
  EXPECT_EQ(edits(), std::vector<std::string>{"move"}) << "no selection was made";
  EXPECT_NEAR(node_now(kMiddle).z(), nodes_.at(kMiddle)[2] + 6, 0.01);
}

TEST_F(PenTest, what_ends_a_grab_early_leaves_no_edit) {
  station_->select_middle();
  start_pen();
  Place place = next_place();
  const auto begin = [&] {
    take(kMiddle, place);
    pull(kMiddle, place, {0, 3, 0});
  };
  begin();
  station_->key("Escape");
  ASSERT_FALSE(kiosk().wait_for("drag cancelled").empty());
  device_->move_to(place.to_pen(nodes_.at(kMiddle)));  // the button is still down: nothing is taken
  device_->buttons(0);

  begin();
  kill_pen();
  ASSERT_FALSE(kiosk().wait_for("drag cancelled").empty());
  device_->buttons(0);
  start_pen();
  place = next_place();
  ASSERT_FALSE(kiosk().wait_for("pen feels").empty());

  begin();
  device_->unplug();
  ASSERT_FALSE(kiosk().wait_for("drag cancelled").empty());
  device_->buttons(0);
  device_->plug_in();
  ASSERT_FALSE(kiosk().wait_for("pen state disarmed").empty());

  begin();
  station_->kill_model_server();
  ASSERT_FALSE(kiosk().wait_for("drag lost").empty());
  device_->buttons(0);
  station_->start_model_server();
  place = next_place();
  ASSERT_FALSE(kiosk().wait_for("pen feels").empty()) << "the new model server's page";
  EXPECT_EQ(moves_in(edits()), 0u);
  EXPECT_EQ(station_->save_copy("untouched.k"), original_);

  // All is well again.
  begin();
  device_->buttons(0);
  ASSERT_FALSE(kiosk().wait_for("drag committed").empty());
  EXPECT_EQ(moves_in(edits()), 1u);
}

TEST_F(PenTest, an_armed_pen_marks_the_shell_that_it_touches_and_takes_its_nearest_node) {
  start_pen();
  const Place place = next_place();
  ASSERT_FALSE(kiosk().wait_for("pen feels").empty());
  const Vector3d node = place.to_pen(nodes_.at(kMiddle));
  const Point outward = sheet_normal(nodes_.at(kMiddle));
  const Vector3d normal = place.turn * Vector3d(outward.data());
  bool touches = false;
  // On a busy machine the pen may latch between two steps.
  for (int tries = 0; tries < 20 && !touches; ++tries) {
    device_->move_to(node + 8 * normal);
    if (kiosk().last("pen state ") != "pen state armed") {
      kiosk().skip_lines();
      station_->key("ctrl+p");
      if (kiosk().wait_until([](const std::string& line) { return line.starts_with("pen state ") || line.starts_with("pen refused "); }) !=
          "pen state armed")
        continue;
    }
    device_->move_to(node - 3 * normal);
    touches = kiosk().last("pen tip ").ends_with("touches");
  }
  ASSERT_TRUE(touches) << kiosk().all_output();
  station_->show_people("pen-touches");
  // Beyond the reach of a press in the air: it is the touched shell's corner that is taken.
  device_->move_to(node - 6 * normal);
  device_->buttons(ScriptedPen::kFirst);
  EXPECT_EQ(kiosk().wait_for("pen takes "), "pen takes " + std::to_string(kMiddle));
  device_->move_to(node + 6 * normal);
  ASSERT_FALSE(kiosk().wait_for("drag shown ").empty());
  device_->buttons(0);
  ASSERT_FALSE(kiosk().wait_for("drag committed").empty());
  EXPECT_NEAR((node_now(kMiddle) - Vector3d(nodes_.at(kMiddle).data())).norm(), 12, 0.01);
  kiosk().skip_lines();
  station_->key("ctrl+p");
  EXPECT_EQ(kiosk().wait_until([](const std::string& line) { return line.starts_with("pen state "); }), "pen state disarmed");
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
