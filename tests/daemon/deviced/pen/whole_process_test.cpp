// The pen's process as a program, on a line whose device is in the test: killed, stopped, starved, unplugged, without its guard. The order
// of the frames that the device saw is asserted; times depend on the machine and are reported.
#include <sched.h>
#include <stdlib.h>
#include <sys/mman.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "ipc/pen/client.h"
#include "ipc/pen/haptic_field_page.h"
#include "tests/daemon/deviced/pen/pen_line.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::deviced::pen {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using drivers::haptics::SafetyFault;
using ipc::PenStage;
using test::kPatience;
using test::Process;

/// Moves fast enough that damping is felt: 60 mN.
drivers::haptic_pen::SimulatedHand swinging(double seconds) {
  drivers::haptic_pen::SimulatedHand hand;
  hand.goal_mm = {20 * std::sin(9 * seconds), 0, 20 * std::cos(9 * seconds)};
  return hand;
}

void report(const char* what, double ms) { std::printf("reported: %s: %.1f ms\n", what, ms); }
double ms(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

class PenProcess : public ::testing::Test {
 protected:
  PenProcess() {
    std::string name = (fs::temp_directory_path() / "prismesh-pen-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    std::ofstream(folder_ / "prismesh.toml") << "[haptic_pen]\ndriver = \"simulated\"\nport = \"" << (folder_ / "pen").string() << "\"\n";
    line_ = std::make_unique<PenLine>(folder_ / "pen", swinging);
  }
  ~PenProcess() override {
    client_.reset();
    daemon_.reset();
    line_.reset();
    std::error_code problem;
    fs::remove_all(folder_, problem);
  }

  void start() {
    client_.reset();
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
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  ipc::PenState state() const { return client_->page().state().value_or(ipc::PenState{}); }
  ipc::PenHealth health() const { return client_->page().health().value_or(ipc::PenHealth{}); }
  bool wait_for_stage(PenStage stage) const {
    return wait_for([&] { return state().stage == stage; });
  }

  /// Arms until forces flow: on a busy machine the loop may latch again at once.
  void arm() {
    ASSERT_TRUE(wait_for([&] {
      if (state().stage != PenStage::armed) (void)client_->call(ipc::ArmPen{}, kPatience);
      const std::vector<SeenFrame> seen = line_->seen();
      int forces = 0;
      for (std::size_t i = seen.size() > 50 ? seen.size() - 50 : 0; i < seen.size(); ++i) forces += !seen[i].of_guard() && !seen[i].zero();
      std::this_thread::sleep_for(20ms);
      return forces > 20 && state().stage == PenStage::armed;
    })) << daemon_->standard_error();
  }

  /// Runs the command line; its exit status.
  static int prismesh(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), (test::programs_folder() / "prismesh").string());
    Process program(arguments, std::map<std::string, std::string>{});
    const int status = program.wait_for_exit();
    EXPECT_EQ(program.standard_error(), "");
    return status;
  }

  /// Waits for the guard's first zero after frame `from`; its index.
  std::size_t first_of_guard(std::size_t from) const {
    std::size_t found = 0;
    EXPECT_TRUE(wait_for([&] {
      const std::vector<SeenFrame> seen = line_->seen();
      for (std::size_t i = from; i < seen.size(); ++i)
        if (seen[i].of_guard()) {
          found = i;
          return true;
        }
      return false;
    }));
    return found;
  }

  /// From frame `from` on all are zero; at least `count` of them have come.
  void expect_zeros(std::size_t from, std::size_t count) const {
    EXPECT_TRUE(wait_for([&] { return line_->seen().size() >= from + count; }));
    const std::vector<SeenFrame> seen = line_->seen();
    for (std::size_t i = from; i < seen.size(); ++i) ASSERT_TRUE(seen[i].zero()) << "frame " << i - from << " after the guard's first";
  }

  fs::path folder_;
  std::unique_ptr<PenLine> line_;
  std::unique_ptr<Process> daemon_;
  std::unique_ptr<ipc::PenClient> client_;
};

TEST_F(PenProcess, starts_disarmed_and_sends_forces_only_while_it_is_armed) {
  start();
  ASSERT_TRUE(wait_for_stage(PenStage::disarmed)) << daemon_->standard_error();
  expect_zeros(0, 100);
  arm();
  for (const SeenFrame& each : line_->seen()) EXPECT_LE(each.frame.newton.norm(), 8);
  ASSERT_TRUE(client_->call(ipc::DisarmPen{}, kPatience));
  ASSERT_TRUE(wait_for_stage(PenStage::disarmed));
  std::this_thread::sleep_for(5ms);
  expect_zeros(line_->seen().size(), 50);
  ASSERT_TRUE(wait_for([&] { return health().cpu_p99_ns > 0; }));
  std::printf("reported: CPU of a tick: median %.0f us, 99 of 100 within %.0f us; 99 of 100 late by less than %.0f us\n",
              static_cast<double>(health().cpu_p50_ns) * 1e-3, static_cast<double>(health().cpu_p99_ns) * 1e-3,
              static_cast<double>(health().late_p99_ns) * 1e-3);
}

TEST_F(PenProcess, killed_while_armed_is_followed_by_zeros_and_starts_latched) {
  start();
  arm();
  const std::size_t before = line_->seen().size();
  daemon_->kill(SIGKILL);
  EXPECT_EQ(daemon_->wait_for_exit(), 128 + SIGKILL);
  const std::size_t zero = first_of_guard(before);
  expect_zeros(zero, 20);
  std::vector<SeenFrame> seen = line_->seen();
  for (std::size_t i = zero; i < seen.size(); ++i) EXPECT_TRUE(seen[i].of_guard());
  report("killed: from the last frame of the loop to the first zero", ms(seen[zero].at_ns - seen[zero - 1].at_ns));

  start();
  ASSERT_TRUE(wait_for_stage(PenStage::latched)) << daemon_->standard_error();
  EXPECT_EQ(state().fault, SafetyFault::died_armed);
  ASSERT_TRUE(wait_for([&] { return !line_->seen().back().of_guard(); })) << "the new process has the line";
  expect_zeros(zero, line_->seen().size() - zero + 50);
  arm();
}

TEST_F(PenProcess, stopped_while_armed_is_followed_by_zeros_until_it_is_armed_again) {
  start();
  arm();
  const std::size_t before = line_->seen().size();
  daemon_->kill(SIGSTOP);
  const std::size_t zero = first_of_guard(before);
  expect_zeros(zero, 20);
  const std::vector<SeenFrame> seen = line_->seen();
  for (std::size_t i = zero; i < seen.size(); ++i) EXPECT_TRUE(seen[i].of_guard());
  report("stopped: from the last frame of the loop to the first zero", ms(seen[zero].at_ns - seen[zero - 1].at_ns));
  daemon_->kill(SIGCONT);
  // The guard ends a process that was stopped within its write: then that frame can't come after a zero.
  std::this_thread::sleep_for(20ms);
  if (!daemon_->running()) start();
  ASSERT_TRUE(wait_for_stage(PenStage::latched)) << daemon_->standard_error();
  ASSERT_TRUE(wait_for([&] { return !line_->seen().back().of_guard(); })) << "the loop has the line again";
  expect_zeros(zero, line_->seen().size() - zero + 50);
  arm();
}

/// The thread of a process by its name; 0: none.
pid_t thread_of(pid_t process, const std::string& name) {
  for (const auto& each : fs::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    std::string found;
    std::getline(std::ifstream(each.path() / "comm"), found);
    if (found == name) return static_cast<pid_t>(std::stol(each.path().filename()));
  }
  return 0;
}

TEST_F(PenProcess, starved_by_a_busy_loop_on_its_core_is_followed_by_zeros) {
  start();
  arm();
  const pid_t loop = thread_of(daemon_->pid(), "pen loop");
  ASSERT_GT(loop, 0);
  cpu_set_t first;
  CPU_ZERO(&first);
  CPU_SET(0, &first);
  ASSERT_EQ(::sched_setaffinity(loop, sizeof first, &first), 0);
  // The busy loop has more priority than the pen's loop and less than the guard's; where that isn't allowed, the pen's loop gets the least.
  std::atomic<bool> busy = true, allowed = false, began = false;
  std::thread hog([&] {
    ::sched_setaffinity(0, sizeof first, &first);
    sched_param priority{};
    priority.sched_priority = 42;
    allowed = ::sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
    began = true;
    const auto until = std::chrono::steady_clock::now() + 300ms;
    while (busy && std::chrono::steady_clock::now() < until) {
    }
  });
  while (!began) std::this_thread::yield();
  if (!allowed) {
    const sched_param none{};
    ASSERT_EQ(::sched_setscheduler(loop, SCHED_IDLE, &none), 0);
  }
  const std::size_t before = line_->seen().size();
  const std::size_t zero = first_of_guard(before);
  busy = false;
  hog.join();
  const std::vector<SeenFrame> seen = line_->seen();
  report("starved: from the last frame of the loop to the first zero", ms(seen[zero].at_ns - seen[zero - 1].at_ns));
  std::this_thread::sleep_for(20ms);
  if (!daemon_->running()) start();
  ASSERT_TRUE(wait_for_stage(PenStage::latched)) << daemon_->standard_error();
  if (health().guard_silence_ns > 0) report("starved: silence when the guard took the line", ms(health().guard_silence_ns));
  ASSERT_TRUE(wait_for([&] { return !line_->seen().back().of_guard(); }));
  expect_zeros(zero, line_->seen().size() - zero + 50);
}

TEST_F(PenProcess, unplugged_while_armed_comes_back_latched) {
  start();
  arm();
  line_->unplug();
  const auto began = std::chrono::steady_clock::now();
  ASSERT_TRUE(wait_for_stage(PenStage::latched)) << daemon_->standard_error();
  report("unplugged: until the loop knows", std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count());
  EXPECT_TRUE(state().fault == SafetyFault::io_error || state().fault == SafetyFault::no_pose);
  EXPECT_EQ(state().newton, (std::array<double, 3>{}));
  // What led to it can still be recorded, and the safety runs on it as it did.
  const std::string record = (folder_ / "fault.record").string();
  EXPECT_EQ(prismesh({"devices", "--runtime-dir", (folder_ / "run").string(), "--record", record, "--seconds", "0"}), 0);
  EXPECT_EQ(prismesh({"devices", "--replay", record}), 0);
  const std::size_t before = line_->seen().size();
  line_->plug_in();
  ASSERT_TRUE(wait_for([&] { return line_->seen().size() > before + 50; })) << daemon_->standard_error();
  expect_zeros(before, 50);
  EXPECT_EQ(state().stage, PenStage::latched);
  EXPECT_TRUE(daemon_->running());
  arm();
}

TEST_F(PenProcess, ends_when_its_guard_has_ended) {
  start();
  arm();
  ASSERT_GT(health().guard_pid, 0);
  ASSERT_EQ(::kill(static_cast<pid_t>(health().guard_pid), SIGKILL), 0);
  EXPECT_EQ(daemon_->wait_for_exit(), 71);
  EXPECT_TRUE(line_->seen().back().zero());
  start();
  ASSERT_TRUE(wait_for_stage(PenStage::disarmed)) << "it ended in order, with zero";
}

/// Whether a process has ended, waited for or not.
bool has_ended(std::int64_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("State:")) return line.find('Z') != std::string::npos;
  return true;
}

