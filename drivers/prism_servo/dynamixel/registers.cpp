#include "drivers/prism_servo/dynamixel/registers.h"

#include <algorithm>

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

constexpr std::array<Model, 34> kModels = {
    {{30, "MX-28(2.0)"},   {311, "MX-64(2.0)"},  {321, "MX-106(2.0)"},  {1000, "XH430-W350"}, {1001, "XD430-T350"}, {1010, "XH430-W210"},
     {1011, "XD430-T210"}, {1020, "XM430-W350"}, {1030, "XM430-W210"},  {1040, "XH430-V350"}, {1050, "XH430-V210"}, {1060, "XL430-W250"},
     {1070, "XC430-W150"}, {1080, "XC430-W240"}, {1090, "2XL430-W250"}, {1100, "XH540-W270"}, {1101, "XD540-T270"}, {1110, "XH540-W150"},
     {1111, "XD540-T150"}, {1120, "XM540-W270"}, {1130, "XM540-W150"},  {1140, "XH540-V270"}, {1150, "XH540-V150"}, {1160, "2XC430-W250"},
     {1170, "XW540-T260"}, {1180, "XW540-T140"}, {1190, "XL330-M077"},  {1200, "XL330-M288"}, {1210, "XC330-T181"}, {1220, "XC330-T288"},
     {1230, "XC330-M181"}, {1240, "XC330-M288"}, {1270, "XW430-T333"},  {1280, "XW430-T200"}}};

}  // namespace

std::span<const Model> known_models() { return kModels; }

std::string_view model_name(std::uint16_t number) {
  const auto found = std::find_if(kModels.begin(), kModels.end(), [number](const Model& model) { return model.number == number; });
  return found == kModels.end() ? std::string_view() : found->name;
}

std::string_view hardware_error_name(unsigned bit) {
  constexpr std::array<std::string_view, 6> kNames = {"input voltage", "motor sensor",     "overheating",
                                                      "motor encoder", "electrical shock", "overload"};
  return bit < kNames.size() ? kNames[bit] : "unknown fault";
}

}  // namespace prismesh::drivers::prism_servo::dynamixel
