#include "tests/station/station.h"

#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/places.h"

namespace prismesh::test {
namespace {

const std::filesystem::path kPrograms = test::programs_folder();
constexpr int kScreenWidth = 1320, kScreenHeight = 880;

constexpr int kFirstWheelButton = 4;

std::string text_of(double value) { return std::to_string(static_cast<long>(std::lround(value))); }

std::size_t word_after(const std::string& line, const std::string& word) {
  const std::size_t at = line.find(word + " ");
  return at == std::string::npos ? std::size_t(-1) : std::stoull(line.substr(at + word.size() + 1));
}

}  // namespace

std::string missing_programs() {
  std::string missing;
  for (const char* program : {"Xvfb", "xdotool", "openbox", "import"})
    if (!program_exists(program)) missing += std::string(missing.empty() ? "" : ", ") + program;
  return missing;
}

VirtualDisplay::VirtualDisplay(const std::filesystem::path& home, int width, int height) {
  // The shell hands file descriptor 1 to the server as the place where it writes its number.
  server_ =
      std::make_unique<Process>(std::vector<std::string>{"Xvfb", "-displayfd", "1", "-screen", "0",
                                                         std::to_string(width) + "x" + std::to_string(height) + "x24", "-nolisten", "tcp"},
                                std::map<std::string, std::string>{});
  const std::string number = server_->wait_for("");
  EXPECT_FALSE(number.empty()) << "Xvfb did not start:\n" << server_->all_output();
  name_ = ":" + number;
  window_manager_ = std::make_unique<Process>(std::vector<std::string>{"openbox", "--sm-disable", "--startup", "echo window-manager-ready"},
                                              std::map<std::string, std::string>{{"DISPLAY", name_}, {"HOME", home.string()}});
  // A window that asks to be mapped while the window manager is starting may be forgotten.
  EXPECT_FALSE(window_manager_->wait_for("window-manager-ready").empty()) << window_manager_->all_output();
}

Station::Station() {
  // Short: a socket's path has 107 bytes at most.
  std::string pattern = (std::filesystem::temp_directory_path() / "station_XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no folder for a station: " + pattern);
  folder_ = pattern;
  std::filesystem::create_directories(folder_ / "run");
  std::filesystem::create_directories(folder_ / "state");
  std::filesystem::permissions(folder_ / "run", std::filesystem::perms::owner_all);
  write_sheet(deck());
  display_ = std::make_unique<VirtualDisplay>(folder_, kScreenWidth, kScreenHeight);
  start_model_server();
}

Station::~Station() {
  if (::testing::Test::HasFailure() && kiosk_) {
    kiosk_->last("");
    std::fprintf(stderr, "--- what the kiosk said ---\n%s--- what the model server said ---\n%s", kiosk_->all_output().c_str(),
                 model_server_->standard_error().c_str());
  }
  if (::testing::Test::HasFailure() && device_daemon_)
    std::fprintf(stderr, "--- what the device daemon said ---\n%s", device_daemon_->standard_error().c_str());
  kiosk_.reset();
  setup_service_.reset();
  device_daemon_.reset();
  model_server_.reset();
  display_.reset();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void Station::start_model_server() {
  model_server_ = std::make_unique<Process>(std::vector<std::string>{(kPrograms / "prismesh-modeld").string()},
                                            std::map<std::string, std::string>{{"RUNTIME_DIRECTORY", (folder_ / "run").string()},
                                                                               {"STATE_DIRECTORY", (folder_ / "state").string()}});
}

void Station::kill_model_server() {
  model_server_->kill(SIGKILL);
  EXPECT_EQ(model_server_->wait_for_exit(), 128 + SIGKILL);
}

void Station::start_device_daemon(const std::string& settings) {
  const std::filesystem::path file = folder_ / "prismesh.toml";
  std::ofstream(file) << settings;
  device_daemon_ = std::make_unique<Process>(std::vector<std::string>{(kPrograms / "prismesh-deviced").string(), "--runtime-dir",
                                                                      (folder_ / "run").string(), "--config", file.string()},
                                             std::map<std::string, std::string>{{"XDG_CONFIG_HOME", (folder_ / "config").string()}});
}

void Station::kill_device_daemon() {
  device_daemon_->kill(SIGKILL);
  EXPECT_EQ(device_daemon_->wait_for_exit(), 128 + SIGKILL);
}

void Station::run_kiosk(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{(kPrograms / "prismesh-kiosk").string(),
                                   "--trace",
                                   "--runtime-dir",
                                   (folder_ / "run").string(),
                                   "--size",
                                   std::to_string(width_) + "x" + std::to_string(height_)};
  command.insert(command.end(), arguments.begin(), arguments.end());
  rectangles_ = false;
  presses_ = releases_ = 0;
  window_.clear();
  pointer_.clear();
  kiosk_ = std::make_unique<Process>(command, std::map<std::string, std::string>{{"DISPLAY", display_->name()},
                                                                                 {"XDG_CONFIG_HOME", (folder_ / "config").string()},
                                                                                 {"XDG_STATE_HOME", (folder_ / "home").string()}});
}

void Station::find_window() {
  // A search ends with nothing when a window goes that it was just looking at, such as the kiosk's before this one.
  for (int tries = 0; tries < 100 && window_.empty(); ++tries) {
    Process search({"xdotool", "search", "--onlyvisible", "--sync", "--name", "^Prismesh$"}, {{"DISPLAY", display_->name()}});
    window_ = search.wait_for("");
    if (search.running()) break;
  }
  ASSERT_FALSE(window_.empty());
  xdotool({"windowfocus", "--sync", window_});
}

void Station::start_kiosk(const std::vector<std::string>& more_arguments) {
  std::vector<std::string> arguments{"--open", deck().string()};
  arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
  run_kiosk(arguments);
  ASSERT_FALSE(kiosk_->wait_for("generation ").empty()) << "the kiosk showed no document\n" << kiosk_->all_output();
  ASSERT_FALSE(kiosk_->wait_until([](const std::string& line) { return line.starts_with("picture ") && !line.ends_with("none"); }).empty());
  find_window();
}

void Station::start_empty_kiosk() {
  kiosk_.reset();
  run_kiosk({});
  ASSERT_FALSE(kiosk_->wait_for("picture ").empty());
  find_window();
}

void Station::start_exhibition(const std::filesystem::path& settings) {
  run_kiosk({"--config", settings.string()});
  ASSERT_FALSE(kiosk_->wait_for("exhibition deck").empty()) << "the exhibition showed no deck\n" << kiosk_->all_output();
  ASSERT_FALSE(kiosk_->wait_until([](const std::string& line) { return line.starts_with("picture ") && !line.ends_with("none"); }).empty());
  find_window();
}

void Station::open_in_another_kiosk(const std::filesystem::path& deck) {
  kiosk_.reset();
  run_kiosk({"--open", deck.string()});
  find_window();
}

void Station::start_calibration(const std::vector<std::string>& more_arguments) {
  std::vector<std::string> arguments{"--calibrate", "--window", "--config", (folder_ / "prismesh.toml").string()};
  arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
  run_kiosk(arguments);
  ASSERT_FALSE(kiosk_->wait_for("calibration 1 ").empty()) << "the calibration didn't begin\n" << kiosk_->all_output();
  find_window();
}

void Station::start_setup_service(const std::filesystem::path& root) {
  const std::filesystem::path socket = folder_ / "run" / "setup.sock";
  setup_service_ =
      std::make_unique<Process>(std::vector<std::string>{"systemd-socket-activate", "--listen=" + socket.string(), "--accept", "--inetd",
                                                         (kPrograms / "prismesh-setup").string(), "--root", root.string()},
                                std::map<std::string, std::string>{});
  for (int tries = 0; tries < 1000 && !std::filesystem::exists(socket); ++tries) ::usleep(10'000);
  ASSERT_TRUE(std::filesystem::exists(socket)) << setup_service_->standard_error();
}

void Station::start_setup(const std::vector<std::string>& more_arguments) {
  kiosk_.reset();
  run_kiosk(more_arguments);
  ASSERT_FALSE(kiosk_->wait_for("setup ").empty()) << "the set-up didn't begin\n" << kiosk_->all_output();
  find_window();
}

void Station::xdotool(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"xdotool"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Process process(command, {{"DISPLAY", display_->name()}});
  EXPECT_EQ(process.wait_for_exit(), 0) << process.standard_error();
}

void Station::move(double x, double y) {
  pointer_ = text_of(x) + " " + text_of(y);
  xdotool({"mousemove", "--window", window_, text_of(x), text_of(y)});
}
void Station::press(int button) {
  ++presses_;
  xdotool({"mousedown", std::to_string(button)});
}
void Station::release(int button) {
  ++releases_;
  xdotool({"mouseup", std::to_string(button)});
}
void Station::click(double x, double y, int button) {
  move(x, y);
  ++presses_;
  if (button < kFirstWheelButton) ++releases_;
  xdotool({"click", std::to_string(button)});
}
void Station::double_click(double x, double y) {
  move(x, y);
  presses_ += 2;
  releases_ += 2;
  xdotool({"click", "--repeat", "2", "--delay", "20", "1"});
}
void Station::drag(double from_x, double from_y, double to_x, double to_y, int button) {
  move(from_x, from_y);
  press(button);
  move((from_x + to_x) / 2, (from_y + to_y) / 2);
  move(to_x, to_y);
  release(button);
}
void Station::drag_rectangle(double from_x, double from_y, double to_x, double to_y) {
  if (!std::exchange(rectangles_, true)) key("l");
  drag(from_x, from_y, to_x, to_y);
}
void Station::destroy_window() { xdotool({"windowclose", window_}); }
void Station::resize_window(int width, int height) { xdotool({"windowsize", window_, std::to_string(width), std::to_string(height)}); }
void Station::key(const std::string& keys) { xdotool({"key", keys}); }
void Station::type(const std::string& text) { xdotool({"type", "--delay", "2", text}); }

Station::Aim Station::aim_from(const std::string& said) {
  std::stringstream line(said);
  std::string word;
  Aim aim;
  line >> word >> aim.width >> aim.height;
  for (double& value : aim.m) line >> value;
  EXPECT_TRUE(line) << "the kiosk has not said how it projects";
  return aim;
}

Station::Aim Station::settled_aim() {
  const std::string rest = "rests presses " + std::to_string(presses_) + " releases " + std::to_string(releases_) + " pointer ";
  const auto rests = [&](const std::string& line) { return pointer_.empty() ? line.starts_with(rest) : line == rest + pointer_; };
  // What is said last is waited for, whether it has been passed over or not.
  if (!rests(kiosk_->last(""))) {
    EXPECT_FALSE(kiosk_->wait_until(rests).empty()) << "the kiosk did not come to rest: " << rest << pointer_;
  }
  return aim();
}

Station::Aim Station::aim() { return aim_from(kiosk_->last("aim ")); }

std::optional<Station::Item> Station::item(const std::string& name) {
  const std::string beginning = "item \"" + name + "\" ";
  std::stringstream line(kiosk_->last(beginning).substr(std::min(beginning.size(), kiosk_->last(beginning).size())));
  Item item;
  line >> item.x >> item.y >> item.width >> item.height;
  if (!line) return std::nullopt;
  std::getline(line >> std::ws, item.state);
  return item;
}

void Station::click_item(const std::string& name) {
  const std::optional<Item> found = item(name);
  ASSERT_TRUE(found) << "there is no " << name << " on the screen\n" << kiosk_->all_output();
  click(found->middle()[0], found->middle()[1]);
}

std::array<double, 2> Station::Aim::pixel_of(const Point& point) const {
  const auto row = [&](std::size_t r) { return m[r] * point[0] + m[4 + r] * point[1] + m[8 + r] * point[2] + m[12 + r]; };
  return {(row(0) / row(3) + 1) / 2 * width, (1 - row(1) / row(3)) / 2 * height};
}

bool Station::wait_for_selection(std::size_t selected) {
  const std::string line = kiosk_->wait_until(
      [&](const std::string& said) { return said.starts_with("generation ") && word_after(said, "selected") == selected; });
  if (line.empty()) return false;
  return !kiosk_->wait_for("picture ").empty();
}

std::optional<Station::Handle> Station::handle() {
  std::stringstream line(kiosk_->last("handle "));
  std::string word;
  Handle handle;
  line >> word >> handle.foot_x >> handle.foot_y >> handle.tip_x >> handle.tip_y;
  return line ? std::optional(handle) : std::nullopt;
}

std::string Station::save_copy(const std::string& name) {
  const std::filesystem::path target = folder_ / name;
  kiosk_->skip_lines();
  key("ctrl+shift+c");
  key("ctrl+a");
  type(target.string());
  key("Return");
  EXPECT_FALSE(kiosk_->wait_for("saved ").empty()) << "nothing was saved";
  return whole_file(target);
}

std::vector<std::int64_t> Station::select_middle() {
  const std::map<std::int64_t, Point> nodes = nodes_of_deck(whole_file(deck()));
  const int middle = kSheetSide / 2;
  const std::array<double, 2> centre = pixel_of(nodes.at(kFirstNode + middle * kSheetSide + middle));
  const double half_width = 70, half_height = 50;
  std::vector<std::int64_t> inside;
  for (const auto& [id, point] : nodes) {
    const std::array<double, 2> pixel = pixel_of(point);
    if (std::abs(pixel[0] - std::round(centre[0])) < half_width && std::abs(pixel[1] - std::round(centre[1])) < half_height)
      inside.push_back(id);
  }
  kiosk_->skip_lines();
  const double x = std::round(centre[0]), y = std::round(centre[1]);
  drag_rectangle(x - half_width, y - half_height, x + half_width, y + half_height);
  EXPECT_GT(inside.size(), 20u);
  EXPECT_TRUE(wait_for_selection(inside.size())) << "expected " << inside.size() << " selected nodes, got: " << kiosk_->last("generation ");
  return inside;
}

void Station::pull_arrow(double pixels) {
  const std::optional<Handle> at = handle();
  ASSERT_TRUE(at.has_value()) << "there is no handle";
  const double length = std::hypot(at->tip_x - at->foot_x, at->tip_y - at->foot_y);
  ASSERT_GT(length, 40) << "the arrow is too short to be followed";
  const double x = (at->tip_x - at->foot_x) / length, y = (at->tip_y - at->foot_y) / length;
  kiosk_->skip_lines();
  move(at->tip_x, at->tip_y);
  press();
  for (const double part : {0.25, 0.5, 0.75, 1.0}) move(at->tip_x + part * pixels * x, at->tip_y + part * pixels * y);
  ASSERT_FALSE(kiosk_->wait_for("drag begun").empty());
  ASSERT_FALSE(kiosk_->wait_for("drag shown").empty());
}

void Station::screenshot(const std::filesystem::path& file) {
  Process process({"import", "-window", "root", file.string()}, {{"DISPLAY", display_->name()}});
  process.wait_for_exit();
}

void Station::show_people(const std::string& name) {
  const char* folder = std::getenv("PRISMESH_STATION_PICTURES");  // NOLINT(concurrency-mt-unsafe): tests don't set it
  if (folder != nullptr) screenshot(std::filesystem::path(folder) / (name + ".png"));
}

Station::Pixels Station::window_pixels() {
  const std::filesystem::path file = folder_ / "window.ppm";
  Process process({"import", "-window", window_, "-depth", "8", file.string()}, {{"DISPLAY", display_->name()}});
  EXPECT_EQ(process.wait_for_exit(), 0) << process.standard_error();
  std::ifstream picture(file, std::ios::binary);
  std::string magic;
  int most = 0;
  Pixels pixels;
  picture >> magic >> pixels.width >> pixels.height >> most;
  picture.get();
  pixels.rgb.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height) * 3);
  picture.read(pixels.rgb.data(), static_cast<std::streamsize>(pixels.rgb.size()));
  EXPECT_TRUE(picture && magic == "P6" && most == 255) << "no screenshot";
  return pixels;
}

}  // namespace prismesh::test
