#include "daemon/deviced/pen/open_pen.h"

#include <utility>

#include "drivers/haptic_pen/falcon/falcon_pen.h"
#include "drivers/haptic_pen/falcon/firmware.h"
#include "drivers/haptic_pen/framed/framed_pen.h"
#include "drivers/haptic_pen/framed/simulated_device.h"
#include "drivers/port/open_port.h"

namespace prismesh::deviced::pen {
namespace {

namespace falcon = drivers::haptic_pen::falcon;
namespace framed = drivers::haptic_pen::framed;
using drivers::settings::HapticPenSettings;
using drivers::settings::PenDriver;

constexpr int kFramedBaud = 115'200;
/// Above the loop's, whose packets it carries; below the guard's.
constexpr int kUsbPriority = 42;

class OpenFramedPen final : public OpenPen {
 public:
  OpenFramedPen(std::unique_ptr<drivers::port::BytePort> line, GuardPage& page)
      : line_(std::move(line)), guarded_(*line_, page), pen_(guarded_, framed::simulated_limits({})) {}
  drivers::haptic_pen::HapticPen& pen() override { return pen_; }
  Result<void> hand_to(LineGuard& guard) override { return guard.watch(*line_); }

 private:
  std::unique_ptr<drivers::port::BytePort> line_;
  GuardedPort guarded_;
  framed::FramedPen pen_;
};

class OpenFalcon final : public OpenPen {
 public:
  OpenFalcon(std::unique_ptr<drivers::port::UsbPort> line, falcon::FalconOptions options)
      : line_(std::move(line)), pen_(*line_, std::move(options)) {}
  drivers::haptic_pen::HapticPen& pen() override { return pen_; }
  Result<void> hand_to(LineGuard& guard) override {
    return guard.watch(*line_, falcon::falcon_wanted().out_endpoint, falcon::zero_packet());
  }

 private:
  std::unique_ptr<drivers::port::UsbPort> line_;
  falcon::FalconPen pen_;
};

Result<std::unique_ptr<OpenPen>> open_falcon(const HapticPenSettings& settings, GuardPage& page) {
  falcon::FalconOptions options;
  options.force_scale = settings.force_scale;
  options.damping_newton_s_m = settings.own_damping_newton_s_m;
  options.friction_newton = settings.own_friction_newton;
  if (!settings.firmware.empty()) {
    Result<falcon::Firmware> firmware = falcon::read_firmware(settings.firmware);
    if (!firmware) return fail(std::move(firmware.error()));
    options.firmware = std::move(firmware->bytes);
  }
  Result<std::unique_ptr<drivers::port::UsbPort>> line =
      drivers::port::open_usb_port(falcon::falcon_wanted(), usb_gate(page), kUsbPriority);
  if (!line) return fail(std::move(line.error()));
  return std::make_unique<OpenFalcon>(std::move(*line), std::move(options));
}

}  // namespace

std::string pen_place(const HapticPenSettings& settings) {
  return settings.driver == PenDriver::falcon ? std::string("USB 0403:cb48") : settings.port;
}

Result<std::unique_ptr<OpenPen>> open_pen(const HapticPenSettings& settings, const std::string& place, GuardPage& page) {
  if (settings.driver == PenDriver::falcon) return open_falcon(settings, page);
  Result<std::unique_ptr<drivers::port::BytePort>> line = drivers::port::open_port(place, kFramedBaud);
  if (!line) return fail(std::move(line.error()));
  return std::make_unique<OpenFramedPen>(std::move(*line), page);
}

}  // namespace prismesh::deviced::pen
