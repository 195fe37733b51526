#include "mesh/deck/abaqus/element_type.h"

#include <algorithm>

namespace prismesh::mesh::deck::abaqus {
namespace {

/// The number at the beginning; 0: none, or too large for any element.
std::uint8_t leading_number(std::string_view text) {
  int value = 0;
  std::size_t at = 0;
  while (at < text.size() && at < 3 && text[at] >= '0' && text[at] <= '9') value = value * 10 + (text[at++] - '0');
  return static_cast<std::uint8_t>(value <= 27 ? value : 0);
}

struct ShellFamily {
  std::string_view start;
  bool is_shell_section;
};
/// The number of nodes in a type's name. What follows it (R, R5, RS, T, ...) doesn't change the nodes.
constexpr ShellFamily kShellFamilies[] = {{"S", true}, {"STRI", true}, {"DS", true}, {"M3D", false}, {"SFM3D", false}, {"R3D", false}};

bool shell(std::string_view type, ElementType& out) {
  if (type.starts_with("STRI65")) {
    out = {ElementClass::shell, 6, 3, true};
    return true;
  }
  for (const ShellFamily& family : kShellFamilies) {
    if (!type.starts_with(family.start)) continue;
    const std::uint8_t nodes = leading_number(type.substr(family.start.size()));
    if (nodes != 3 && nodes != 4 && nodes != 6 && nodes != 8 && nodes != 9) continue;
    out = {ElementClass::shell, nodes, static_cast<std::uint8_t>(nodes == 3 || nodes == 6 ? 3 : 4), family.is_shell_section};
    return true;
  }
  return false;
}

struct Family {
  std::string_view start;  ///< longer ones before their own beginnings
  ElementClass element_class;
  std::int8_t nodes;  ///< -1: a number follows that says it; 0: as many as there are
};
constexpr Family kFamilies[] = {
    {"C3D27", ElementClass::solid, 0},       {"C3D", ElementClass::solid, -1},       {"DC3D", ElementClass::solid, -1},
    {"DCC3D", ElementClass::solid, -1},      {"AC3D", ElementClass::solid, -1},      {"EC3D", ElementClass::solid, -1},
    {"FC3D", ElementClass::solid, -1},       {"Q3D", ElementClass::solid, -1},       {"COH3D", ElementClass::solid, -1},
    {"GK3D", ElementClass::solid, -1},       {"F3D", ElementClass::solid, -1},       {"CIN3D", ElementClass::solid, -1},
    {"DCOUP3D", ElementClass::other, 1},     {"SC", ElementClass::tshell, -1},       {"CSS", ElementClass::tshell, -1},
    {"PC3D", ElementClass::sph, 1},          {"PD3D", ElementClass::sph, 1},         {"FRAME", ElementClass::beam, 2},
    {"T2D", ElementClass::beam, -1},         {"T3D", ElementClass::beam, -1},        {"CONN2D", ElementClass::discrete, -1},
    {"CONN3D", ElementClass::discrete, -1},  {"SPRING1", ElementClass::discrete, 1}, {"SPRING", ElementClass::discrete, 2},
    {"DASHPOT1", ElementClass::discrete, 1}, {"DASHPOT", ElementClass::discrete, 2}, {"JOINT", ElementClass::discrete, 2},
    {"GAP", ElementClass::discrete, 2},      {"ITS", ElementClass::discrete, 2},     {"MASS", ElementClass::mass, 1},
    {"ROTARYI", ElementClass::mass, 1},      {"HEATCAP", ElementClass::mass, 1},     {"SAX1", ElementClass::other, 2},
    {"SAX2", ElementClass::other, 3},        {"CPS", ElementClass::other, -1},       {"CPEG", ElementClass::other, 0},
    {"CPE", ElementClass::other, -1},        {"CAX", ElementClass::other, -1},
};

/// B31, B32H, PIPE21, ELBOW32: the second digit says how they interpolate; quadratic ones have a node in the middle.
bool beam(std::string_view type, ElementType& out) {
  for (const std::string_view start : {"B", "PIPE", "ELBOW"}) {
    if (!type.starts_with(start) || type.size() < start.size() + 2) continue;
    const char space = type[start.size()];
    const char order = type[start.size() + 1];
    if ((space != '2' && space != '3') || order < '1' || order > '4') continue;
    out = {ElementClass::beam, static_cast<std::uint8_t>(order == '2' ? 3 : 2), 0, true};
    return true;
  }
  return false;
}

}  // namespace

ElementType element_type(std::string_view type) {
  ElementType out;
  if (shell(type, out) || beam(type, out)) return out;
  // CalculiX: a fluid or gas network; a missing node at an end is 0.
  if (type == "D") return {ElementClass::other, 3, 0, true};
  for (const Family& family : kFamilies) {
    if (!type.starts_with(family.start)) continue;
    const std::uint8_t nodes =
        family.nodes >= 0 ? static_cast<std::uint8_t>(family.nodes) : leading_number(type.substr(family.start.size()));
    if (family.nodes < 0 && nodes == 0) continue;
    return {family.element_class, nodes, 0, true};
  }
  return out;
}

void count(const ElementType& type, ElementCounts& counts, std::size_t cards) {
  if (type.element_class == ElementClass::shell)
    counts.of_shell(type.corners == 3, type.has_midside()) += cards;
  else
    counts.of(type.element_class) += cards;
}

}  // namespace prismesh::mesh::deck::abaqus
