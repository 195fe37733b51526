// The pen's process as a program with an Inverse3, whose service is in the test.
#include <stdlib.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <fstream>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/pen/client.h"
#include "tests/drivers/haptic_pen/inverse3_service.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::deviced::pen {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using drivers::haptic_pen::inverse3::InverseService;
using drivers::haptic_pen::inverse3::PlayedService;
using ipc::PenStage;
using test::kPatience;
using test::Process;

/// Swings the grip, so that damping is felt, until it goes.
class SwingingGrip {
 public:
  explicit SwingingGrip(InverseService& service) : thread_([this, &service] { swing(service); }) {}
  SwingingGrip(const SwingingGrip&) = delete;
  SwingingGrip& operator=(const SwingingGrip&) = delete;
  ~SwingingGrip() {
    stop_ = true;
    thread_.join();
  }

 private:
  void swing(InverseService& service) const {
    const Eigen::Vector3d middle = PlayedService{}.position_m;
    for (double seconds = 0; !stop_; seconds += 2e-3) {
      service.play([&](PlayedService& s) {
        s.position_m = middle + Eigen::Vector3d(0.02 * std::sin(9 * seconds), 0, 0.02 * std::cos(9 * seconds));
      });
      std::this_thread::sleep_for(2ms);
    }
  }
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

class Inverse3Process : public ::testing::Test {
 protected:
  Inverse3Process() {
    std::string name = (fs::temp_directory_path() / "prismesh-inverse3-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Inverse3Process() override {
    client_.reset();
    daemon_.reset();
    std::error_code problem;
    fs::remove_all(folder_, problem);
  }
  void start(std::uint16_t port) {
    std::ofstream(folder_ / "prismesh.toml") << "[haptic_pen]\ndriver = \"inverse3\"\nservice_port = " << port << "\n";
    daemon_ =
        std::make_unique<Process>(std::vector<std::string>{(test::programs_folder() / "prismesh-deviced").string(), "--only", "pen",
                                                           "--runtime-dir", (folder_ / "run").string(), "--state-dir",
                                                           (folder_ / "state").string(), "--config", (folder_ / "prismesh.toml").string()},
                                  std::map<std::string, std::string>{{"XDG_CONFIG_HOME", folder_.string()}});
    ipc::ReconnectingPenClient connection(ipc::pen_socket_path(folder_ / "run"), "test");
    ASSERT_TRUE(connection.wait(kPatience)) << daemon_->standard_error();
    client_ = std::make_unique<ipc::PenClient>(ipc::PenClient::connect(ipc::pen_socket_path(folder_ / "run"), "test").value());
  }
  static bool wait_for(const std::function<bool()>& so) {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (!so()) {
      if (std::chrono::steady_clock::now() > until) return false;
      std::this_thread::sleep_for(2ms);
    }
    return true;
  }
  PenStage stage() const { return client_->page().state().value_or(ipc::PenState{}).stage; }
  ipc::PenInfo info() const {
    Result<ipc::PenAnswer> answer = client_->call(ipc::GetPen{}, kPatience);
    const auto* pen = answer ? std::get_if<ipc::Pen>(&*answer) : nullptr;
    return pen != nullptr ? pen->pen : ipc::PenInfo{};
  }
  /// Arms until a force reaches the device: on a busy machine the loop may latch again at once.
  bool arms(const InverseService& service) const {
    return wait_for([&] {
      if (stage() != PenStage::armed) (void)client_->call(ipc::ArmPen{}, kPatience);
      std::this_thread::sleep_for(5ms);
      return service.seen().newton.norm() > 0;
    });
  }

  fs::path folder_;
  std::unique_ptr<Process> daemon_;
  std::unique_ptr<ipc::PenClient> client_;
};

TEST_F(Inverse3Process, leads_from_the_service_to_forces_and_ends_with_zero) {
  std::optional<InverseService> service(std::in_place);
  const std::uint16_t port = service->port();
  start(port);
  {
    const SwingingGrip grip(*service);
    ASSERT_TRUE(wait_for([&] { return stage() == PenStage::disarmed; })) << info().trouble << daemon_->standard_error();
    EXPECT_EQ(info().kind, "inverse3");
    EXPECT_FALSE(info().simulated);
    EXPECT_TRUE(service->seen().newton.isZero(0)) << "nobody has armed it";
    ASSERT_TRUE(arms(*service)) << daemon_->standard_error();
    EXPECT_LE(service->seen().longest_newton, 4.0);
    ASSERT_TRUE(client_->call(ipc::DisarmPen{}, kPatience));
    ASSERT_TRUE(wait_for([&] { return stage() != PenStage::armed && service->seen().newton.isZero(0); }));
    ASSERT_TRUE(arms(*service)) << daemon_->standard_error();
  }
  // The service ends and comes back: nothing is felt until somebody arms it.
  service.reset();
  ASSERT_TRUE(wait_for([&] { return stage() == PenStage::latched; })) << info().trouble;
  service.emplace(port);
  {
    const SwingingGrip grip(*service);
    ASSERT_TRUE(wait_for([&] { return service->seen().messages > 50; })) << info().trouble;
    EXPECT_EQ(service->seen().longest_newton, 0.0);
    ASSERT_TRUE(arms(*service)) << info().trouble;
    daemon_->kill(SIGTERM);
    EXPECT_EQ(daemon_->wait_for_exit(), 0) << daemon_->standard_error();
    ASSERT_TRUE(wait_for([&] { return service->seen().newton.isZero(0); }));
  }
  EXPECT_TRUE(service->seen().well_formed);
}

TEST_F(Inverse3Process, a_killed_process_leaves_no_force) {
  InverseService service;
  start(service.port());
  const SwingingGrip grip(service);
  ASSERT_TRUE(wait_for([&] { return stage() == PenStage::disarmed; })) << info().trouble << daemon_->standard_error();
  ASSERT_TRUE(arms(service)) << daemon_->standard_error();
  daemon_->kill(SIGKILL);
  EXPECT_EQ(daemon_->wait_for_exit(), 128 + SIGKILL);
  EXPECT_TRUE(wait_for([&] { return service.seen().newton.isZero(0); })) << "the guard's last word is zero";
}

TEST_F(Inverse3Process, says_what_is_missing) {
  std::uint16_t port = 0;
  {
    const InverseService service;
    port = service.port();
  }
  start(port);
  ASSERT_TRUE(wait_for([&] { return !info().trouble.empty(); }));
  EXPECT_THAT(info().trouble, testing::HasSubstr("service"));
  EXPECT_FALSE(client_->call(ipc::ArmPen{}, kPatience));
}

}  // namespace
}  // namespace prismesh::deviced::pen
