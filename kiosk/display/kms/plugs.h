// Tells when a monitor or a graphics card is plugged in or out (udev).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"

struct udev;
struct udev_monitor;

namespace prismesh::kiosk::display::kms {

class Plugs {
 public:
  /// Errors: udev isn't running.
  static Result<std::unique_ptr<Plugs>> open();
  ~Plugs();
  Plugs(const Plugs&) = delete;
  Plugs& operator=(const Plugs&) = delete;

  struct Changes {
    bool monitors = false;                ///< one was plugged in or out, or has other modes
    std::vector<std::string> cards_gone;  ///< "/dev/dri/card0"
  };
  Changes take();
  /// For poll(2).
  int descriptor() const;

 private:
  Plugs() = default;
  udev* udev_ = nullptr;
  udev_monitor* monitor_ = nullptr;
};

/// The files of this computer's graphics cards, in order: /dev/dri/card0, ..
std::vector<std::string> card_files();

}  // namespace prismesh::kiosk::display::kms
