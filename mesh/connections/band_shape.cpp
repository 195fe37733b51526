#include "mesh/connections/band_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace prismesh::mesh::connections {

namespace {

/// A band is a ring if its second border is at least this share of the first; shorter ones are holes.
constexpr double kMinSecondBorder = 0.5;
/// A share of the width by which an end must be straighter to be preferred.
constexpr double kStraighter = 1e-6;
constexpr std::size_t kMaxStations = 512;
constexpr std::size_t kPairsCompared = 24;
/// The width at a station is measured to so many pieces of the other side, before and after.
constexpr std::size_t kPiecesBeside = 8;

/// A closed line with places by arc length.
class ClosedLine {
 public:
  ClosedLine(const Model& model, const std::vector<NodeIndex>& nodes) {
    for (const NodeIndex node : nodes) points_.push_back(model.position(node));
    arc_.push_back(0);
    for (std::size_t i = 0; i < points_.size(); ++i)
      arc_.push_back(arc_.back() + std::sqrt((points_[(i + 1) % points_.size()] - points_[i]).squaredNorm()));
  }
  double length() const { return arc_.back(); }
  std::size_t size() const { return points_.size(); }
  /// The arc length of a corner (even number) or the middle of a side (odd).
  double place(std::size_t half) const {
    const std::size_t i = (half / 2) % size();
    return half % 2 == 0 ? arc_[i] : (arc_[i] + arc_[i + 1]) / 2;
  }
  Vec3 at(double arc) const {
    arc -= length() * std::floor(arc / length());
    const auto above = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, arc);
    const auto i = static_cast<std::size_t>(above - arc_.begin()) - 1;
    const double step = arc_[i + 1] - arc_[i];
    const double share = step > 0 ? std::clamp((arc - arc_[i]) / step, 0.0, 1.0) : 0.0;
    return points_[i] + share * (points_[(i + 1) % size()] - points_[i]);
  }
  /// The arc length of the point of the line that is closest.
  double closest(const Vec3& point) const {
    double best = std::numeric_limits<double>::infinity(), arc = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const Vec3 along = points_[(i + 1) % size()] - points_[i];
      const double length2 = along.squaredNorm();
      const double share = length2 > 0 ? std::clamp((point - points_[i]).dot(along) / length2, 0.0, 1.0) : 0.0;
      const double distance2 = (points_[i] + share * along - point).squaredNorm();
      if (distance2 < best) best = distance2, arc = arc_[i] + share * (arc_[i + 1] - arc_[i]);
    }
    return arc;
  }

 private:
  std::vector<Vec3> points_;
  std::vector<double> arc_;
};

/// The middles of both ends of a strip, by arc length of its border.
struct Ends {
  double first = 0, second = 0;
};

/// The two sides of a strip's border between its ends, from the first end on.
class Sides {
 public:
  Sides(const ClosedLine& border, const Ends& ends, double width)
      : border_(border), from_(ends.first + width / 2), back_(ends.first + border.length() - width / 2) {
    const double second = ends.second > ends.first ? ends.second : ends.second + border.length();
    one_ = second - width / 2 - from_;
    other_ = back_ - (second + width / 2);
  }
  bool valid() const { return one_ > 0 && other_ > 0; }
  Vec3 one(double share) const { return border_.at(from_ + share * one_); }
  Vec3 other(double share) const { return border_.at(back_ - share * other_); }
  /// The mean square by which distances of opposite points differ from the width; infinite where a side has no length.
  double misfit(double width) const {
    if (!valid()) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (std::size_t i = 0; i <= kPairsCompared; ++i) {
      const double share = static_cast<double>(i) / kPairsCompared;
      const double difference = std::sqrt((one(share) - other(share)).squaredNorm()) - width;
      sum += difference * difference;
    }
    return sum / (kPairsCompared + 1);
  }

 private:
  const ClosedLine& border_;
  double from_, back_;
  double one_ = 0, other_ = 0;
};

/// Moves the middle of an end, by less than would put a corner into it, to where its ends are farthest apart: the end of a strip is
/// straight.
double straight_end(const ClosedLine& border, double end, double width) {
  const auto chord = [&](double place) { return std::sqrt((border.at(place + width / 2) - border.at(place - width / 2)).squaredNorm()); };
  double best = end, longest = chord(end) + kStraighter * width;
  for (std::size_t i = 0; i < 2 * border.size(); ++i) {
    const double way = std::remainder(border.place(i) - end, border.length());
    if (std::abs(way) > width / 2) continue;
    if (const double length = chord(end + way); length > longest) longest = length + kStraighter * width, best = end + way;
  }
  return best;
}

Ends find_ends(const ClosedLine& border, double width) {
  Ends best;
  double least = std::numeric_limits<double>::infinity();
  const auto attempt = [&](const Ends& ends) {
    const double misfit = Sides(border, ends, width).misfit(width);
    if (misfit < least) least = misfit, best = ends;
  };
  const std::size_t places = 2 * border.size();
  for (std::size_t i = 0; i < places; ++i) attempt({border.place(i), border.place(i) + border.length() / 2});
  // The sides of a curved strip differ in length: each end is moved by itself.
  const auto near_to = [&](double place, double end) {
    const double way = std::abs(std::remainder(place - end, border.length()));
    return way <= 2 * width + border.length() / 16;
  };
  for (int round = 0; round < 3; ++round) {
    const Ends before = best;
    for (std::size_t i = 0; i < places; ++i)
      if (near_to(border.place(i), before.second)) attempt({best.first, border.place(i)});
    for (std::size_t i = 0; i < places; ++i)
      if (near_to(border.place(i), before.first)) attempt({border.place(i), best.second});
    if (best.first == before.first && best.second == before.second) break;
  }
  return {straight_end(border, best.first, width), straight_end(border, best.second, width)};
}

