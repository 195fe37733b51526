#include "daemon/deviced/pen/open_pen.h"

#include <string>
#include <utility>

#include "drivers/haptic_pen/falcon/falcon_pen.h"
#include "drivers/haptic_pen/falcon/firmware.h"
#include "drivers/haptic_pen/framed/framed_pen.h"
#include "drivers/haptic_pen/framed/simulated_device.h"
#include "drivers/haptic_pen/inverse3/inverse3_pen.h"
#include "drivers/haptic_pen/inverse3/service_link.h"
#include "drivers/port/open_port.h"

namespace prismesh::deviced::pen {
namespace {

namespace falcon = drivers::haptic_pen::falcon;
namespace framed = drivers::haptic_pen::framed;
namespace inverse3 = drivers::haptic_pen::inverse3;
using drivers::settings::HapticPenSettings;
using drivers::settings::PenDriver;

constexpr int kFramedBaud = 115'200;
/// Above the loop's, whose packets it carries; below the guard's.
constexpr int kUsbPriority = 42, kServicePriority = 42;

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

class OpenInverse3 final : public OpenPen {
 public:
  OpenInverse3(std::unique_ptr<inverse3::ServiceLink> link, const inverse3::Inverse3Options& options)
      : link_(std::move(link)), pen_(*link_, options) {}
  drivers::haptic_pen::HapticPen& pen() override { return pen_; }
  Result<void> hand_to(LineGuard& guard) override { return guard.watch(link_->descriptor(), link_->zero_frame()); }

 private:
  std::unique_ptr<inverse3::ServiceLink> link_;
  inverse3::Inverse3Pen pen_;
};

Result<std::unique_ptr<OpenPen>> open_inverse3(const HapticPenSettings& settings, GuardPage& page) {
  inverse3::Inverse3Options options;
  options.force_scale = settings.force_scale;
  options.damping_newton_s_m = settings.own_damping_newton_s_m;
  options.friction_newton = settings.own_friction_newton;
  drivers::port::UsbGate gate = usb_gate(page);
  // What the guard has sent is answered too: after that this connection isn't used any more.
  gate.begin = [&page, trips = page.trips.load()] { return page.trips.load() == trips && page.begin_writing(); };
  Result<std::unique_ptr<inverse3::ServiceLink>> link =
      inverse3::ServiceLink::open(settings.service_port, std::move(gate), kServicePriority);
  if (!link) return fail(std::move(link.error()));
  return std::make_unique<OpenInverse3>(std::move(*link), options);
}

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
  if (settings.driver == PenDriver::falcon) return "USB 0403:cb48";
  if (settings.driver == PenDriver::inverse3) return "Haply Inverse Service, port " + std::to_string(settings.service_port);
  return settings.port;
}

Result<std::unique_ptr<OpenPen>> open_pen(const HapticPenSettings& settings, const std::string& place, GuardPage& page) {
  if (settings.driver == PenDriver::falcon) return open_falcon(settings, page);
  if (settings.driver == PenDriver::inverse3) return open_inverse3(settings, page);
  Result<std::unique_ptr<drivers::port::BytePort>> line = drivers::port::open_port(place, kFramedBaud);
  if (!line) return fail(std::move(line.error()));
  return std::make_unique<OpenFramedPen>(std::move(*line), page);
}

}  // namespace prismesh::deviced::pen
