#include "kiosk/display/monitor.h"

#include <cctype>

namespace prismesh::kiosk::display {

LinkColour link_colour_from(const std::string& setting) {
  std::string plain;
  for (const char c : setting)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto names = [&](const char* word) { return plain.find(word) != std::string::npos; };
  if (names("422") || names("420")) return LinkColour::halved;
  if (names("444") || names("rgb")) return LinkColour::full;
  return LinkColour::unknown;
}

}  // namespace prismesh::kiosk::display
