#include "kiosk/render/node_pass.h"

#include <algorithm>

namespace prismesh::kiosk::render {

namespace {

// Sizes in display pixels.
constexpr RadiusLimits kNodeRadius{4.2F, 1.3F, 0.26F};
/// From this radius on nodes are octahedra with a dark rim. Smaller ones look like squares and are drawn as squares.
constexpr float kMinRimmedRadius = 2.6F;
constexpr double kMinSideOfDots = 15;  ///< of shells, in pixels: smaller ones have no dots on selected faces
constexpr float kHiddenLight = 0.80F;  ///< brightness behind a surface: between any part's colour and white

constexpr std::array<std::uint8_t, 24> kOctahedron{0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5};
constexpr std::array<std::uint8_t, 6> kSquare{0, 1, 2, 0, 2, 3};

/// Nodes that are drawn in one call, by index into the rows.
struct Run {
  std::size_t first = 0, count = 0;
};

std::vector<Run> runs_in_picture(const SelectionRows& rows, const Eigen::Matrix4d& clip_from_model) {
  std::vector<Run> runs;
  for (std::size_t c = 0; c < rows.chunks().size(); ++c) {
    const SelectionRows::Chunk& chunk = rows.chunks()[c];
    for (std::size_t b = 0; b < chunk.blocks.size(); ++b) {
      if (!may_be_seen(chunk.blocks[b], clip_from_model)) continue;
      const std::size_t begin = b * SelectionRows::kBlockSize, first = c * mesh::kChunkSize + begin;
      const std::size_t count = std::min<std::size_t>(SelectionRows::kBlockSize, chunk.count - begin);
      if (b > 0 && !runs.empty() && runs.back().first + runs.back().count == first)
        runs.back().count += count;
      else
        runs.push_back({first, count});
    }
  }
  return runs;
}

}  // namespace

template <std::size_t N>
NodePass::Solid NodePass::make_solid(const gl::Program& program, int corners, const std::array<std::uint8_t, N>& indices) {
  std::vector<std::uint16_t> all;  // six corners a node: max 24,576, so 16 bits are enough
  all.reserve(mesh::kChunkSize * N);
  for (std::size_t node = 0; node < mesh::kChunkSize; ++node)
    for (const std::uint8_t index : indices) all.push_back(static_cast<std::uint16_t>(node * static_cast<std::size_t>(corners) + index));
  Solid solid{program, gl::VertexArray::make(), gl::Buffer::make(), static_cast<int>(N)};
  glBindVertexArray(solid.array.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, solid.indices.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(all.size() * sizeof(std::uint16_t)), all.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
  return solid;
}

NodePass::NodePass(const Shaders& shaders)
    : octahedra_(make_solid(shaders.nodes, 6, kOctahedron)), squares_(make_solid(shaders.flat_nodes, 4, kSquare)) {}

void NodePass::draw(const ModelLayer& model, const Frame& frame) const {
  // Far off, selected faces show by their tint; dots on each of their corners would bury the model.
  const double side_pixels = model.typical_side() * frame.view.mm_per_unit / frame.eye.mm_per_pixel;
  const SelectionRows& rows = side_pixels < kMinSideOfDots ? model.loose() : model.selected();
  if (rows.count() == 0) return;
  const float fitting = frame.fitting_radius(kNodeRadius, model.typical_side());
  const float radius = model.previewing() ? kNodeRadius.min_pixels : fitting;  // the preview's wireframe shows the moving nodes
  const bool rimmed = radius >= kMinRimmedRadius;
  const Solid& solid = rimmed ? octahedra_ : squares_;
  rows.texture().bind(unit::kSelection);
  frame.set(solid.program);
  solid.program.set("selection", static_cast<int>(unit::kSelection));
  solid.program.set("radius_pixels", radius);
  const Eigen::Matrix4d clip_from_model = frame.clip_from_model.cast<double>();
  const std::vector<Run> seen = runs_in_picture(rows, clip_from_model);
  glBindVertexArray(solid.array.get());
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  const auto draw = [&](float grow, const Colour& colour) {
    solid.program.set("grow", grow);
    solid.program.set("ink", colour.x(), colour.y(), colour.z(), 1.0F);
    for (const Run& run : seen) {
      const DrawSpan::Part now = frame.span.take(run.count);
      if (now.count == 0) continue;
      solid.program.set("first", static_cast<int>(run.first + now.first));
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(now.count) * solid.indices_each, GL_UNSIGNED_SHORT, nullptr);
    }
  };
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  draw(0.85F, kHiddenLight * kSelectedColour);
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  glDepthFunc(GL_LEQUAL);
  if (rimmed) draw(1.35F, kBorderColour);  // a dark rim separates white nodes from a light part
  glDepthMask(GL_TRUE);
  draw(1.0F, kSelectedColour);
  glDisable(GL_CULL_FACE);
}

}  // namespace prismesh::kiosk::render
