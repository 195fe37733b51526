// How the picture follows the eyes, in words.
#pragma once

#include <cstdint>
#include <string>

namespace prismesh::kiosk::toolkit {

struct EyesFacts {
  enum class Condition : std::uint8_t { good, waiting, trouble };
  Condition condition = Condition::waiting;
  std::string eyes = "waiting";  ///< a few words
  std::string mask;              ///< a few words; empty: the display has no mask that moves
  std::string advice;            ///< a sentence: what to do; empty: nothing
  bool in_depth = false;
  bool simulated = false;
  bool operator==(const EyesFacts&) const = default;
};

}  // namespace prismesh::kiosk::toolkit
