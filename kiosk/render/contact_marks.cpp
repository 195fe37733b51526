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
  if (Result<void> done = curve_.set(picture_.curve, origin, "crossing curves"); !done) return done;
  return vectors_.set(picture_.vectors, origin, "ways out of contact");
}

Result<void> ContactMarks::update(const ModelTable& table) {
  if (Result<void> done = upload(chosen_, corners_of(table, picture_.chosen)); !done) return done;
  return upload(shells_, corners_of(table, picture_.shells));
}

void ContactMarks::clear() {
  picture_ = {};
  chosen_.count = shells_.count = 0;
  curve_.clear();
  vectors_.clear();
}

Result<void> ContactMarks::set_touching(const ModelTable& table, const PreviewPatch& patch, std::span<const mesh::ShellIndex> others) {
  if (Result<void> done = upload(moved_, patch.touching_corners()); !done) return done;
  return upload(touched_, corners_of(table, others));
}

std::size_t ContactMarks::bytes_held() const {
  std::size_t bytes = curve_.bytes_held() + vectors_.bytes_held();
  for (const Shells* shells : {&chosen_, &shells_, &moved_, &touched_}) bytes += shells->connectivity.bytes_held();
  return bytes;
}

std::size_t ContactMarks::bytes_uploaded() const {
  std::size_t bytes = curve_.bytes_uploaded() + vectors_.bytes_uploaded();
  for (const Shells* shells : {&chosen_, &shells_, &moved_, &touched_}) bytes += shells->connectivity.bytes_uploaded();
  return bytes;
}

}  // namespace prismesh::kiosk::render
