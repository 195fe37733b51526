#include "kiosk/tools/measuring/measure_list.h"

#include <utility>

#include <fmt/format.h>

#include "base/readable_number.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::measuring {

using panels::length_text;

bool MeasureList::pick(std::int64_t id, mesh::NodeIndex node, std::size_t nodes) {
  if (!begun_.ids.empty() && begun_.ids.back() == id) return false;
  begun_.ids.push_back(id);
  begun_.nodes.push_back(node);
  if (begun_.ids.size() < nodes) return false;
  all_.push_back(std::exchange(begun_, {}));
  return true;
}

bool MeasureList::give_up() { return !std::exchange(begun_, {}).ids.empty(); }

void MeasureList::remove(std::size_t index) {
  if (index < all_.size()) all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(index));
}

void MeasureList::clear() {
  all_.clear();
  begun_ = {};
}

void MeasureList::follow(const FindNode& find) {
  const auto follow_one = [&](Measure& measure) {
    measure.figures.reset();
    const std::vector<mesh::NodeIndex> before = std::exchange(measure.nodes, {});
    for (std::size_t i = 0; i < measure.ids.size(); ++i) {
      const std::optional<mesh::NodeIndex> node = find(measure.ids[i], i < before.size() ? std::optional(before[i]) : std::nullopt);
      if (!node) {
        measure.nodes.clear();
        return;
      }
      measure.nodes.push_back(*node);
    }
  };
  for (Measure& measure : all_) follow_one(measure);
  follow_one(begun_);
  if (begun_.nodes.empty()) begun_ = {};
}

bool MeasureList::compute(const mesh::Model& model, mesh::OutOfSight hidden) {
  bool any = false;
  for (Measure& measure : all_) {
    if (measure.nodes.empty() || measure.figures) continue;
    bool there = true;
    for (const mesh::NodeIndex node : measure.nodes) there = there && node.value < model.node_count();
    if (!there) continue;
    measure.figures = mesh::measure::measure_nodes(model, measure.nodes, hidden);
    any = true;
  }
  return any;
}

std::string measure_title(const Measure& measure) {
  std::string title = "nodes";
  for (std::size_t i = 0; i < measure.ids.size(); ++i) title += (i == 0 ? " " : " \u2192 ") + std::to_string(measure.ids[i]);
  return title;
}

std::string measure_label(const Measure& measure, const std::string& unit) {
  if (!measure.figures) return "";
  const mesh::measure::NodeMeasures& figures = *measure.figures;
  if (measure.ids.size() < 3) return length_text(figures.distance, unit);
  if (!figures.angle) return "two nodes at one place";
  const std::string angle = readable(*figures.angle, 4) + "\u00b0";
  return figures.circle ? angle + "  R " + length_text(figures.circle->radius, unit) : angle + "  on a line";
}

std::vector<std::string> measure_details(const Measure& measure, const std::string& unit) {
  if (measure.nodes.empty()) return {"one of its nodes isn't there"};
  if (!measure.figures) return {};
  const mesh::measure::NodeMeasures& figures = *measure.figures;
  std::vector<std::string> lines;
  if (measure.ids.size() > 2) lines.push_back("first to last " + length_text(figures.distance, unit));
  const mesh::Vec3& by = figures.between;
  lines.push_back(fmt::format("x {}  y {}  z {} {}", readable(by.x(), 4), readable(by.y(), 4), readable(by.z(), 4), unit));
  lines.push_back(figures.along_surface ? "along the surface " + length_text(*figures.along_surface, unit) : "no way along the surface");
  return lines;
}

}  // namespace prismesh::kiosk::tools::measuring
