#include "mesh/document/apply.h"

namespace prismesh::mesh::document {

Result<void> apply_edit(const Document&, const Repair&, Generation&, EditReport&, const Progress&) {
  return fail("", "repair: not there yet");
}
Result<void> apply_edit(const Document&, const Restructure& edit, Generation&, EditReport&) {
  return fail("", std::string(repair::name(edit.operation)) + ": not there yet");
}

}  // namespace prismesh::mesh::document
