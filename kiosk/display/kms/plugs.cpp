#include "kiosk/display/kms/plugs.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <libudev.h>

namespace prismesh::kiosk::display::kms {

Result<std::unique_ptr<Plugs>> Plugs::open() {
  std::unique_ptr<Plugs> plugs(new Plugs);
  plugs->udev_ = udev_new();
  if (plugs->udev_ != nullptr) plugs->monitor_ = udev_monitor_new_from_netlink(plugs->udev_, "udev");
  if (plugs->monitor_ == nullptr || udev_monitor_filter_add_match_subsystem_devtype(plugs->monitor_, "drm", "drm_minor") < 0 ||
      udev_monitor_enable_receiving(plugs->monitor_) < 0)
    return fail("udev", "plugged monitors can't be watched: is udev running?");
  return plugs;
}

Plugs::~Plugs() {
  if (monitor_ != nullptr) udev_monitor_unref(monitor_);
  if (udev_ != nullptr) udev_unref(udev_);
}

Plugs::Changes Plugs::take() {
  Changes changes;
  while (udev_device* device = udev_monitor_receive_device(monitor_)) {
    const auto text = [](const char* value) { return std::string_view(value != nullptr ? value : ""); };
    const std::string_view action = text(udev_device_get_action(device)), file = text(udev_device_get_devnode(device));
    if (action == "remove" && !file.empty()) changes.cards_gone.emplace_back(file);
    if (text(udev_device_get_property_value(device, "HOTPLUG")) == "1") changes.monitors = true;
    udev_device_unref(device);
  }
  return changes;
}

int Plugs::descriptor() const { return udev_monitor_get_fd(monitor_); }

std::vector<std::string> card_files() {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/dri", error))
    if (entry.path().filename().string().starts_with("card")) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace prismesh::kiosk::display::kms
