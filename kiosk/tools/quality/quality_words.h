// Values and errors of shells in words.
#pragma once

#include <string>

#include "ipc/model/messages.h"

namespace prismesh::kiosk::tools::quality {

/// "17.3°", "0.42 mm", "4.1".
std::string value_words(double value, const std::string& unit);
/// "shell 12: warpage 17.3° fails", "shell 12: no area", "node 7: many triangles together, 6 about it".
std::string error_words(const ipc::QualityError& error);

/// The same for a row of a list, behind a sign that shows whether it fails.
std::string error_row_words(const ipc::QualityError& error);
/// A metric, a defect or the clusters in words.
std::string kind_words(const std::string& metric);

}  // namespace prismesh::kiosk::tools::quality
