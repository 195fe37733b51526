// What each haptic device can do, from published tables, and the limit that is applied last before a line.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "drivers/haptic_pen/pen.h"

namespace prismesh::drivers::haptic_pen {

/// Figures of one kind of device. 0: none is published.
struct DeviceFigures {
  std::string_view driver;  ///< its name in the settings
  std::string_view device;
  int degrees_in = 3, degrees_out = 3;
  double max_newton = 0;                 ///< that it holds; no longer force is ever asked for
  double peak_newton = 0;                ///< for a moment
  double max_stiffness_newton_m = 0;     ///< of a wall
  double max_damping_newton_s_m = 0;     ///< that a loop may add
  double quantum_mm = 0;                 ///< resolution of the place
  std::array<double, 3> workspace_mm{};  ///< whole width, height, depth
  std::string_view source;               ///< of the figures
};

inline constexpr DeviceFigures kFalconFigures{.driver = "falcon",
                                              .device = "Novint Falcon",
                                              .degrees_in = 3,
                                              .degrees_out = 3,
                                              .max_newton = 8,
                                              .peak_newton = 0,
                                              .max_stiffness_newton_m = 3000,
                                              .max_damping_newton_s_m = 20,
                                              .quantum_mm = 0.0635,
                                              .workspace_mm = {80, 80, 80},
                                              .source = "CHAI3D, constructor of cFalconDevice; the resolution: its maker, 400 an inch"};

/// Its grip, the VerseGrip, measures the orientation; no motor turns it.
inline constexpr DeviceFigures kInverse3Figures{
    .driver = "inverse3",
    .device = "Haply Inverse3",
    .degrees_in = 6,
    .degrees_out = 3,
    .max_newton = 4,
    .peak_newton = 10,
    .max_stiffness_newton_m = 1000,
    .max_damping_newton_s_m = 0,
    .quantum_mm = 0.01,
    .workspace_mm = {460, 510, 230},
    .source = "the maker's table of specifications as a dealer repeats it: 4 N in 80 % of the workspace, peak 10 N, 1 N/mm"};

inline constexpr std::array<DeviceFigures, 2> kDeviceFigures{kFalconFigures, kInverse3Figures};

/// Null: a simulated pen, or none.
const DeviceFigures* figures_of(std::string_view driver);

/// Limits of a device. Its own damping and friction are in no table; its delay is that of the line. The workspace lies about the middle.
PenLimits limits_of(const DeviceFigures& figures, double own_damping_newton_s_m, double own_friction_newton, std::int64_t delay_ns);

/// The command within the device's limits: force and torque keep their direction, and end where a number isn't finite. A device of three
/// degrees out gets no torque.
PenCommand within(const PenCommand& command, const PenLimits& limits);

}  // namespace prismesh::drivers::haptic_pen
