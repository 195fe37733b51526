#include "daemon/modeld/drag_session.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace prismesh::modeld {

Result<DragSession> DragSession::begin(std::uint64_t number, const mesh::document::Document& document, const mesh::document::Edit& edit,
                                       mesh::document::ContactSearch& contact) {
  std::shared_ptr<const mesh::document::Generation> base = document.generations[document.cursor];
  Result<mesh::document::Drag> drag = mesh::document::Drag::begin(base, edit, &contact);
  if (!drag) return fail(std::move(drag.error()));
  Result<ipc::PreviewWriter> preview = ipc::PreviewWriter::create(number, base->number, drag->nodes(), drag->shells());
  if (!preview) return fail(std::move(preview.error()));
  DragSession session(number, std::move(base), std::move(*drag), std::move(*preview));
  const mesh::Model& model = session.base_->model;
  if (session.drag_.shells().size() <= kMaxWatchedShells)
    session.watched_.emplace(model, contact.tree(model), contact.thickness(*session.base_), session.drag_.nodes(), session.drag_.shells());
  return session;
}

ipc::DragBegun DragSession::begun() const {
  const mesh::Model& model = base_->model;
  ipc::DragBegun begun;
  begun.drag = number_;
  begun.base_generation = base_->number;
  begun.nodes = drag_.nodes().size();
  if (drag_.grab().valid()) {
    const mesh::Vec3& at = model.position(drag_.grab());
    begun.grab = model.node_ids[drag_.grab().value];
    begun.grab_position = {at.x(), at.y(), at.z()};
  }
  begun.normal = {drag_.normal().x(), drag_.normal().y(), drag_.normal().z()};
  return begun;
}

void DragSession::step(const ipc::DragStep& step) {
  drag_.step({mesh::Vec3(step.by[0], step.by[1], step.by[2]), step.distance, step.degrees});
  preview_.publish(step.sequence, drag_.positions(), drag_.states(), drag_.counts(), touches());
  moved_ = true;
}

ipc::PreviewTouches DragSession::touches() {
  ipc::PreviewTouches told;
  told.watched = watched_.has_value();
  if (!watched_) return told;
  const std::vector<mesh::contact::Touch> found = watched_->at(drag_.positions());
  if (found.empty()) return told;
  const mesh::ShellSet& shells = drag_.shells();
  told.moved.resize((shells.size() + 63) / 64);
  for (const mesh::contact::Touch& touch : found) {
    const auto at = static_cast<std::size_t>(std::lower_bound(shells.begin(), shells.end(), touch.moved) - shells.begin());
    told.moved[at / 64] |= std::uint64_t{1} << (at % 64);
    told.others.push_back(touch.other);
  }
  std::sort(told.others.begin(), told.others.end());
  told.others.erase(std::unique(told.others.begin(), told.others.end()), told.others.end());
  if (told.others.size() > ipc::kMaxTouchedOthers) told.others.resize(ipc::kMaxTouchedOthers);
  const mesh::contact::TouchSummary summary = mesh::contact::summary_of(base_->model, found);
  told.parts = summary.parts;
  told.part_a = summary.part_a, told.part_b = summary.part_b;
  told.cross = summary.cross;
  told.depth = summary.depth;
  return told;
}

DragFeel DragSession::feel() {
  auto model = std::make_shared<mesh::Model>(base_->model);
  for (std::size_t i = 0; i < drag_.nodes().size(); ++i) model->positions.set(drag_.nodes()[i].value, drag_.positions()[i]);
  return {std::move(model), drag_.worsening()};
}

}  // namespace prismesh::modeld
