// deviced as a program, with simulated devices behind real pseudo-terminals and clients on a real socket.
#include <stdlib.h>

#include <csignal>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "drivers/eye_tracker/opentrack/datagram.h"
#include "drivers/port/udp_port.h"
#include "ipc/device/client.h"
#include "ipc/wire/line_socket.h"
#include "ipc/wire/server.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::deviced {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using drivers::prism_servo::MaskPhase;
using ipc::EyesPhase;
using test::kPatience;
using test::Process;

constexpr const char* kBoth =
    "[eye_tracker]\ndriver = \"dynasight\"\nsimulated = true\nmotion = \"still\"\n"
    "[prism_servo]\ndriver = \"dynamixel\"\nsimulated = true\n";

class Deviced : public ::testing::Test {
 protected:
  Deviced() {
    std::string name = (fs::temp_directory_path() / "prismesh-deviced-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    configure(kBoth);
  }
  ~Deviced() override {
    daemon_.reset();
    std::error_code problem;
    fs::remove_all(folder_, problem);
  }

  fs::path config() const { return folder_ / "prismesh.toml"; }
  fs::path socket() const { return folder_ / "run" / "deviced.sock"; }
  void configure(const std::string& text) const { std::ofstream(config()) << text; }
  /// Keeps the user's own settings out of the tests.
  std::map<std::string, std::string> surroundings() const { return {{"XDG_CONFIG_HOME", folder_.string()}}; }

  void start() {
    daemon_ = std::make_unique<Process>(
        std::vector<std::string>{program("prismesh-deviced"), "--runtime-dir", (folder_ / "run").string(), "--config", config().string()},
        surroundings());
  }
  static std::string program(const std::string& name) { return (test::programs_folder() / name).string(); }

  struct Ran {
    int status = 0;
    std::string out;
    std::string err;
  };
  Ran devices(const std::vector<std::string>& arguments = {}) const {
    std::vector<std::string> command{program("prismesh"), "devices", "--runtime-dir", (folder_ / "run").string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    Process process(command, {});
    Ran ran;
    ran.status = process.wait_for_exit();
    ran.out = process.all_output();
    ran.err = process.standard_error();
    return ran;
  }

  ipc::DeviceClient connect(const std::string& program) {
    ipc::ReconnectingDeviceClient connection(socket(), program);
    EXPECT_TRUE(connection.wait(kPatience)) << daemon_->standard_error();
    return ipc::DeviceClient::connect(socket(), program).value();
  }

  static bool wait_for(const std::function<bool()>& so) {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (!so()) {
      if (std::chrono::steady_clock::now() > until) return false;
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  static bool at_work(const ipc::DevicePageReader& page) {
    const auto eyes = page.eyes();
    const auto mask = page.prism();
    return eyes && mask && eyes->phase == EyesPhase::tracking && mask->phase == MaskPhase::following && mask->stereo_allowed;
  }
  static std::string refusal(const Result<ipc::DeviceAnswer>& answer) { return answer ? "accepted" : answer.error().text(); }
  static ipc::Devices listed(ipc::DeviceClient& client) {
    return std::get<ipc::Devices>(client.call(ipc::GetDevices{}, kPatience).value());
  }

  fs::path folder_;
  std::unique_ptr<Process> daemon_;
};

TEST_F(Deviced, reads_simulated_devices_through_real_pseudo_terminals) {
  start();
  ipc::DeviceClient client = connect("test");
  ASSERT_TRUE(wait_for([&] { return at_work(client.page()); })) << daemon_->standard_error();
  const ipc::EyesState eyes = *client.page().eyes();
  EXPECT_NEAR(eyes.between_eyes_mm[2], 650, 60);
  EXPECT_GT(eyes.records, 0u);
  EXPECT_TRUE(wait_for([&] { return client.page().health()->ticks > 300; }));
  EXPECT_TRUE(client.page().health()->simulated);
  EXPECT_EQ(client.page().health()->pid, daemon_->pid());

  const ipc::Devices devices = listed(client);
  EXPECT_EQ(devices.profile, "prism-mask");
  ASSERT_EQ(devices.devices.size(), 2u);
  EXPECT_EQ(devices.devices[0].kind, "dynasight");
  EXPECT_EQ(devices.devices[0].where.substr(0, 9), "/dev/pts/");
  EXPECT_EQ(devices.devices[1].kind, "dynamixel");
  EXPECT_TRUE(devices.devices[1].simulated);
}

TEST_F(Deviced, reads_a_webcams_poses_from_loopback) {
  // A port number that other programs on this machine probably don't use.
  const std::string port = std::to_string(20000 + ::getpid() % 20000);
  configure("[eye_tracker]\ndriver = \"opentrack\"\nsimulated = true\nudp_port = " + port + "\n");
  start();
  ipc::DeviceClient client = connect("test");
  EXPECT_TRUE(wait_for([&] { return client.page().eyes() && client.page().eyes()->phase == EyesPhase::tracking; }))
      << daemon_->standard_error();
  ASSERT_EQ(listed(client).devices.size(), 1u);
  EXPECT_EQ(listed(client).devices[0].where, "127.0.0.1:" + port);
  EXPECT_NE(refusal(client.call(ipc::HoldMask{0}, kPatience)).find("no prism servo is configured"), std::string::npos);
}

TEST_F(Deviced, one_client_holds_the_mask_until_it_ends) {
  start();
  auto first = std::make_unique<ipc::DeviceClient>(connect("wizard"));
  ipc::DeviceClient second = connect("other");
  ASSERT_TRUE(wait_for([&] { return at_work(second.page()); })) << daemon_->standard_error();
  EXPECT_NE(refusal(first->call(ipc::HoldMask{7}, kPatience)).find("from -2 to 2, not 7"), std::string::npos);
  EXPECT_EQ(refusal(first->call(ipc::HoldMask{0.5}, kPatience)), "accepted");
  EXPECT_NE(refusal(second.call(ipc::HoldMask{0.1}, kPatience)).find("held by wizard"), std::string::npos);
  EXPECT_NE(refusal(second.call(ipc::ReleaseMask{}, kPatience)).find("isn't held by this client"), std::string::npos);
  const auto held_at = [&](double mm) {
    const auto mask = second.page().prism();
    return mask->phase == MaskPhase::held && std::abs(mask->position_mm - mm) < 0.05;
  };
  EXPECT_TRUE(wait_for([&] { return held_at(0.5); }));
  EXPECT_EQ(refusal(first->call(ipc::HoldMask{-0.5}, kPatience)), "accepted") << "the holder may go on";
  EXPECT_TRUE(wait_for([&] { return held_at(-0.5); }));
  configure(std::string(kBoth) + "travel_mm = 1.5\n");
  EXPECT_EQ(refusal(second.call(ipc::Reload{}, kPatience)), "accepted");
  EXPECT_TRUE(wait_for([&] { return held_at(-0.5); })) << "a station that was started anew holds it too";
  first.reset();  // ends it
  EXPECT_TRUE(wait_for([&] { return at_work(second.page()); })) << "the mask follows again";
  EXPECT_EQ(refusal(second.call(ipc::HoldMask{0.1}, kPatience)), "accepted");
  EXPECT_EQ(refusal(second.call(ipc::ReleaseMask{}, kPatience)), "accepted");
  EXPECT_EQ(refusal(second.call(ipc::Rearm{}, kPatience)), "accepted");
  EXPECT_TRUE(second.send(ipc::PictureShown{false}));
  EXPECT_TRUE(wait_for([&] { return at_work(second.page()); }));
}

TEST_F(Deviced, reads_the_settings_again_on_request) {
  start();
  ipc::DeviceClient client = connect("test");
  ASSERT_TRUE(wait_for([&] { return at_work(client.page()); })) << daemon_->standard_error();

  configure(std::string(kBoth) + "[display]\nprofile = \"no-such-profile\"\n");
  EXPECT_NE(refusal(client.call(ipc::Reload{}, kPatience)).find("no-such-profile"), std::string::npos);
  EXPECT_TRUE(wait_for([&] { return at_work(client.page()); })) << "the working settings stay";

  configure(std::string(kBoth) + "[display]\nprofile = \"prism-mask-columns\"\n");
  const std::uint64_t lost = client.page().eyes()->times_lost;
  EXPECT_EQ(refusal(client.call(ipc::Reload{}, kPatience)), "accepted");
  EXPECT_EQ(listed(client).profile, "prism-mask-columns");
  EXPECT_EQ(client.page().eyes()->times_lost, lost) << "another display needs no other devices";

  configure("[eye_tracker]\ndriver = \"none\"\n");
  EXPECT_EQ(refusal(client.call(ipc::Reload{}, kPatience)), "accepted");
  EXPECT_TRUE(listed(client).devices.empty());
  EXPECT_TRUE(wait_for([&] { return client.page().eyes()->phase == EyesPhase::none; })) << "on the same page";
  EXPECT_TRUE(client.poll());
}

TEST_F(Deviced, reports_changes_to_clients) {
  configure("[eye_tracker]\ndriver = \"dynasight\"\nport = \"" + (folder_ / "not-there").string() + "\"\n");
  start();
  ipc::DeviceClient client = connect("test");
  std::optional<ipc::DeviceEvent> event;
  ASSERT_TRUE(wait_for([&] { return !client.poll() || (event = client.next_event()); })) << daemon_->standard_error();
  ASSERT_TRUE(event);
  const ipc::DeviceInfo& device = std::get<ipc::DeviceChanged>(*event).device;
  EXPECT_EQ(device.state, "absent");
  EXPECT_NE(device.trouble.find("not-there"), std::string::npos) << device.trouble;
}

TEST_F(Deviced, refuses_invalid_messages_with_a_sentence) {
  start();
  const ipc::DeviceClient client = connect("test");
  ipc::LineSocket raw(ipc::connect_to(socket()).value(), {});
  const auto say = [&](std::string line) {
    raw.queue(std::move(line));
    (void)raw.flush();
    std::string said;
    wait_for([&] {
      const Result<bool> received = raw.receive();
      if (const auto next = raw.next_line()) said = *next;
      return !said.empty() || !received;
    });
    return said;
  };
  EXPECT_NE(say("{").find("it isn't JSON"), std::string::npos);
  EXPECT_NE(say(R"({"request": "hold_mask", "number": 3, "position": 1})").find("position_mm"), std::string::npos);
  EXPECT_NE(say(R"({"request": "get_devices", "number": 4})").find("hello"), std::string::npos) << "greet first";
  EXPECT_FALSE(raw.receive() && raw.receive()) << "and is cut off";
  ipc::LineSocket old(ipc::connect_to(socket()).value(), {});
  raw = std::move(old);
  EXPECT_NE(say(R"({"request": "hello", "number": 1, "protocol": 99, "program": "old"})").find("old protocol 99"), std::string::npos);
}

TEST_F(Deviced, clients_notice_a_killed_daemon_and_find_its_successors_page) {
  start();
  ipc::ReconnectingDeviceClient connection(socket(), "test");
  ipc::DeviceClient* client = connection.wait(kPatience).value();
  ASSERT_TRUE(wait_for([&] { return at_work(client->page()); })) << daemon_->standard_error();
  for (int life = 0; life < 3; ++life) {
    const std::int64_t pid = client->page().health()->pid;
    daemon_->kill(SIGKILL);
    daemon_->wait_for_exit();
    Error why;
    ASSERT_TRUE(wait_for([&] {
      const Result<void> polled = client->poll();
      if (!polled) why = polled.error();
      return !polled;
    }));
    EXPECT_NE(why.message.find("the device daemon is gone"), std::string::npos) << why.message;
    MonotonicClock clock;
    EXPECT_EQ(client->page().health()->pid, pid) << "the old page can still be read";
    connection.lost(why);
    EXPECT_EQ(connection.client(), nullptr);
    const std::int64_t from = clock.now_ns();
    start();
    const Result<ipc::DeviceClient*> again = connection.wait(kPatience);
    ASSERT_TRUE(again) << again.error().text();
    client = *again;
    ASSERT_TRUE(wait_for([&] { return client->page().health().has_value(); }));
    EXPECT_NE(client->page().health()->pid, pid);
    ASSERT_TRUE(wait_for([&] { return at_work(client->page()); })) << daemon_->standard_error();
    // Reported only, not checked, because the duration also depends on the machine.
    std::printf("connected and at work %lld ms after the start\n", static_cast<long long>((clock.now_ns() - from) / 1'000'000));
  }
  EXPECT_EQ(connection.connections(), 4u);
}

TEST_F(Deviced, follows_a_tracker_with_a_long_latency) {
  configure("[eye_tracker]\ndriver = \"dynasight\"\nsimulated = true\nmotion = \"still\"\nlatency_ms = 150\n");
  start();
  const ipc::DeviceClient client = connect("test");
  ASSERT_TRUE(wait_for([&] { return client.page().eyes() && client.page().eyes()->phase == EyesPhase::tracking; }))
      << daemon_->standard_error();
  EXPECT_GE(client.page().eyes()->time_ns - client.page().eyes()->measured_ns, 150'000'000);
}

TEST_F(Deviced, a_frozen_mask_waits_for_the_clients_that_show_stereo) {
  const auto port = static_cast<std::uint16_t>(20000 + ::getpid() % 20000);
  const std::string both = "[eye_tracker]\ndriver = \"opentrack\"\nudp_port = " + std::to_string(port) +
                           "\n[prism_servo]\ndriver = \"dynamixel\"\nsimulated = true\n";
  configure(both);
  start();
  ipc::DeviceClient client = connect("test");
  const auto head = drivers::port::UdpSender::open(port).value();
  int sent = 0;
  /// Time for which the mask stood still after the head was lost, by the daemon's clock.
  const auto frozen_ns = [&]() -> std::int64_t {
    EXPECT_TRUE(wait_for([&] {
      const Eigen::Vector3d place(0, 0, 650 + 0.01 * (++sent % 7));
      head->send(drivers::eye_tracker::opentrack::encode(drivers::eye_tracker::opentrack::pose_for(place, Eigen::Vector3d::UnitX())));
      std::this_thread::sleep_for(5ms);
      return at_work(client.page());
    })) << daemon_->standard_error();
    std::int64_t followed_ns = 0, parked_ns = 0;
    EXPECT_TRUE(wait_for([&] {
      const ipc::PrismState mask = *client.page().prism();
      if (mask.phase == MaskPhase::following) followed_ns = mask.time_ns;
      if (mask.phase == MaskPhase::parking || mask.phase == MaskPhase::parked) parked_ns = mask.time_ns;
      return parked_ns != 0;
    }));
    return parked_ns - followed_ns;
  };
  {
    ipc::DeviceClient viewer = connect("viewer");
    ASSERT_TRUE(viewer.send(ipc::PictureShown{false}));
    listed(viewer);
    EXPECT_GE(frozen_ns(), 240'000'000) << "it may still be looked at";
    configure(both + "travel_mm = 1.5\n");
    EXPECT_EQ(refusal(client.call(ipc::Reload{}, kPatience)), "accepted");
    EXPECT_GE(frozen_ns(), 240'000'000) << "so it may with a station that was started anew";
    ASSERT_TRUE(viewer.send(ipc::PictureShown{true}));
    listed(viewer);
  }
  // A busy machine delays any one of them; a daemon that waits delays all of them.
  const auto at_once = [&] {
    for (int attempt = 0; attempt < 5; ++attempt)
      if (frozen_ns() < 200'000'000) return true;
    return false;
  };
  EXPECT_TRUE(at_once()) << "the picture was mono";
  {
    ipc::DeviceClient viewer = connect("viewer");
    ASSERT_TRUE(viewer.send(ipc::PictureShown{false}));
    listed(viewer);
  }
  EXPECT_TRUE(at_once()) << "who showed it has gone";
}

TEST_F(Deviced, endless_requests_of_a_client_fill_no_memory) {
#if defined(PRISMESH_ADDRESS_SANITIZER) || defined(PRISMESH_THREAD_SANITIZER)
  GTEST_SKIP() << "a sanitizer keeps what was freed";
#endif
  start();
  const ipc::DeviceClient quiet = connect("test");
  ASSERT_TRUE(wait_for([&] { return at_work(quiet.page()); })) << daemon_->standard_error();
  const auto resident_kib = [&] {
    std::ifstream status("/proc/" + std::to_string(daemon_->pid()) + "/status");
    for (std::string word; status >> word;)
      if (word == "VmRSS:") {
        long kib = 0;
        status >> kib;
        return kib;
      }
    return 0L;
  };
  const long before = resident_kib();
  ASSERT_GT(before, 0);
  ipc::DeviceClient flood = connect("flood");
  for (int i = 0; i < 200'000; ++i) ASSERT_TRUE(flood.send(ipc::PictureShown{i % 2 == 0}));
  EXPECT_LT(resident_kib() - before, 8 * 1024);
  EXPECT_EQ(listed(flood).devices.size(), 2u);
}

TEST_F(Deviced, a_closing_terminal_ends_it_cleanly) {
  start();
  const ipc::DeviceClient client = connect("test");
  ASSERT_TRUE(wait_for([&] { return at_work(client.page()); })) << daemon_->standard_error();
  daemon_->kill(SIGHUP);
  EXPECT_EQ(daemon_->wait_for_exit(), 0) << daemon_->standard_error();
  EXPECT_EQ(client.page().prism()->phase, MaskPhase::absent);
}

TEST_F(Deviced, started_with_nohup_it_outlives_its_terminal) {
  daemon_ = std::make_unique<Process>(std::vector<std::string>{"nohup", program("prismesh-deviced"), "--runtime-dir",
                                                               (folder_ / "run").string(), "--config", config().string()},
                                      surroundings());
  ipc::DeviceClient client = connect("test");
  daemon_->kill(SIGHUP);
  for (int i = 0; i < 5; ++i) ASSERT_EQ(listed(client).devices.size(), 2u);
  EXPECT_TRUE(daemon_->running());
}

TEST_F(Deviced, when_it_ends_the_page_reports_unknown_eyes_and_mask) {
  start();
  const ipc::DeviceClient client = connect("test");
  ASSERT_TRUE(wait_for([&] { return at_work(client.page()); })) << daemon_->standard_error();
  daemon_->kill(SIGTERM);
  EXPECT_EQ(daemon_->wait_for_exit(), 0) << daemon_->standard_error();
  EXPECT_EQ(client.page().eyes()->phase, EyesPhase::absent);
  EXPECT_EQ(client.page().prism()->phase, MaskPhase::absent);
  EXPECT_FALSE(client.page().prism()->stereo_allowed);
  EXPECT_FALSE(fs::exists(socket()));
}

TEST_F(Deviced, reports_wrong_use_and_wrong_settings) {
  Process wrong({program("prismesh-deviced"), "--runtime"}, {});
  EXPECT_EQ(wrong.wait_for_exit(), 2);
  EXPECT_NE(wrong.standard_error().find("--runtime is no option of prismesh-deviced\nusage: prismesh-deviced"), std::string::npos);

  configure("[eye_tracker]\ndriver = \"dynasite\"\n");
  start();
  EXPECT_EQ(daemon_->wait_for_exit(), 1);
  EXPECT_NE(daemon_->standard_error().find("prismesh.toml:2"), std::string::npos) << daemon_->standard_error();
  EXPECT_NE(daemon_->standard_error().find("dynasight"), std::string::npos) << daemon_->standard_error();

  configure(kBoth);
  start();
  const ipc::DeviceClient client = connect("test");
  Process second({program("prismesh-deviced"), "--runtime-dir", (folder_ / "run").string(), "--config", config().string()}, surroundings());
  EXPECT_EQ(second.wait_for_exit(), 1);
  EXPECT_NE(second.standard_error().find("already runs here"), std::string::npos) << second.standard_error();
}

TEST_F(Deviced, the_command_line_shows_the_devices) {
  Ran ran = devices();
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.err.find("start the device daemon with"), std::string::npos) << ran.err;
  start();
  const ipc::DeviceClient client = connect("test");
  // On a busy machine the simulated devices are slow, so poll until both work.
  const auto shows = [&](std::string_view text) { return ran.out.find(text) != std::string::npos; };
  EXPECT_TRUE(wait_for([&] {
    ran = devices();
    return shows("eye tracker: tracking (dynasight, simulated, /dev/pts/") && shows("prism servo: following");
  })) << ran.out
      << daemon_->standard_error();
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("us of CPU a tick"), std::string::npos) << ran.out;
  ran = devices({"--json", "--rearm", "--reload"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), '\n'), 1);
  EXPECT_NE(ran.out.find("\"kind\":\"dynamixel\""), std::string::npos) << ran.out;

  configure("[eye_tracker]\ndriver = \"none\"\n");
  ran = devices({"--reload"});
  EXPECT_NE(ran.out.find("no device is configured"), std::string::npos) << ran.out;
  ran = devices({"--rearm"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.err.find("no prism servo is configured"), std::string::npos) << ran.err;

  Process watching({program("prismesh"), "devices", "--json", "--watch", "--runtime-dir", (folder_ / "run").string()}, {});
  EXPECT_NE(watching.wait_for("{"), "");
  EXPECT_NE(watching.wait_for("{"), "") << "again after a second";
  watching.kill(SIGINT);
  EXPECT_EQ(watching.wait_for_exit(), 0);
}

TEST_F(Deviced, clients_that_never_greet_block_no_other_client) {
  start();
  ipc::DeviceClient first = connect("first");
  std::vector<ipc::Descriptor> silent;
  for (std::size_t i = 0; i < ipc::ServerLimits{}.clients; ++i) silent.push_back(ipc::connect_to(socket()).value());
  ipc::DeviceClient last = connect("last");  // behind all of them
  EXPECT_TRUE(last.call(ipc::GetDevices{}, kPatience));
  const auto answer = first.call(ipc::GetDevices{}, kPatience);
  EXPECT_TRUE(answer) << answer.error().text();
}

}  // namespace
}  // namespace prismesh::deviced
