#include "mesh/deck/sample/loft.h"

#include <algorithm>
#include <cmath>

#include "base/deterministic_math.h"

namespace prismesh::mesh::deck::sample {
namespace {

constexpr std::uint32_t kNoNode = 0xffffffffu;
constexpr double kHoleOfBlock = 0.355;  ///< a hole's radius in widths of the block it is cut into

std::size_t rounded(double value) { return value < 1.5 ? 1 : static_cast<std::size_t>(std::lround(value)); }

/// A hole's place in the grid: cells [station, station + cells) x [cell, cell + cells) of a face.
struct Block {
  Hole hole;
  std::size_t station = 0;
  std::size_t cell = 0;
  std::size_t cells = 0;
  std::size_t rings = 1;

  std::size_t shells() const { return 4 * cells * rings; }
};

/// How many cells each face has at each station, and the blocks cut out for holes.
struct Plan {
  std::size_t stations = 0;             ///< strips; there is one station more
  std::vector<std::vector<int>> cells;  ///< [face][station]
  std::vector<Block> blocks;
  double step = 0;
};

/// Cells across a face at every station. The number changes only when it is well off, so that triangles are few.
std::vector<int> cells_along(const Part& part, std::size_t face, std::size_t stations, double step, double size) {
  std::vector<int> cells(stations + 1);
  int now = 0;
  for (std::size_t i = 0; i <= stations; ++i) {
    const double wanted = part.width(face, step * static_cast<double>(i)) / size;
    if (now == 0) now = static_cast<int>(rounded(wanted));
    if (wanted > now + 0.7) ++now;
    if (wanted < now - 0.7 && now > 1) --now;
    cells[i] = now;
  }
  return cells;
}

/// The block for a hole; none where the grid is too coarse to hold it.
bool place_block(const Plan& plan, const Part& part, const Hole& hole, double size, Block& block) {
  // A hole of 0.355 of its block's width has edges about half as long as the block's: no shell between them is far from a
  // square. So the radius follows the grid, by at most a sixth of itself.
  const auto cells = static_cast<std::size_t>(std::lround(hole.radius / (kHoleOfBlock * size)));
  if (cells < 3) return false;
  const double centre = hole.along / plan.step;
  const double first = centre - 0.5 * static_cast<double>(cells) + 0.5;
  if (first < 1.0) return false;
  const auto station = static_cast<std::size_t>(first);
  if (station + cells + 1 > plan.stations) return false;
  const std::vector<int>& across = plan.cells[hole.face];
  const int n = across[station];
  for (std::size_t i = station; i <= station + cells; ++i)
    if (across[i] != n) return false;
  const double first_cell = hole.across * n - 0.5 * static_cast<double>(cells) + 0.5;
  if (first_cell < 1.0 || first_cell + static_cast<double>(cells) > n) return false;
  block = {hole, station, static_cast<std::size_t>(first_cell), cells, rounded(0.25 * static_cast<double>(cells))};
  const double cell = 0.5 * (plan.step + part.width(hole.face, hole.along) / n);
  block.hole.radius = kHoleOfBlock * cell * static_cast<double>(cells);
  return true;
}

Plan make_plan(const Part& part, const ElementSize& size) {
  Plan plan;
  plan.stations = rounded(part.length / size.along);
  plan.step = part.length / static_cast<double>(plan.stations);
  for (std::size_t face = 0; face < part.faces; ++face)
    plan.cells.push_back(cells_along(part, face, plan.stations, plan.step, size.across));
  for (const Hole& hole : part.holes) {
    Block block;
    if (place_block(plan, part, hole, size.across, block)) plan.blocks.push_back(block);
  }
  return plan;
}

/// Calls `quad(i, j)` and `triangle` so that the strip between `left` and `right` cells is filled. Cell borders of the side
/// with more cells are paired with the nearest of the other side.
template <class Emit>
void stitch(int left, int right, const Emit& emit) {
  const int many = std::max(left, right);
  const int few = std::min(left, right);
  const auto pair = [&](int i) { return (2 * i * few + many) / (2 * many); };
  for (int i = 0; i < many; ++i) {
    const int from = pair(i);
    const int to = pair(i + 1);
    if (left >= right)
      emit(i, i + 1, from, to);
    else
      emit(from, to, i, i + 1);
  }
}

class Mesher {
 public:
  Mesher(const Part& part, const Plan& plan) : part_(part), plan_(plan) {}

  SheetMesh run() {
    lay_grid();
    for (std::size_t i = 0; i < plan_.stations; ++i)
      for (std::size_t face = 0; face < part_.faces; ++face) fill_strip(face, i);
    for (const Block& block : plan_.blocks) fill_block(block);
    return std::move(mesh_);
  }

 private:
  double along(std::size_t station) const { return plan_.step * static_cast<double>(station); }

  std::uint32_t add(std::size_t face, double across, double at) {
    mesh_.nodes.push_back(part_.surface(face, across, at));
    return static_cast<std::uint32_t>(mesh_.nodes.size() - 1);
  }

  bool inside_a_block(std::size_t face, std::size_t station, std::size_t border) const {
    return std::any_of(plan_.blocks.begin(), plan_.blocks.end(), [&](const Block& b) {
      return b.hole.face == face && station > b.station && station < b.station + b.cells && border > b.cell && border < b.cell + b.cells;
    });
  }