double distance_of(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return std::sqrt((from + share * along - point).squaredNorm());
}

double width_at(const std::vector<Vec3>& side, const std::vector<Vec3>& other, std::size_t i) {
  double width = std::sqrt((side[i] - other[i]).squaredNorm());
  const std::size_t end = std::min(i + kPiecesBeside, other.size() - 1);
  for (std::size_t j = i > kPiecesBeside ? i - kPiecesBeside : 0; j < end; ++j)
    width = std::min(width, distance_of(side[i], other[j], other[j + 1]));
  return width;
}

void measure(double area, BandShape& shape) {
  shape.min_width = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < shape.sides[0].size(); ++i) {
    shape.middle.push_back((shape.sides[0][i] + shape.sides[1][i]) / 2);
    if (i > 0) shape.length += std::sqrt((shape.middle[i] - shape.middle[i - 1]).squaredNorm());
    shape.min_width = std::min({shape.min_width, width_at(shape.sides[0], shape.sides[1], i), width_at(shape.sides[1], shape.sides[0], i)});
  }
  shape.mean_width = shape.length > 0 ? area / shape.length : 0;
}

std::size_t stations(double length, const ClosedLine& border) {
  const double step = border.length() / static_cast<double>(border.size());
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(length / step)), 2, kMaxStations);
}

BandShape strip(const ClosedLine& border, double area, const StripSize& size) {
  const Sides sides(border, find_ends(border, size.width), size.width);
  const std::size_t steps = stations(size.length, border);
  BandShape shape;
  for (std::size_t i = 0; i <= steps && sides.valid(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(steps);
    shape.sides[0].push_back(sides.one(share));
    shape.sides[1].push_back(sides.other(share));
  }
  measure(area, shape);
  return shape;
}

BandShape ring(const ClosedLine& outer, const ClosedLine& inner, double area) {
  const std::size_t steps = stations(outer.length(), outer);
  BandShape shape;
  shape.closed = true;
  for (std::size_t i = 0; i <= steps; ++i) {
    const Vec3 point = outer.at(outer.length() * static_cast<double>(i % steps) / static_cast<double>(steps));
    shape.sides[0].push_back(point);
    shape.sides[1].push_back(inner.at(inner.closest(point)));
  }
  measure(area, shape);
  return shape;
}

double length_of(const Model& model, const std::vector<NodeIndex>& line) { return ClosedLine(model, line).length(); }

}  // namespace

std::optional<StripSize> strip_size(double border, double area) {
  const double quarter = border / 4;
  double root2 = quarter * quarter - area;
  if (root2 < -1e-9 * area) return std::nullopt;
  root2 = std::max(root2, 0.0);
  const double length = quarter + std::sqrt(root2);
  return StripSize{length, area / length};
}

std::vector<std::vector<NodeIndex>> border_lines(const Model& model, const std::vector<BorderEdge>& border) {
  struct End {
    NodeIndex node;
    std::size_t edge;
    bool operator<(const End& other) const { return node != other.node ? node < other.node : edge < other.edge; }
  };
  std::vector<End> ends;
  for (std::size_t e = 0; e < border.size(); ++e) ends.push_back({border[e].first, e}), ends.push_back({border[e].second, e});
  std::sort(ends.begin(), ends.end());
  std::vector<std::uint8_t> used(border.size(), 0);
  std::vector<std::vector<NodeIndex>> lines;
  for (std::size_t first = 0; first < border.size(); ++first) {
    if (used[first] != 0) continue;
    used[first] = 1;
    std::vector<NodeIndex> line{border[first].first};
    for (NodeIndex at = border[first].second; at != line.front();) {
      line.push_back(at);
      auto next = std::lower_bound(ends.begin(), ends.end(), End{at, 0});
      while (next != ends.end() && next->node == at && used[next->edge] != 0) ++next;
      if (next == ends.end() || next->node != at) break;
      used[next->edge] = 1;
      at = border[next->edge].first == at ? border[next->edge].second : border[next->edge].first;
    }
    lines.push_back(std::move(line));
  }
  std::stable_sort(lines.begin(), lines.end(), [&](const auto& a, const auto& b) { return length_of(model, a) > length_of(model, b); });
  return lines;
}

std::optional<BandShape> band_shape(const Model& model, const std::vector<BorderEdge>& border, double area, double max_width,
                                    double min_length_share) {
  const std::vector<std::vector<NodeIndex>> lines = border_lines(model, border);
  if (lines.empty() || lines.front().size() < 3) return std::nullopt;
  const ClosedLine outer(model, lines.front());
  if (!(outer.length() > 0) || !(area > 0)) return std::nullopt;
  const auto fits = [&](double width, double length) { return width <= max_width && length >= min_length_share * width; };
  std::optional<BandShape> shape;
  if (lines.size() > 1 && length_of(model, lines[1]) >= kMinSecondBorder * outer.length()) {
    const ClosedLine inner(model, lines[1]);
    if (fits(2 * area / (outer.length() + inner.length()), outer.length())) shape = ring(outer, inner, area);
  } else if (const std::optional<StripSize> size = strip_size(outer.length(), area); size && fits(size->width, size->length)) {
    shape = strip(outer, area, *size);
  }
  if (!shape || !(shape->length > 0) || !fits(shape->mean_width, shape->length)) return std::nullopt;
  return shape;
}

}  // namespace prismesh::mesh::connections
