#include "tests/support/places.h"

namespace prismesh::test {

std::filesystem::path source_folder() { return PRISMESH_SOURCE_FOLDER; }
std::filesystem::path programs_folder() { return PRISMESH_PROGRAMS; }

}  // namespace prismesh::test
