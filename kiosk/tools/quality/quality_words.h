// Values and errors of shells in words.
#pragma once

#include <string>

#include "ipc/messages.h"

namespace prismesh::kiosk::tools::quality {

/// "17.3°", "0.42 mm", "4.1".
std::string value_words(double value, const std::string& unit);
/// "shell 12: warpage 17.3° fails", "shell 12: no area".
std::string error_words(const ipc::QualityError& error);

}  // namespace prismesh::kiosk::tools::quality
