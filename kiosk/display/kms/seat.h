// The seat: the right to use this computer's screen, mouse and keyboard (libseat, which asks seatd or logind). Another program or a text
// console can take it over for a while.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "base/error.h"

struct libseat;

namespace prismesh::kiosk::display::kms {

class Seat {
 public:
  /// Errors: no seat manager, or it refuses this user (with what to install or set).
  static Result<std::unique_ptr<Seat>> open();
  ~Seat();
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;

  /// "seat0".
  const std::string& name() const { return name_; }
  /// Whether the screen and the input devices are ours now.
  bool active() const { return active_; }
  /// Takes the manager's messages. Errors: the manager is gone.
  Result<void> turn();
  /// For poll(2).
  int descriptor() const;
  /// The seat has been taken over and our use of it has ended: without this answer the manager ends it by force.
  void let_go();
  /// Asks for a text console, or another program's screen, by its number.
  void switch_to(int console);

  /// Opens a device of the seat. The file stays the seat's. Errors: the manager refuses it.
  Result<int> open_device(const std::string& path);
  void close_device(int descriptor);

 private:
  Seat() = default;

  libseat* seat_ = nullptr;
  std::string name_;
  bool active_ = false;
  std::map<int, int> devices_;  ///< by descriptor: the manager's number
};

}  // namespace prismesh::kiosk::display::kms
