// What is drawn where shells touch, on the GPU.
#pragma once

#include <cstddef>
#include <span>

#include "kiosk/render/contact_picture.h"
#include "kiosk/render/free_lines.h"
#include "kiosk/render/model_table.h"
#include "kiosk/render/preview_patch.h"

namespace prismesh::kiosk::render {

class ContactMarks {
 public:
  struct Shells {
    RowTexture connectivity{kFourIndices};
    std::size_t count = 0;
  };

  /// Errors: too large for the GPU, no graphics memory.
  Result<void> set(const ModelTable& table, const mesh::Vec3& origin, ContactPicture picture);
  /// After a change of the model that keeps its indices: shells of parts that were hidden meanwhile aren't drawn.
  Result<void> update(const ModelTable& table);
  void clear();
  /// What touches in a frame of a drag.
  Result<void> set_touching(const ModelTable& table, const PreviewPatch& patch, std::span<const mesh::ShellIndex> others);
  void end_touching() { moved_.count = touched_.count = 0; }

  const Shells& chosen() const { return chosen_; }
  const Shells& shells() const { return shells_; }
  const Shells& moved() const { return moved_; }      ///< into the preview's positions
  const Shells& touched() const { return touched_; }  ///< by them, shells of the model
  const FreeLines& curve() const { return curve_; }
  const FreeLines& vectors() const { return vectors_; }
  std::size_t bytes_uploaded() const;
  std::size_t bytes_held() const;

 private:
  ContactPicture picture_;
  Shells chosen_, shells_, moved_, touched_;
  FreeLines curve_, vectors_;
};

}  // namespace prismesh::kiosk::render
