#include "kiosk/display/kms/input_devices.h"

#include <linux/input-event-codes.h>

#include <cerrno>
#include <optional>

#include <libinput.h>
#include <libudev.h>

namespace prismesh::kiosk::display::kms {
namespace {

constexpr double kDegreesAStep = 15;  ///< of a wheel that doesn't tell its notches
constexpr double kUnitsAStep = 120;   ///< of a wheel that does

std::optional<MouseButton> button_of(std::uint32_t code) {
  switch (code) {
    case BTN_LEFT: return MouseButton::left;
    case BTN_MIDDLE: return MouseButton::middle;
    case BTN_RIGHT: return MouseButton::right;
    default: return std::nullopt;
  }
}

/// The lower button of a pen is its middle one, the upper its right one, as tablets are set up elsewhere.
std::optional<MouseButton> pen_button_of(std::uint32_t code) {
  if (code == BTN_STYLUS) return MouseButton::middle;
  if (code == BTN_STYLUS2) return MouseButton::right;
  return std::nullopt;
}

void take_pointer(libinput_event_type type, libinput_event_pointer* event, Input& input) {
  switch (type) {
    case LIBINPUT_EVENT_POINTER_MOTION: input.move_by(libinput_event_pointer_get_dx(event), libinput_event_pointer_get_dy(event)); break;
    case LIBINPUT_EVENT_POINTER_MOTION_ABSOLUTE:
      input.move_to(libinput_event_pointer_get_absolute_x_transformed(event, 1),
                    libinput_event_pointer_get_absolute_y_transformed(event, 1));
      break;
    case LIBINPUT_EVENT_POINTER_BUTTON:
      if (const std::optional<MouseButton> button = button_of(libinput_event_pointer_get_button(event)))
        input.button(*button, libinput_event_pointer_get_button_state(event) == LIBINPUT_BUTTON_STATE_PRESSED,
                     libinput_event_pointer_get_time(event));
      break;
    case LIBINPUT_EVENT_POINTER_SCROLL_WHEEL:
      if (libinput_event_pointer_has_axis(event, LIBINPUT_POINTER_AXIS_SCROLL_VERTICAL) != 0)
        input.wheel(-libinput_event_pointer_get_scroll_value_v120(event, LIBINPUT_POINTER_AXIS_SCROLL_VERTICAL) / kUnitsAStep);
      break;
    case LIBINPUT_EVENT_POINTER_SCROLL_FINGER:
    case LIBINPUT_EVENT_POINTER_SCROLL_CONTINUOUS:
      if (libinput_event_pointer_has_axis(event, LIBINPUT_POINTER_AXIS_SCROLL_VERTICAL) != 0)
        input.wheel(-libinput_event_pointer_get_scroll_value(event, LIBINPUT_POINTER_AXIS_SCROLL_VERTICAL) / kDegreesAStep);
      break;
    default: break;
  }
}

void take_pen(libinput_event_type type, libinput_event_tablet_tool* event, Input& input) {
  const std::int64_t time_ms = libinput_event_tablet_tool_get_time(event);
  if (type == LIBINPUT_EVENT_TABLET_TOOL_AXIS || type == LIBINPUT_EVENT_TABLET_TOOL_TIP || type == LIBINPUT_EVENT_TABLET_TOOL_PROXIMITY)
    input.move_to(libinput_event_tablet_tool_get_x_transformed(event, 1), libinput_event_tablet_tool_get_y_transformed(event, 1));
  if (type == LIBINPUT_EVENT_TABLET_TOOL_TIP)
    input.button(MouseButton::left, libinput_event_tablet_tool_get_tip_state(event) == LIBINPUT_TABLET_TOOL_TIP_DOWN, time_ms);
  if (type == LIBINPUT_EVENT_TABLET_TOOL_BUTTON)
    if (const std::optional<MouseButton> button = pen_button_of(libinput_event_tablet_tool_get_button(event)))
      input.button(*button, libinput_event_tablet_tool_get_button_state(event) == LIBINPUT_BUTTON_STATE_PRESSED, time_ms);
}

/// The first finger is the pointer with its left button held; further fingers do nothing.
void take_touch(libinput_event_type type, libinput_event_touch* event, Input& input) {
  if (type == LIBINPUT_EVENT_TOUCH_FRAME) return;
  if (type != LIBINPUT_EVENT_TOUCH_CANCEL && libinput_event_touch_get_seat_slot(event) > 0) return;
  const std::int64_t time_ms = libinput_event_touch_get_time(event);
  if (type == LIBINPUT_EVENT_TOUCH_DOWN || type == LIBINPUT_EVENT_TOUCH_MOTION)
    input.move_to(libinput_event_touch_get_x_transformed(event, 1), libinput_event_touch_get_y_transformed(event, 1));
  if (type == LIBINPUT_EVENT_TOUCH_DOWN) input.button(MouseButton::left, true, time_ms);
  if (type == LIBINPUT_EVENT_TOUCH_UP || type == LIBINPUT_EVENT_TOUCH_CANCEL) input.button(MouseButton::left, false, time_ms);
}

/// Touch pads tap and don't wait for a press; a button that is missing is emulated.
void set_up(libinput_device* device) {
  if (libinput_device_config_tap_get_finger_count(device) > 0) libinput_device_config_tap_set_enabled(device, LIBINPUT_CONFIG_TAP_ENABLED);
}

void take(libinput_event* event, Input& input) {
  const libinput_event_type type = libinput_event_get_type(event);
  switch (type) {
    case LIBINPUT_EVENT_DEVICE_ADDED: set_up(libinput_event_get_device(event)); break;
    case LIBINPUT_EVENT_KEYBOARD_KEY: {
      libinput_event_keyboard* key = libinput_event_get_keyboard_event(event);
      input.key(libinput_event_keyboard_get_key(key), libinput_event_keyboard_get_key_state(key) == LIBINPUT_KEY_STATE_PRESSED);
      break;
    }
    case LIBINPUT_EVENT_POINTER_MOTION:
    case LIBINPUT_EVENT_POINTER_MOTION_ABSOLUTE:
    case LIBINPUT_EVENT_POINTER_BUTTON:
    case LIBINPUT_EVENT_POINTER_SCROLL_WHEEL:
    case LIBINPUT_EVENT_POINTER_SCROLL_FINGER:
    case LIBINPUT_EVENT_POINTER_SCROLL_CONTINUOUS: take_pointer(type, libinput_event_get_pointer_event(event), input); break;
    case LIBINPUT_EVENT_TABLET_TOOL_AXIS:
    case LIBINPUT_EVENT_TABLET_TOOL_PROXIMITY:
    case LIBINPUT_EVENT_TABLET_TOOL_TIP:
    case LIBINPUT_EVENT_TABLET_TOOL_BUTTON: take_pen(type, libinput_event_get_tablet_tool_event(event), input); break;
    case LIBINPUT_EVENT_TOUCH_DOWN:
    case LIBINPUT_EVENT_TOUCH_UP:
    case LIBINPUT_EVENT_TOUCH_MOTION:
    case LIBINPUT_EVENT_TOUCH_CANCEL: take_touch(type, libinput_event_get_touch_event(event), input); break;
    default: break;
  }
}

}  // namespace

Result<std::unique_ptr<InputDevices>> InputDevices::open(Seat& seat, Tell tell) {
  static const libinput_interface kInterface{
      [](const char* path, int, void* self) {
        auto& devices = *static_cast<InputDevices*>(self);
        const Result<int> opened = devices.seat_.open_device(path);
        if (!opened) devices.tell_(opened.error().text());
        return opened ? *opened : -EACCES;
      },
      [](int descriptor, void* self) { static_cast<InputDevices*>(self)->seat_.close_device(descriptor); }};
  std::unique_ptr<InputDevices> devices(new InputDevices(seat, std::move(tell)));
  devices->udev_ = udev_new();
  if (devices->udev_ == nullptr) return fail("the input devices", "udev can't be used");
  devices->devices_ = libinput_udev_create_context(&kInterface, devices.get(), devices->udev_);
  if (devices->devices_ == nullptr || libinput_udev_assign_seat(devices->devices_, seat.name().c_str()) != 0)
    return fail("the input devices", "libinput can't find them: is udev running?");
  return devices;
}

InputDevices::~InputDevices() {
  if (devices_ != nullptr) libinput_unref(devices_);
  if (udev_ != nullptr) udev_unref(udev_);
}

void InputDevices::turn(Input& input) {
  libinput_dispatch(devices_);
  while (libinput_event* event = libinput_get_event(devices_)) {
    take(event, input);
    libinput_event_destroy(event);
  }
}

int InputDevices::descriptor() const { return libinput_get_fd(devices_); }

void InputDevices::suspend() { libinput_suspend(devices_); }

void InputDevices::resume() {
  if (libinput_resume(devices_) != 0) tell_("the input devices can't be opened again");
}

}  // namespace prismesh::kiosk::display::kms
