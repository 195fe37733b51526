// The SpaceMouse devices that are plugged in: finds them, reads them, and adds up what the hands do.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "drivers/port/hid_port.h"
#include "drivers/space_mouse/report.h"
#include "drivers/space_mouse/response.h"
#include "drivers/space_mouse/spnav.h"

namespace prismesh::drivers::space_mouse {

/// Where devices come from; tests put others in.
struct SpaceMouseSources {
  std::function<std::vector<port::HidDevice>()> list;
  /// By path, and the name for sentences.
  std::function<Result<std::unique_ptr<port::HidPort>>(const std::string& path, const std::string& name)> open;
  /// spacenavd's stream. An error: it doesn't run.
  std::function<Result<std::unique_ptr<port::HidPort>>()> connect;
};
/// The kernel's devices, and spacenavd at spnav_socket_path().
SpaceMouseSources system_sources();

/// While spacenavd is connected it is the only source: its devices would count twice. Not thread-safe.
class SpaceMice {
 public:
  static constexpr std::int64_t kLookNs = 1'000'000'000;  ///< between two looks for devices
  static constexpr int kMostReports = 256;                ///< of a device in one turn: one that sends without end holds nothing up

  SpaceMice(Clock& clock, SpaceMouseSources sources, const SpaceMouseResponse& response = {});

  /// Looks for devices when it is time to, and takes what has arrived. Reading never waits. Opening a device that sleeps may take as long
  /// as it needs to wake up.
  void turn();

  /// False: what the hands do counts as rest, and buttons that go down aren't told.
  void listen(bool listens) { listens_ = listens; }
  /// Of all devices together, each axis cut at 1; a device that is gone adds nothing.
  const SpaceMouseMotion& motion() const { return motion_; }
  /// Buttons that went down since the last call, a bit each.
  std::uint64_t take_presses() { return std::exchange(presses_, 0); }
  bool any() const { return !devices_.empty(); }
  /// "SpaceNavigator, SpaceMouse Pro"; "spacenavd"; empty: none.
  std::string names() const;
  /// A device that can't be opened, in a sentence; empty: none. Said at the second try, as a new device's rights come a moment after it.
  const std::string& trouble() const { return trouble_; }
  /// Counts up with each change of names and trouble.
  std::uint64_t changes() const { return changes_; }
  /// For poll(2).
  std::vector<int> descriptors() const;

 private:
  struct Device {
    std::string path;
    std::string name;
    std::unique_ptr<port::HidPort> port;
    bool spnav = false;
    SpnavEvents events{};
    SpaceMouseState state{};
  };

  void look();
  bool connect();
  void open(const port::HidDevice& found, const std::string& name);
  bool read(Device& device);
  void pressed(std::uint64_t before, const SpaceMouseState& now) { presses_ |= now.buttons & ~before; }
  void add_up();

  Clock& clock_;
  SpaceMouseSources sources_;
  SpaceMouseResponse response_;
  std::int64_t next_look_ns_;
  std::vector<Device> devices_;
  std::map<std::string, int> refused_;  ///< how often a path couldn't be opened
  bool listens_ = true;
  SpaceMouseMotion motion_;
  std::uint64_t presses_ = 0;
  std::string trouble_;
  std::uint64_t changes_ = 0;
};

}  // namespace prismesh::drivers::space_mouse
