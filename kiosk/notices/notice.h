// A sentence for the user.
#pragma once

#include <cstdint>
#include <string>

namespace prismesh::kiosk::notices {

struct Notice {
  enum class Kind : std::uint8_t { information, warning, error };
  Kind kind = Kind::information;
  std::string text;
  std::uint64_t document = 0;   ///< FollowedDocument::number of the document that the text is about; 0: none
  bool lists_warnings = false;  ///< the list of the deck's warnings has more of its kind
};

}  // namespace prismesh::kiosk::notices
