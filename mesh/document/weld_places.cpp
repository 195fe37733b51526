#include "mesh/document/weld_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "base/counted.h"
#include "base/file.h"
#include "base/readable_number.h"
#include "mesh/connections/read_points.h"
#include "mesh/connections/weld_spots.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/flanges.h"
#include "mesh/select/expression.h"

namespace prismesh::mesh::document {

namespace {

constexpr double kMaxWeldsOfALine = 1e6;

std::string length_words(double length) { return readable(length, 4); }

/// Errors: the pitch is missing or longer than the line, or makes too many welds; the ends don't fit.
Result<connections::SpotSpacing> spacing_on(const Weld& edit, const std::string& line, double length) {
  const double pitch = edit.pitch.value_or(0);
  if (!(pitch > 0) || !std::isfinite(pitch)) return fail("", "weld: \"pitch\" is missing: how far apart the welds are, a length above 0");
  if (!(length > 0)) return fail("", "weld: " + line + " has no length");
  if (pitch > length) return fail("", "weld: the pitch, " + length_words(pitch) + ", is longer than " + line + ", " + length_words(length));
  if (length / pitch > kMaxWeldsOfALine)
    return fail("",
                "weld: a pitch of " + length_words(pitch) + " on " + line + " of " + length_words(length) + " makes over a million welds");
  const double end_distance = edit.end_distance.value_or(pitch / 2);
  if (!(end_distance >= 0) || 2 * end_distance > length)
    return fail(
        "", "weld: the end distance, " + length_words(end_distance) + ", is longer than half of " + line + ", " + length_words(length / 2));
  return connections::SpotSpacing{pitch, end_distance};
}

Vec3 as_vector(const std::array<double, 3>& point) { return {point[0], point[1], point[2]}; }

Result<std::vector<WeldLine>> on_flanges(const Document& document, const Weld& edit, const Progress& progress) {
  SelectFlange wanted = *edit.flange;
  if (edit.gap > 0) wanted.gap = edit.gap;
  const Result<std::vector<connections::Flange>> flanges = flanges_wanted(document.current(), wanted, "weld", progress);
  if (!flanges) return fail(flanges.error());
  std::vector<WeldLine> lines;
  std::size_t too_short = 0;
  const double longest = flanges->empty() ? 0 : std::max_element(flanges->begin(), flanges->end(), [](const auto& a, const auto& b) {
                                                  return a.length < b.length;
                                                })->length;
  for (const connections::Flange& flange : *flanges) {
    if (const double pitch = edit.pitch.value_or(0); pitch > flange.length && pitch <= longest) {
      ++too_short;  // beside others that aren't
      continue;
    }
    if (!(flange.mean_width > 0)) return fail("", "weld: the flange there has no width");
    const Result<connections::SpotSpacing> spacing = spacing_on(edit, "the flange", flange.length);
    if (!spacing) return fail(spacing.error());
    if (edit.edge_distance && 2 * *edit.edge_distance > flange.mean_width)
      return fail("", "weld: the edge distance, " + length_words(*edit.edge_distance) + ", is longer than half of the flange's width, " +
                          length_words(flange.mean_width / 2));
    WeldLine line{connections::spots_along(flange.middle, flange.closed, *spacing), flange.parts, {flange.sides}};
    std::sort(line.parts.begin(), line.parts.end());
    line.parts.erase(std::unique(line.parts.begin(), line.parts.end()), line.parts.end());
    lines.push_back(std::move(line));
  }
  if (too_short > 0) lines.front().note = counted(too_short, "flange") + " shorter than the pitch got no weld";
  return lines;
}

/// The parts that the edit names, ascending.
Result<std::vector<PartIndex>> parts_named(const Document& document, const std::string& expression) {
  const Generation& now = document.current();
  Result<select::Chosen> chosen = select::evaluate(now.model, expression, select::EntityKind::part, now.relations->names, {});
  if (!chosen) return fail(chosen.error());
  std::vector<PartIndex> parts = std::move(chosen->parts);
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace

Result<Weld> with_points(const Document& document, const Weld& edit) {
  if (!edit.points_file) return edit;
  const std::filesystem::path path = document.path.parent_path() / *edit.points_file;
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const Result<std::vector<Vec3>> points = connections::read_points(bytes->text(), path.string());
  if (!points) return fail(points.error());
  Weld whole = edit;
  whole.points_file.reset();
  whole.points.emplace();
  for (const Vec3& point : *points) whole.points->push_back({point.x(), point.y(), point.z()});
  return whole;
}

Result<std::vector<WeldLine>> weld_places(const Document& document, const Weld& edit, const Progress& progress) {
  const int given = (edit.flange ? 1 : 0) + (edit.along ? 1 : 0) + (edit.points ? 1 : 0) + (edit.points_file ? 1 : 0);
  if (given != 1)
    return fail("", std::string("weld needs one of \"flange\", \"along\", \"points\" and \"points_file\": where the welds go") +
                        (given > 1 ? "; several are given" : ""));
  if (edit.points_file) {
    const Result<Weld> whole = with_points(document, edit);
    return whole ? weld_places(document, *whole, progress) : fail(whole.error());
  }
  if (!edit.flange && edit.edge_distance) return fail("", "weld: \"edge_distance\" is for \"flange\": only a flange has sides");
  if (edit.points && edit.end_distance) return fail("", "weld: \"end_distance\" is for \"flange\" and \"along\": points have no ends");
  std::vector<WeldLine> lines;
  if (edit.flange) {
    Result<std::vector<WeldLine>> found = on_flanges(document, edit, progress);
    if (!found) return found;
    lines = std::move(*found);
  } else if (edit.along) {
    std::vector<Vec3> line;
    for (const auto& point : *edit.along) line.push_back(as_vector(point));
    const Result<connections::SpotSpacing> spacing = spacing_on(edit, "the line", connections::length_of(line));
    if (!spacing) return fail(spacing.error());
    lines.push_back({connections::spots_along(line, false, *spacing), {}, {}});
  } else {
    WeldLine at;
    for (const auto& point : *edit.points) at.places.push_back(as_vector(point));
    lines.push_back(std::move(at));
  }
  if (!edit.parts) return lines;
  const Result<std::vector<PartIndex>> parts = parts_named(document, *edit.parts);
  if (!parts) return fail(parts.error());
  for (WeldLine& line : lines) {
    if (!line.parts.empty()) {
      std::vector<PartIndex> both;
      std::set_intersection(line.parts.begin(), line.parts.end(), parts->begin(), parts->end(), std::back_inserter(both));
      line.parts = std::move(both);
    } else {
      line.parts = *parts;
    }
    if (line.parts.size() < 2) return fail("", "weld: \"parts\" must name at least two parts that lie on each other there");
  }
  return lines;
}

}  // namespace prismesh::mesh::document
