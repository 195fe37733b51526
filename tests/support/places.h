// Paths of the project's own files and of the programs that were built with it. The paths are compiled into one source of their
// own, so that all others compile to the same object in whatever folder the project lies.
#pragma once

#include <filesystem>

namespace prismesh::test {

std::filesystem::path source_folder();
std::filesystem::path programs_folder();

}  // namespace prismesh::test
