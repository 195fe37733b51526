// Any bytes as an edit: no crash, an error in words, and what is read is written and read again as the same edit.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

#include "mesh/document/edit_json.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  bool syntax_error = false;
  const Result<mesh::document::Edit> edit = mesh::document::parse_edit(text, &syntax_error);
  if (!edit) {
    require(!edit.error().message.empty());
    return 0;
  }
  require(!syntax_error);
  const std::string written = mesh::document::edit_to_json(*edit).dump();
  const Result<mesh::document::Edit> again = mesh::document::parse_edit(written);
  require(again.has_value());
  require(mesh::document::edit_to_json(*again).dump() == written);
  return 0;
}
