#include "kiosk/render/contact_marks.h"

#include <utility>

namespace prismesh::kiosk::render {

namespace {

using Corners = std::array<std::uint32_t, 4>;

Result<void> upload(ContactMarks::Shells& shells, const std::vector<Corners>& corners) {
  shells.count = 0;
  if (const auto reserved = shells.connectivity.reserve(corners.size(), "shells that touch"); !reserved) return fail(reserved.error());
  shells.connectivity.upload(std::as_bytes(std::span(corners)));
  shells.count = corners.size();
  return {};
}

std::vector<Corners> corners_of(const ModelTable& table, std::span<const mesh::ShellIndex> shells) {
  std::vector<Corners> corners;
  mesh::ShellNodes nodes;
  for (const mesh::ShellIndex shell : shells)
    if (shell.value < table.shell_count() && table.shell(shell.value, nodes) && table.shell_visible(shell.value))
      corners.push_back({nodes.node[0].value, nodes.node[1].value, nodes.node[2].value, nodes.node[3].value});
  return corners;
}

}  // namespace

Result<void> ContactMarks::set(const ModelTable& table, const mesh::Vec3& origin, ContactPicture picture) {
  picture_ = std::move(picture);
  if (Result<void> done = update(table); !done) return done;
  std::vector<std::array<float, 4>> places;
  const auto lines_of = [&](const std::vector<std::array<mesh::Vec3, 2>>& segments) {
    std::vector<NodePair> lines;
    for (const std::array<mesh::Vec3, 2>& segment : segments) {
      const auto first = static_cast<std::uint32_t>(places.size());
      for (const mesh::Vec3& end : segment) {
        const Eigen::Vector3f at = (end - origin).cast<float>();
        places.push_back({at.x(), at.y(), at.z(), at.allFinite() ? 1.0F : 0.0F});
      }
      lines.push_back({first, first + 1});
    }
    return lines;
  };
  const std::vector<NodePair> curve = lines_of(picture_.curve), vectors = lines_of(picture_.vectors);
  if (const auto reserved = line_positions_.reserve(places.size(), "lines of contact"); !reserved) return fail(reserved.error());
  line_positions_.upload(std::as_bytes(std::span(places)));
  if (Result<void> done = curve_.upload(curve, "crossing curves"); !done) return done;
  return vectors_.upload(vectors, "ways out of contact");
}

Result<void> ContactMarks::update(const ModelTable& table) {
  if (Result<void> done = upload(chosen_, corners_of(table, picture_.chosen)); !done) return done;
  return upload(shells_, corners_of(table, picture_.shells));
}

void ContactMarks::clear() {
  picture_ = {};
  chosen_.count = shells_.count = curve_.count = vectors_.count = 0;
}

Result<void> ContactMarks::set_touching(const ModelTable& table, const PreviewPatch& patch, std::span<const mesh::ShellIndex> others) {
  if (Result<void> done = upload(moved_, patch.touching_corners()); !done) return done;
  return upload(touched_, corners_of(table, others));
}

std::size_t ContactMarks::bytes_uploaded() const {
  std::size_t bytes = line_positions_.bytes_uploaded() + curve_.texture.bytes_uploaded() + vectors_.texture.bytes_uploaded();
  for (const Shells* shells : {&chosen_, &shells_, &moved_, &touched_}) bytes += shells->connectivity.bytes_uploaded();
  return bytes;
}

}  // namespace prismesh::kiosk::render