  void lay_grid() {
    grid_.resize(part_.faces);
    for (std::size_t face = 0; face < part_.faces; ++face) grid_[face].resize(plan_.stations + 1);
    for (std::size_t i = 0; i <= plan_.stations; ++i)
      for (std::size_t face = 0; face < part_.faces; ++face) {
        const auto n = static_cast<std::size_t>(plan_.cells[face][i]);
        std::vector<std::uint32_t>& row = grid_[face][i];
        row.assign(n + 1, kNoNode);
        for (std::size_t j = 0; j <= n; ++j) {
          if (j == 0 && face > 0)
            row[0] = grid_[face - 1][i].back();
          else if (!inside_a_block(face, i, j))
            row[j] = add(face, static_cast<double>(j) / static_cast<double>(n), along(i));
        }
      }
  }

  bool covered(std::size_t face, std::size_t station, std::size_t cell) const {
    return std::any_of(plan_.blocks.begin(), plan_.blocks.end(), [&](const Block& b) {
      return b.hole.face == face && station >= b.station && station < b.station + b.cells && cell >= b.cell && cell < b.cell + b.cells;
    });
  }

  void fill_strip(std::size_t face, std::size_t station) {
    const std::vector<std::uint32_t>& left = grid_[face][station];
    const std::vector<std::uint32_t>& right = grid_[face][station + 1];
    stitch(plan_.cells[face][station], plan_.cells[face][station + 1], [&](int left0, int left1, int right0, int right1) {
      if (covered(face, station, static_cast<std::size_t>(left0))) return;
      const std::uint32_t a = left[static_cast<std::size_t>(left0)], b = right[static_cast<std::size_t>(right0)];
      const std::uint32_t c = right[static_cast<std::size_t>(right1)], d = left[static_cast<std::size_t>(left1)];
      if (left0 == left1)
        mesh_.shells.push_back({a, b, c, c});
      else if (right0 == right1)
        mesh_.shells.push_back({a, b, d, d});
      else
        mesh_.shells.push_back({a, b, c, d});
    });
  }

  /// Rings of quads between the block's square border and the hole's circle.
  void fill_block(const Block& block) {
    const std::size_t k = block.cells;
    const double n = plan_.cells[block.hole.face][block.station];
    const double width = part_.width(block.hole.face, block.hole.along);
    const double centre_along = along(block.station) + 0.5 * plan_.step * static_cast<double>(k);
    const double centre_across = (static_cast<double>(block.cell) + 0.5 * static_cast<double>(k)) / n;
    std::vector<std::uint32_t> outer(4 * k);
    std::vector<std::array<double, 2>> border(4 * k);  // along and across in mm from the centre
    for (std::size_t i = 0; i < 4 * k; ++i) {
      const std::size_t side = i / k, step = i % k;
      const std::size_t s = side == 0 ? k : side == 1 ? k - step : side == 2 ? 0 : step;
      const std::size_t c = side == 0 ? step : side == 1 ? k : side == 2 ? k - step : 0;
      outer[i] = grid_[block.hole.face][block.station + s][block.cell + c];
      border[i] = {(static_cast<double>(s) - 0.5 * static_cast<double>(k)) * plan_.step,
                   (static_cast<double>(c) - 0.5 * static_cast<double>(k)) * width / n};
      if (step != 0) continue;
      // At a corner two quads share a right angle; moved in by a fifth of a cell, it is wider.
      border[i][0] *= 1 - 0.4 / static_cast<double>(k);
      border[i][1] *= 1 - 0.4 / static_cast<double>(k);
      mesh_.nodes[outer[i]] = part_.surface(block.hole.face, centre_across + border[i][1] / width, centre_along + border[i][0]);
    }
    for (std::size_t ring = 1; ring <= block.rings; ++ring) {
      const double inward = static_cast<double>(ring) / static_cast<double>(block.rings);
      std::vector<std::uint32_t> inner(4 * k);
      for (std::size_t i = 0; i < 4 * k; ++i) {
        // The border starts at the corner an eighth of a turn before the direction of the line.
        const double degrees = 360.0 * static_cast<double>(i) / static_cast<double>(4 * k) - 45.0;
        const double at = border[i][0] + inward * (block.hole.radius * deterministic_cos_degrees(degrees) - border[i][0]);
        const double across = border[i][1] + inward * (block.hole.radius * deterministic_sin_degrees(degrees) - border[i][1]);
        inner[i] = add(block.hole.face, centre_across + across / width, centre_along + at);
      }
      for (std::size_t i = 0; i < 4 * k; ++i) {
        const std::size_t next = (i + 1) % (4 * k);
        mesh_.shells.push_back({outer[i], outer[next], inner[next], inner[i]});
      }
      outer = inner;
    }
  }

  const Part& part_;
  const Plan& plan_;
  std::vector<std::vector<std::vector<std::uint32_t>>> grid_;  ///< [face][station][border]
  SheetMesh mesh_;
};

}  // namespace

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * t * (10 - t * (15 - 6 * t));
}

std::size_t count_shells(const Part& part, const ElementSize& size) {
  const Plan plan = make_plan(part, size);
  std::size_t count = 0;
  for (const std::vector<int>& cells : plan.cells)
    for (std::size_t i = 0; i < plan.stations; ++i) count += static_cast<std::size_t>(std::max(cells[i], cells[i + 1]));
  for (const Block& block : plan.blocks) count = count - block.cells * block.cells + block.shells();
  return count;
}

SheetMesh mesh_part(const Part& part, const ElementSize& size) {
  const Plan plan = make_plan(part, size);
  return Mesher(part, plan).run();
}

}  // namespace prismesh::mesh::deck::sample
