// The state of deviced's devices at one moment. Inner to cli.
#pragma once

#include <cstdint>
#include <optional>

#include "ipc/device/messages.h"
#include "ipc/device/page.h"
#include "ipc/pen/messages.h"
#include "ipc/pen/page.h"

namespace prismesh::cli {

struct PenFigures {
  ipc::PenInfo info;
  ipc::PenState state;
  ipc::PenHealth loop;
};

struct DeviceFigures {
  std::int64_t now_ns = 0;  ///< of the same clock as the page's times
  ipc::Devices devices;
  ipc::EyesState eyes;
  ipc::PrismState mask;
  ipc::DeviceHealth loop;
  std::optional<PenFigures> pen;  ///< nothing: no process drives one

  /// Milliseconds since a time on the page; nothing if it never happened.
  std::optional<double> age_ms(std::int64_t time_ns) const {
    if (time_ns == 0) return std::nullopt;
    return static_cast<double>(now_ns - time_ns) * 1e-6;
  }
};

}  // namespace prismesh::cli
