// A drag under way: the core's drag and the preview page that its frames go to.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "ipc/model/messages.h"
#include "ipc/model/preview.h"
#include "mesh/contact/moved_shells.h"
#include "mesh/document/contacts.h"
#include "mesh/document/drag.h"

namespace prismesh::modeld {

/// What the haptic pen feels of a drag's step.
struct DragFeel {
  std::shared_ptr<const mesh::Model> model;  ///< with the displaced nodes
  mesh::document::Worsening worsening;
};

/// With more shells that move, steps would wait for the search for what they touch: then nothing is looked for.
inline constexpr std::size_t kMaxWatchedShells = 20'000;

class DragSession {
 public:
  /// The first drag of a document builds the tree of its shells in `contact`. Errors: as mesh::document::Drag::begin; no memory for the
  /// preview.
  static Result<DragSession> begin(std::uint64_t number, const mesh::document::Document& document, const mesh::document::Edit& edit,
                                   mesh::document::ContactSearch& contact);

  ipc::DragBegun begun() const;
  const ipc::Descriptor& preview() const { return preview_.descriptor(); }
  /// Computes the displaced nodes, the states of the shells they touch, and which of these come to touch others, and publishes them as a
  /// frame.
  void step(const ipc::DragStep& step);
  bool moved() const { return moved_; }
  /// At the last step.
  DragFeel feel();
  /// Returns the edit that the drag's last step amounts to.
  mesh::document::Edit edit() const { return drag_.edit(); }

 private:
  ipc::PreviewTouches touches();
  DragSession(std::uint64_t number, std::shared_ptr<const mesh::document::Generation> base, mesh::document::Drag drag,
              ipc::PreviewWriter preview)
      : number_(number), base_(std::move(base)), drag_(std::move(drag)), preview_(std::move(preview)) {}

  std::uint64_t number_ = 0;
  std::shared_ptr<const mesh::document::Generation> base_;
  mesh::document::Drag drag_;
  ipc::PreviewWriter preview_;
  std::optional<mesh::contact::MovedShells> watched_;  ///< nothing: too many shells move
  bool moved_ = false;
};

}  // namespace prismesh::modeld
