// Shows the preview of a drag that the model server works on.
#pragma once

#include <cstdint>

#include "kiosk/link/model_link.h"
#include "kiosk/notices/trace.h"
#include "kiosk/render/renderer.h"

namespace prismesh::kiosk::tools::shaping {

class PullPreview {
 public:
  PullPreview(link::ModelLink& link, render::Renderer& renderer, notices::Trace trace) : link_(link), renderer_(renderer), trace_(trace) {}

  /// Gives the renderer the newest frame of the drag, or ends the preview where there is no drag. Errors: no graphics memory.
  Result<void> follow();

 private:
  link::ModelLink& link_;
  render::Renderer& renderer_;
  notices::Trace trace_;
  bool shown_ = false;
  std::uint64_t sequence_ = 0;  ///< of the frame that is shown; 0: none
};

}  // namespace prismesh::kiosk::tools::shaping