TEST_F(PenProcess, leaves_no_guard_behind_once_its_line_is_gone_too) {
  start();
  arm();
  const std::int64_t guard = health().guard_pid;
  const std::size_t before = line_->seen().size();
  daemon_->kill(SIGKILL);
  daemon_->wait_for_exit();
  first_of_guard(before);
  EXPECT_FALSE(has_ended(guard)) << "it keeps the device at zero";
  line_->unplug();
  EXPECT_TRUE(wait_for([&] { return has_ended(guard); }));
}

TEST_F(PenProcess, ends_in_order_with_zero_and_starts_disarmed) {
  start();
  arm();
  daemon_->kill(SIGTERM);
  EXPECT_EQ(daemon_->wait_for_exit(), 0) << daemon_->standard_error();
  EXPECT_TRUE(wait_for([&] { return line_->seen().back().of_guard(); })) << "the guard's last zeros";
  EXPECT_TRUE(line_->seen().back().zero());
  start();
  ASSERT_TRUE(wait_for_stage(PenStage::disarmed));
}

TEST_F(PenProcess, a_latch_outlives_restarts_until_it_is_armed) {
  start();
  arm();
  daemon_->kill(SIGKILL);
  daemon_->wait_for_exit();
  for (int restart = 0; restart < 2; ++restart) {
    start();
    ASSERT_TRUE(wait_for_stage(PenStage::latched)) << restart;
    daemon_->kill(restart == 0 ? SIGKILL : SIGTERM);
    daemon_->wait_for_exit();
  }
  start();
  ASSERT_TRUE(wait_for_stage(PenStage::latched));
  arm();
}

