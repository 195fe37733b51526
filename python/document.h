// The document that scripts edit. Inner to python.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include "mesh/document/document.h"
#include "python/state.h"

namespace prismesh::python {

/// Registers Document and `open`.
void define_document(pybind11::module_& module);

/// A document and whether it is being edited. Several threads may read it while one edits: what takes long works on a copy of the document,
/// which shares everything, and the members change only under the GIL.
class ScriptedDocument {
 public:
  explicit ScriptedDocument(mesh::document::Document document) : document_(std::move(document)) {}

  /// Raises prismesh.Error once closed.
  const mesh::document::Document& opened() const;
  void close();
  bool is_closed() const { return !document_; }

  pybind11::object edit(const pybind11::object& edit, pybind11::object progress, const pybind11::kwargs& fields);
  pybind11::object check(const std::optional<std::string>& select, bool chordal) const;
  pybind11::object save(const pybind11::object& path, pybind11::object progress) const;
  State state() const;

 private:
  std::optional<mesh::document::Document> document_;
  bool busy_ = false;  ///< an edit is being prepared
};

}  // namespace prismesh::python
