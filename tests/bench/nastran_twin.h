// The shells of any model as a Nastran deck: the same mesh for two readers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "base/file.h"
#include "mesh/deck/text/format_number.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::bench {

/// Writes entries in the small field format: eight columns a field, what is wider is rounded.
class SmallField {
 public:
  void entry(std::string_view name) {
    text_ += '\n';
    text_ += name;
    text_.append(8 - name.size(), ' ');
  }
  void whole(std::int64_t value) { right(std::to_string(value)); }
  void real(double value) { right(deck::format_coordinate(value, 8, deck::Exponent::bare)); }
  void blank() { text_.append(8, ' '); }
  std::string& text() { return text_; }

 private:
  void right(const std::string& field) {
    if (field.size() < 8) text_.append(8 - field.size(), ' ');
    text_ += field;
  }
  std::string text_;
};

/// All nodes (GRID) and shells (CQUAD4, CTRIA3 by their corners), a PSHELL and a MAT1 for each part; ids are kept. Element and part ids
/// beyond eight digits don't fit: a model with one has no twin, and the text is empty.
inline std::string nastran_twin_text(const Model& model) {
  constexpr std::int64_t kMax = 99'999'999;
  constexpr std::int64_t kMaterial = 1;
  SmallField out;
  out.text().reserve(50 * model.node_count() + 60 * model.shell_count());
  out.text() += "BEGIN BULK";
  out.entry("MAT1");
  out.whole(kMaterial);
  out.real(210000);
  out.blank();
  out.real(0.3);
  out.real(7.85e-9);
  for (const Part& part : *model.parts) {
    if (part.id > kMax) return {};
    out.entry("PSHELL");
    out.whole(part.id);
    out.whole(kMaterial);
    out.real(part.thickness.value_or(1));
  }
  for (std::size_t i = 0; i < model.node_count(); ++i) {
    if (model.node_ids[i] > kMax) return {};
    out.entry("GRID");
    out.whole(model.node_ids[i]);
    out.blank();
    for (int axis = 0; axis < 3; ++axis) out.real(model.positions[i][axis]);
  }
  for (std::size_t i = 0; i < model.shell_count(); ++i) {
    const ShellNodes& shell = model.shell_nodes[i];
    if (model.shell_ids[i] > kMax) return {};
    out.entry(shell.is_triangle() ? "CTRIA3" : "CQUAD4");
    out.whole(model.shell_ids[i]);
    out.whole((*model.parts)[model.shell_parts[i].value].id);
    for (int corner = 0; corner < shell.corners(); ++corner) out.whole(model.node_ids[shell.node[static_cast<std::size_t>(corner)].value]);
  }
  out.text() += "\nENDDATA\n";
  return std::move(out.text());
}

/// Errors: the model has no twin (see nastran_twin_text), the file can't be written.
inline Result<void> write_nastran_twin(const Model& model, const std::filesystem::path& path) {
  const std::string text = nastran_twin_text(model);
  if (text.empty()) return fail(path.string(), "can't be written: an id has more than eight digits");
  const PendingFile file{path, {text}};
  return replace_files({&file, 1});
}

}  // namespace prismesh::mesh::bench
