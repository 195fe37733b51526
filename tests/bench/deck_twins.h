// The nodes and shells of any model as decks of the other formats: the same mesh for each reader.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

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

namespace twin_text {

inline std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}
inline std::string whole(std::int64_t value) { return right(std::to_string(value), 10); }
inline std::string coordinate(double value) { return deck::format_coordinate(value, 16); }

/// Calls write_head(part id, whether triangles follow) before each run of shells of one part and kind, and write_shell(shell's index) for
/// each.
inline void for_each_run(const Model& model, const std::function<void(std::int64_t, bool)>& write_head,
                         const std::function<void(std::size_t)>& write_shell) {
  std::optional<std::pair<std::int64_t, bool>> last;
  for (std::size_t i = 0; i < model.shell_count(); ++i) {
    const std::pair run((*model.parts)[model.shell_parts[i].value].id, model.shell_nodes[i].is_triangle());
    if (run != last) write_head(run.first, run.second);
    last = run;
    write_shell(i);
  }
}

}  // namespace twin_text

/// Parts get a title, and no section.
inline std::string radioss_twin_text(const Model& model) {
  using namespace twin_text;
  std::string text = "#RADIOSS STARTER\n/BEGIN\ntwin\n" + whole(2022) + whole(0) + "\n";
  for (int i = 0; i < 2; ++i) text += right("Mg", 20) + right("mm", 20) + right("s", 20) + "\n";
  text += "/NODE\n";
  for (std::size_t i = 0; i < model.node_count(); ++i) {
    text += whole(model.node_ids[i]);
    for (int axis = 0; axis < 3; ++axis) text += right(coordinate(model.positions[i][axis]), 20);
    text += '\n';
  }
  for_each_run(
      model, [&](std::int64_t part, bool triangles) { text += (triangles ? "/SH3N/" : "/SHELL/") + std::to_string(part) + "\n"; },
      [&](std::size_t i) {
        const ShellNodes& shell = model.shell_nodes[i];
        text += whole(model.shell_ids[i]);
        for (int corner = 0; corner < shell.corners(); ++corner)
          text += whole(model.node_ids[shell.node[static_cast<std::size_t>(corner)].value]);
        text += '\n';
      });
  for (const Part& each : *model.parts) text += "/PART/" + std::to_string(each.id) + "\npart\n" + whole(1) + whole(1) + whole(0) + "\n";
  return text + "/END\n";
}

/// Parts get a section of steel, 1 mm thick.
inline std::string abaqus_twin_text(const Model& model) {
  using namespace twin_text;
  std::string text = "*HEADING\nTwin\n*NODE\n";
  for (std::size_t i = 0; i < model.node_count(); ++i) {
    text += std::to_string(model.node_ids[i]);
    for (int axis = 0; axis < 3; ++axis) text += ", " + coordinate(model.positions[i][axis]);
    text += '\n';
  }
  for_each_run(
      model,
      [&](std::int64_t part, bool triangles) {
        text += std::string("*ELEMENT, TYPE=") + (triangles ? "S3R" : "S4R") + ", ELSET=P" + std::to_string(part) + "\n";
      },
      [&](std::size_t i) {
        const ShellNodes& shell = model.shell_nodes[i];
        text += std::to_string(model.shell_ids[i]);
        for (int corner = 0; corner < shell.corners(); ++corner)
          text += ", " + std::to_string(model.node_ids[shell.node[static_cast<std::size_t>(corner)].value]);
        text += '\n';
      });
  for (const Part& each : *model.parts) text += "*SHELL SECTION, ELSET=P" + std::to_string(each.id) + ", MATERIAL=STEEL\n1., 5\n";
  return text + "*MATERIAL, NAME=STEEL\n*DENSITY\n7.85E-9,\n*ELASTIC\n210000., 0.3\n";
}

}  // namespace prismesh::mesh::bench
