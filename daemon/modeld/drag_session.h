// A drag under way: the core's drag and the preview page that its frames go to.
#pragma once

#include <memory>

#include "ipc/model/messages.h"
#include "ipc/model/preview.h"
#include "mesh/document/drag.h"

namespace prismesh::modeld {

/// What the haptic pen feels of a drag's step.
struct DragFeel {
  std::shared_ptr<const mesh::Model> model;  ///< with the displaced nodes
  mesh::document::Worsening worsening;
};

class DragSession {
 public:
  /// Errors: as mesh::document::Drag::begin; no memory for the preview.
  static Result<DragSession> begin(std::uint64_t number, const mesh::document::Document& document, const mesh::document::Edit& edit);

  ipc::DragBegun begun() const;
  const ipc::Descriptor& preview() const { return preview_.descriptor(); }
  /// Computes the displaced nodes and the states of the shells they touch, and publishes them as a frame.
  void step(const ipc::DragStep& step);
  bool moved() const { return moved_; }
  /// At the last step.
  DragFeel feel();
  /// Returns the edit that the drag's last step amounts to.
  mesh::document::Edit edit() const { return drag_.edit(); }

 private:
  DragSession(std::uint64_t number, std::shared_ptr<const mesh::document::Generation> base, mesh::document::Drag drag,
              ipc::PreviewWriter preview)
      : number_(number), base_(std::move(base)), drag_(std::move(drag)), preview_(std::move(preview)) {}

  std::uint64_t number_ = 0;
  std::shared_ptr<const mesh::document::Generation> base_;
  mesh::document::Drag drag_;
  ipc::PreviewWriter preview_;
  bool moved_ = false;
};

}  // namespace prismesh::modeld
