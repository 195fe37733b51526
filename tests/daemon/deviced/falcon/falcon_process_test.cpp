// The pen's process as a program with a Falcon: the real libusb, on a device that umockdev simulates for both.
#include <stdlib.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/haptic_pen/falcon/simulated_falcon.h"
#include "ipc/pen/client.h"
#include "tests/drivers/usb/fake_usb.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::deviced::pen {
namespace {

namespace falcon = drivers::haptic_pen::falcon;
namespace fs = std::filesystem;
using drivers::port::FakeUsb;
using ipc::PenStage;
using test::kPatience;
using test::Process;

/// Passes the marks of all arms again and again.
drivers::haptic_pen::SimulatedHand pumping(double seconds) {
  drivers::haptic_pen::SimulatedHand hand;
  hand.goal_mm = {5 * std::sin(2 * seconds), 0, 38 * std::sin(5 * seconds)};
  return hand;
}

class FalconProcess : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(FakeUsb::possible()) << "run me under umockdev-wrapper"; }
  FalconProcess() {
    std::string name = (fs::temp_directory_path() / "prismesh-falcon-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    std::ofstream(folder_ / "prismesh.toml") << "[haptic_pen]\ndriver = \"falcon\"\nfirmware = \"falcon.bin\"\n";
    write_firmware(falcon::pretended_firmware(1500));
  }
  ~FalconProcess() override {
    client_.reset();
    daemon_.reset();
    std::error_code problem;
    fs::remove_all(folder_, problem);
  }
  void write_firmware(const std::vector<std::byte>& bytes) const {
    std::ofstream(folder_ / "falcon.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  void start() {
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
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  PenStage stage() const { return client_->page().state().value_or(ipc::PenState{}).stage; }
  ipc::PenInfo info() const {
    Result<ipc::PenAnswer> answer = client_->call(ipc::GetPen{}, kPatience);
    const auto* pen = answer ? std::get_if<ipc::Pen>(&*answer) : nullptr;
    return pen != nullptr ? pen->pen : ipc::PenInfo{};
  }
  bool wait_for_trouble(const std::string& part) const {
    return wait_for([&] { return info().trouble.find(part) != std::string::npos; });
  }
  std::vector<falcon::ForcePacket> seen() const {
    const std::lock_guard lock(mutex_);
    return seen_;
  }
  static bool is_zero(const falcon::ForcePacket& packet) { return packet.motors == std::array<std::int16_t, 3>{}; }
  /// Arms until forces flow: on a busy machine the loop may latch again at once.
  void arm() {
    ASSERT_TRUE(wait_for([&] {
      if (stage() != PenStage::armed) (void)client_->call(ipc::ArmPen{}, kPatience);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const std::vector<falcon::ForcePacket> all = seen();
      int forces = 0;
      for (std::size_t i = all.size() > 30 ? all.size() - 30 : 0; i < all.size(); ++i) forces += !is_zero(all[i]);
      return forces > 10;
    })) << daemon_->standard_error();
  }

  fs::path folder_;
  mutable std::mutex mutex_;
  std::vector<falcon::ForcePacket> seen_;
  falcon::SimulatedFalcon device_{{}, pumping, [this](std::int64_t, const falcon::ForcePacket& packet) {
                                    const std::lock_guard lock(mutex_);
                                    seen_.push_back(packet);
                                  }};
  FakeUsb bus_;
  std::unique_ptr<Process> daemon_;
  std::unique_ptr<ipc::PenClient> client_;
};

TEST_F(FalconProcess, leads_from_the_plug_to_forces_and_ends_with_zero) {
  start();
  ASSERT_TRUE(wait_for_trouble("there is no such device")) << info().trouble;
  EXPECT_EQ(info().kind, "falcon");
  EXPECT_FALSE(info().simulated);
  const int number = bus_.plug_in(device_);
  ASSERT_TRUE(wait_for([&] { return stage() == PenStage::disarmed; })) << info().trouble << daemon_->standard_error();
  EXPECT_TRUE(wait_for([&] { return info().trouble.empty(); })) << info().trouble;
  EXPECT_EQ(device_.loaded(), falcon::pretended_firmware(1500));
  EXPECT_THAT(seen(), testing::Each(testing::Truly(is_zero)));
  arm();
  ASSERT_TRUE(client_->call(ipc::DisarmPen{}, kPatience));
  ASSERT_TRUE(wait_for([&] { return stage() != PenStage::armed; }));
  arm();

  bus_.unplug(number);
  ASSERT_TRUE(wait_for([&] { return stage() == PenStage::latched; })) << daemon_->standard_error();
  device_.lose_power();
  const std::size_t before = seen().size();
  bus_.plug_in(device_);
  // It boots and is homed again, and stays latched until somebody arms it.
  ASSERT_TRUE(wait_for([&] { return seen().size() > before + 100 && device_.homed() == falcon::kAllHomed; })) << info().trouble;
  const std::vector<falcon::ForcePacket> all = seen();
  for (std::size_t i = before; i < all.size(); ++i) ASSERT_TRUE(is_zero(all[i]));
  EXPECT_EQ(stage(), PenStage::latched);
  arm();

  daemon_->kill(SIGTERM);
  EXPECT_EQ(daemon_->wait_for_exit(), 0) << daemon_->standard_error();
  EXPECT_TRUE(is_zero(seen().back()));
}

TEST_F(FalconProcess, says_what_is_wrong_and_sends_nothing) {
  std::vector<std::byte> cut = falcon::pretended_firmware(1500);
  cut.resize(1000);
  write_firmware(cut);
  bus_.plug_in(device_);
  start();
  ASSERT_TRUE(wait_for_trouble("isn't a whole Falcon firmware: it ends after 1000 bytes")) << info().trouble;
  const Result<ipc::PenAnswer> refused = client_->call(ipc::ArmPen{}, kPatience);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text(), testing::HasSubstr("isn't a whole Falcon firmware"));
  EXPECT_TRUE(seen().empty());
  // The file is read again at each try.
  write_firmware(falcon::pretended_firmware(1500));
  ASSERT_TRUE(wait_for([&] { return stage() == PenStage::disarmed; })) << info().trouble;
}

TEST_F(FalconProcess, weighs_only_when_it_is_told_to_go_on_and_sends_nothing_before) {
  bus_.plug_in(device_);
  const std::string program = (test::programs_folder() / "prismesh-deviced").string() + " --only pen --state-dir " +
                              (folder_ / "state").string() + " --config " + (folder_ / "prismesh.toml").string();
  const std::map<std::string, std::string> environment{{"XDG_CONFIG_HOME", folder_.string()}};
  Process heavy({"sh", "-c", program + " --weigh 2000 < /dev/null"}, environment);
  EXPECT_EQ(heavy.wait_for_exit(), 1);
  EXPECT_THAT(heavy.standard_error(), testing::HasSubstr("2000 g need 19.61 N"));
  Process no_number({"sh", "-c", program + " --weigh 5kg < /dev/null"}, environment);
  EXPECT_EQ(no_number.wait_for_exit(), 1);
  EXPECT_THAT(no_number.standard_error(), testing::HasSubstr("must be a weight in grams, not 5kg"));
  // The input is open and silent until a file appears, then it ends.
  const std::string quiet = "while [ ! -e " + (folder_ / "end").string() + " ]; do sleep 0.1; done";
  Process weighs({"sh", "-c", "(" + quiet + ") | " + program + " --weigh 100"}, environment);
  EXPECT_FALSE(weighs.wait_for("home it by hand").empty()) << weighs.standard_error();
  ASSERT_FALSE(weighs.wait_for("1. Take everything off the grip").empty()) << weighs.standard_error();
  const std::size_t asked = seen().size();
  ASSERT_TRUE(wait_for([&] { return seen().size() > asked + 200; })) << "it goes on asking for poses";
  std::ofstream(folder_ / "end") << "";
  EXPECT_EQ(weighs.wait_for_exit(), 1);
  EXPECT_THAT(weighs.standard_error(), testing::HasSubstr("the input ended"));
  for (const falcon::ForcePacket& packet : seen()) ASSERT_TRUE(is_zero(packet));
}

}  // namespace
}  // namespace prismesh::deviced::pen
