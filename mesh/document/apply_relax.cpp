#include "mesh/document/apply.h"

namespace prismesh::mesh::document {

Result<void> apply_edit(const Document&, const Relax&, Generation&, EditReport&, const Progress&) {
  return fail("", "relax: not there yet");
}

}  // namespace prismesh::mesh::document
