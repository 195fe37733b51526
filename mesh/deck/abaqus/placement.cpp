#include "mesh/deck/abaqus/placement.h"

#include <limits>
#include <string>
#include <vector>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// Up to `max` numbers of the block's data lines, three a point: each line is filled up with zeros to whole points. What is no number is
/// NaN.
std::vector<double> numbers_of(const DeckOutline& outline, const Block& block, std::size_t max) {
  std::vector<double> numbers;
  for (std::uint32_t s = 0; s < block.segments; ++s) {
    const Segment& segment = outline.segments[block.first_segment + s];
    DataLines lines(outline.text(segment.file), segment.begin, segment.end);
    DataLine line;
    while (numbers.size() < max && lines.next(line)) {
      Fields fields(line.text);
      std::string_view field;
      for (double value = 0; numbers.size() < max && fields.next(field);) {
        if (!parse_real(field, value)) value = std::numeric_limits<double>::quiet_NaN();
        numbers.push_back(value);
      }
      while (numbers.size() % 3 != 0) numbers.push_back(0);
    }
  }
  return numbers;
}

Eigen::Vector3d point(const std::vector<double>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

}  // namespace

Frame::Kind frame_kind(std::string_view system) {
  const std::string name = label(system);
  if (name == "C") return Frame::Kind::cylindrical;
  return name == "S" ? Frame::Kind::spherical : Frame::Kind::rectangular;
}

std::optional<Eigen::Affine3d> system_of(const DeckOutline& outline, const Block& block) {
  const std::vector<double> numbers = numbers_of(outline, block, 9);
  Eigen::Affine3d system = Eigen::Affine3d::Identity();
  if (numbers.size() >= 3) system.translation() = point(numbers, 0);
  if (numbers.size() >= 6) {
    const Eigen::Vector3d x = point(numbers, 3) - system.translation();
    // Without a third point the system is turned about the global z axis.
    const Eigen::Vector3d in_plane = numbers.size() >= 9 ? Eigen::Vector3d(point(numbers, 6) - system.translation())
                                                         : Eigen::Vector3d(Eigen::Vector3d::UnitZ().cross(x));
    const Eigen::Vector3d z = x.cross(in_plane);
    if (!(x.norm() > 0) || !(z.norm() > 1e-12 * x.norm() * in_plane.norm())) return std::nullopt;
    system.linear().col(0) = x.normalized();
    system.linear().col(2) = z.normalized();
    system.linear().col(1) = z.normalized().cross(x.normalized());
  }
  if (!system.matrix().allFinite()) return std::nullopt;
  return system;
}

std::optional<Eigen::Affine3d> instance_place(const DeckOutline& outline, const Block& block) {
  const std::vector<double> numbers = numbers_of(outline, block, 10);
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  if (numbers.size() >= 3) place.translation() = point(numbers, 0);
  if (numbers.size() >= 10) {
    const Eigen::Vector3d from = point(numbers, 3);
    const Eigen::Vector3d axis = point(numbers, 6) - from;
    const double degrees = numbers[9];
    if (degrees != 0 && !(axis.squaredNorm() > 0)) return std::nullopt;
    place = Eigen::Translation3d(from) * Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()) * Eigen::Translation3d(-from) * place;
  }
  if (!place.matrix().allFinite()) return std::nullopt;
  return place;
}

}  // namespace prismesh::mesh::deck::abaqus
