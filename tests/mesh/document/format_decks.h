// One model as the text of a deck in each format.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::document {

struct WrittenShell {
  int id = 0;
  std::vector<int> nodes;  ///< three or four
};

/// Nodes and shells of part 1 of a sheet 1.5 thick, by id, and further cards of the format.
struct WrittenMesh {
  std::vector<std::pair<int, Vec3>> nodes;
  std::vector<WrittenShell> shells;
};

/// A sheet of columns x rows quads of 10 mm; ids count from 1 along x.
inline WrittenMesh written_sheet(int columns, int rows) {
  WrittenMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.nodes.emplace_back(1 + i + j * (columns + 1), Vec3(10.0 * i, 10.0 * j, 0));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int corner = 1 + i + j * (columns + 1);
      mesh.shells.push_back({1 + i + j * columns, {corner, corner + 1, corner + columns + 2, corner + columns + 1}});
    }
  return mesh;
}

inline constexpr std::array<const char*, 4> kDeckNames{"sheet.k", "sheet.bdf", "sheet_0000.rad", "sheet.inp"};

template <class... Values>
std::string printed(const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

inline std::string lsdyna_text(const WrittenMesh& mesh, const std::string& more) {
  std::string text = "*KEYWORD\n*NODE\n";
  for (const auto& [id, at] : mesh.nodes) text += printed("%8d%16.4f%16.4f%16.4f\n", id, at[0], at[1], at[2]);
  text += "*ELEMENT_SHELL\n";
  for (const WrittenShell& shell : mesh.shells)
    text += printed("%8d%8d%8d%8d%8d%8d\n", shell.id, 1, shell.nodes[0], shell.nodes[1], shell.nodes[2], shell.nodes.back());
  return text +
         "*PART\nsheet\n         1         1         1\n*SECTION_SHELL\n         1         2\n       1.5       1.5       1.5       1.5\n"
         "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n" +
         more + "*END\n";
}

inline std::string nastran_text(const WrittenMesh& mesh, const std::string& more) {
  std::string text = "SOL 101\nCEND\nBEGIN BULK\n";
  for (const auto& [id, at] : mesh.nodes) text += printed("GRID    %-8d        %8.4f%8.4f%8.4f\n", id, at[0], at[1], at[2]);
  for (const WrittenShell& shell : mesh.shells)
    text += shell.nodes.size() == 3 ? printed("CTRIA3  %-8d%-8d%-8d%-8d%-8d\n", shell.id, 1, shell.nodes[0], shell.nodes[1], shell.nodes[2])
                                    : printed("CQUAD4  %-8d%-8d%-8d%-8d%-8d%-8d\n", shell.id, 1, shell.nodes[0], shell.nodes[1],
                                              shell.nodes[2], shell.nodes[3]);
  return text + "PSHELL  1       1       1.5\nMAT1    1       210000.         0.3     7.85-9\n" + more + "ENDDATA\n";
}

inline std::string radioss_text(const WrittenMesh& mesh, const std::string& more) {
  std::string text =
      "#RADIOSS STARTER\n/BEGIN\nsheet\n      2022         0\n                  Mg                  mm                   s\n"
      "                  Mg                  mm                   s\n/NODE\n";
  for (const auto& [id, at] : mesh.nodes) text += printed("%10d%20.4f%20.4f%20.4f\n", id, at[0], at[1], at[2]);
  text += "/SHELL/1\n";
  for (const WrittenShell& shell : mesh.shells)
    if (shell.nodes.size() == 4)
      text += printed("%10d%10d%10d%10d%10d\n", shell.id, shell.nodes[0], shell.nodes[1], shell.nodes[2], shell.nodes[3]);
  text += "/SH3N/1\n";
  for (const WrittenShell& shell : mesh.shells)
    if (shell.nodes.size() == 3) text += printed("%10d%10d%10d%10d\n", shell.id, shell.nodes[0], shell.nodes[1], shell.nodes[2]);
  return text +
         "/PART/1\nsheet\n         1         1\n/PROP/SHELL/1\nsh\n        24\n\n         5                           1.5\n"
         "/MAT/LAW1/1\nst\n             7.85E-9\n            210000.0                 0.3\n" +
         more + "/END\n";
}

inline std::string abaqus_text(const WrittenMesh& mesh, const std::string& more) {
  std::string text = "*NODE\n";
  for (const auto& [id, at] : mesh.nodes) text += printed("%d, %.4f, %.4f, %.4f\n", id, at[0], at[1], at[2]);
  for (const WrittenShell& shell : mesh.shells)
    text += shell.nodes.size() == 3
                ? printed("*ELEMENT, TYPE=S3R, ELSET=P\n%d, %d, %d, %d\n", shell.id, shell.nodes[0], shell.nodes[1], shell.nodes[2])
                : printed("*ELEMENT, TYPE=S4R, ELSET=P\n%d, %d, %d, %d, %d\n", shell.id, shell.nodes[0], shell.nodes[1], shell.nodes[2],
                          shell.nodes[3]);
  return text + "*SHELL SECTION, ELSET=P, MATERIAL=M\n1.5\n*MATERIAL, NAME=M\n*ELASTIC\n210000., 0.3\n" + more;
}

/// The text of the deck with one of kDeckNames.
inline std::string deck_text(std::size_t format, const WrittenMesh& mesh, const std::string& more = {}) {
  switch (format) {
    case 0: return lsdyna_text(mesh, more);
    case 1: return nastran_text(mesh, more);
    case 2: return radioss_text(mesh, more);
    default: return abaqus_text(mesh, more);
  }
}

}  // namespace prismesh::mesh::document
