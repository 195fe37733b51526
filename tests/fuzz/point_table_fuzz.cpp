// Any bytes as a table of points: no crash; finite points, or an error with a line of the table.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "mesh/connections/read_points.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto points = prismesh::mesh::connections::read_points(text, "fuzz.csv");
  if (!points) {
    require(!points.error().message.empty() && points.error().line <= 1 + std::count(text.begin(), text.end(), '\n'));
    return 0;
  }
  require(!points->empty());
  for (const prismesh::mesh::Vec3& point : *points) require(point.allFinite());
  return 0;
}
