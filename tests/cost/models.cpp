#include "tests/cost/models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/bench/million_document.h"

namespace prismesh::cost {
namespace {

using mesh::Model;
using mesh::NodeIndex;
using mesh::Vec3;

constexpr double kEdge = 5;

/// The points of a line across a sheet, kEdge apart.
using Section = std::vector<std::array<double, 2>>;

/// Walks straight and through fillets of four shells: each stretch is a number of edges and the turn behind it, in degrees.
Section walk(const std::vector<std::pair<int, double>>& stretches) {
  constexpr int kFilletShells = 4;
  Section points{{0, 0}};
  double degrees = 0;
  const auto step = [&] {
    const double angle = degrees * std::numbers::pi / 180;
    points.push_back({points.back()[0] + kEdge * std::cos(angle), points.back()[1] + kEdge * std::sin(angle)});
  };
  for (const auto& [edges, turn] : stretches) {
    for (int i = 0; i < edges; ++i) step();
    for (int i = 0; turn != 0 && i < kFilletShells; ++i) {
      degrees += turn / (kFilletShells + 1);
      step();
    }
    degrees += turn / (kFilletShells + 1);
  }
  return points;
}

const Section& hat() {
  static const Section kSection = walk({{10, 90}, {12, -90}, {40, -90}, {12, 90}, {10, 0}});
  return kSection;
}
constexpr std::size_t kTopBegin = 10 + 4 + 12 + 4, kTopEnd = kTopBegin + 40;  ///< columns of the hat

std::size_t rows_of(const Model& rails) { return rails.shell_count() / 2 / (hat().size() - 1); }

/// A sheet of each section, `rows` long, each a part. Nodes lie up to a tenth of an edge out of their row, in the sheet.
Model sheets(const std::vector<Section>& sections, std::size_t rows) {
  Model model;
  std::vector<Vec3> positions;
  std::vector<mesh::ShellNodes> shells;
  std::vector<std::size_t> part_of;
  std::uint32_t seed = 1;
  const auto jitter = [&] { return 0.2 * kEdge * (((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0 - 0.5); };
  for (std::size_t part = 0; part < sections.size(); ++part) {
    const std::size_t first = positions.size(), stride = sections[part].size();
    for (std::size_t j = 0; j <= rows; ++j)
      for (const auto& [x, z] : sections[part])
        positions.emplace_back(x + 600.0 * static_cast<double>(part), kEdge * static_cast<double>(j) + jitter(), z);
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i + 1 < stride; ++i) {
        const std::size_t a = first + j * stride + i;
        shells.push_back({{NodeIndex(a), NodeIndex(a + 1), NodeIndex(a + stride + 1), NodeIndex(a + stride)}});
        part_of.push_back(part);
      }
  }
  model.positions.resize(positions.size(), Vec3::Zero());
  for (std::size_t i = 0; i < positions.size(); ++i) model.positions.set(i, positions[i]);
  model.shell_nodes.resize(shells.size());
  model.shell_parts.resize(shells.size(), mesh::PartIndex(std::size_t{0}));
  model.shell_thickness.resize(shells.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    model.shell_nodes.set(i, shells[i]);
    model.shell_parts.set(i, mesh::PartIndex(part_of[i]));
  }
  std::vector<mesh::Part> parts(sections.size(), mesh::bench::steel_sheet());
  for (std::size_t part = 0; part < parts.size(); ++part) parts[part].id = static_cast<std::int64_t>(part) + 1;
  model.parts = std::make_shared<const std::vector<mesh::Part>>(std::move(parts));
  return model;
}

}  // namespace

Model flat_sheet(std::size_t shells) {
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(shells)));
  return mesh::bench::complete(sheets({walk({{static_cast<int>(side), 0}})}, side));
}

Model rails(std::size_t shells) {
  Model model = sheets({hat(), hat()}, shells / 2 / (hat().size() - 1));
  for (std::size_t i = kShellsOfDefect / 2 + 20; i < model.shell_count(); i += kShellsOfDefect) {
    const mesh::ShellNodes& nodes = model.shell_nodes[i];
    const Vec3 a = model.position(nodes.node[0]), opposite = model.position(nodes.node[2]);
    model.positions.set(nodes.node[0].value, a + 0.8 * (opposite - a));
  }
  return mesh::bench::complete(std::move(model));
}

std::string top_of_first_rail(const Model& rails) {
  const std::size_t rows = rows_of(rails);
  std::string expression;
  for (std::size_t j = rows / 4; j <= rows - rows / 4; ++j) {
    const std::size_t first = j * hat().size();
    expression += (expression.empty() ? "" : ",") + std::to_string(first + kTopBegin + 1) + "-" + std::to_string(first + kTopEnd + 1);
  }
  return expression;
}

NodeIndex middle_of_top(const Model& rails) { return NodeIndex(rows_of(rails) / 2 * hat().size() + (kTopBegin + kTopEnd) / 2); }

}  // namespace prismesh::cost
