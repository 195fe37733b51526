#include "daemon/modeld/drag_session.h"

#include <utility>

namespace prismesh::modeld {

Result<DragSession> DragSession::begin(std::uint64_t number, const mesh::document::Document& document, const mesh::document::Edit& edit) {
  std::shared_ptr<const mesh::document::Generation> base = document.generations[document.cursor];
  Result<mesh::document::Drag> drag = mesh::document::Drag::begin(base, edit);
  if (!drag) return fail(std::move(drag.error()));
  Result<ipc::PreviewWriter> preview = ipc::PreviewWriter::create(number, base->number, drag->nodes(), drag->shells());
  if (!preview) return fail(std::move(preview.error()));
  return DragSession(number, std::move(base), std::move(*drag), std::move(*preview));
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
  preview_.publish(step.sequence, drag_.positions(), drag_.states(), drag_.counts());
  moved_ = true;
}

DragFeel DragSession::feel() {
  auto model = std::make_shared<mesh::Model>(base_->model);
  for (std::size_t i = 0; i < drag_.nodes().size(); ++i) model->positions.set(drag_.nodes()[i].value, drag_.positions()[i]);
  return {std::move(model), drag_.worsening()};
}

}  // namespace prismesh::modeld
