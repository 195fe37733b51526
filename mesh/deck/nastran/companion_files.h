// The statements before the bulk data that name a file to read besides INCLUDE.
// Source: MSC Nastran Quick Reference Guide, "ASSIGN"; OptiStruct Reference Guide, "ASSIGN" and "LOADLIB" (I/O options).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::mesh::deck::nastran {

struct NamedFile {
  std::string statement;  ///< "ASSIGN"
  std::string name;
  std::size_t offset = 0;   ///< of the statement
  bool is_certain = false;  ///< false: the program may write the file
};

/// The files that the statements in [begin, end) name or may name. Names between quotes, or of OptiStruct the last word of the statement.
std::vector<NamedFile> named_files(std::string_view text, std::size_t begin, std::size_t end);

}  // namespace prismesh::mesh::deck::nastran