TEST_F(PenProcess, serves_without_a_pen) {
  std::ofstream(folder_ / "prismesh.toml") << "";
  start();
  EXPECT_EQ(state().stage, PenStage::none);
  const auto refused = client_->call(ipc::ArmPen{}, kPatience);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("haptic_pen.driver"), std::string::npos) << refused.error().text();
  daemon_->kill(SIGTERM);
  EXPECT_EQ(daemon_->wait_for_exit(), 0);
}

TEST_F(PenProcess, feels_the_shells_of_an_attached_field) {
  start();
  arm();
  auto page = ipc::HapticFieldPage::create();
  ASSERT_TRUE(page);
  // A plane across the motion at x = 10 mm.
  auto field = std::make_unique<HapticField>();
  for (HapticBrick* brick : {&field->fine, &field->coarse}) {
    brick->spacing_mm = 1;
    for (int axis = 0; axis < 3; ++axis) {
      brick->origin_mm[axis] = -31;
      brick->count[axis] = 64;
    }
    for (int i = 0; i < kMaxBrickNodes; ++i) brick->distance_mm[i] = static_cast<float>(std::abs(brick->origin_mm[0] + i % 64 - 10.0));
  }
  field->mesh_generation = 7;
  field->moved_reach_mm = 2;
  MonotonicClock clock;
  const ipc::Descriptor not_sealed(::memfd_create("open", 0));
  EXPECT_FALSE(client_->attach_field(not_sealed, kPatience));
  const auto attached = client_->attach_field(page->descriptor(), kPatience);
  ASSERT_TRUE(attached) << attached.error().text();
  bool touched = false;
  ASSERT_TRUE(wait_for([&] {
    field->time_ns = clock.now_ns();
    page->publish(*field);
    if (state().stage != PenStage::armed) (void)client_->call(ipc::ArmPen{}, kPatience);
    const ipc::PenState now = state();
    touched = touched || (now.stage == PenStage::armed && now.touching && std::abs(now.newton[0]) > 0.5);
    return touched && now.field_generation == 7;
  })) << daemon_->standard_error();
}

}  // namespace
}  // namespace prismesh::deviced::pen
