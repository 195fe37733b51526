// The part of a handle under the pointer, as it is shown to the hand that may take it. Plain data.
#pragma once

#include <string>
#include <vector>

#include "kiosk/input/gestures.h"

namespace prismesh::kiosk::toolkit {

struct HandlePart {
  std::vector<std::vector<input::Pixel>> lines{};  ///< along which it lies in the picture
  std::string does{};                              ///< "drag: lift"
};

}  // namespace prismesh::kiosk::toolkit
