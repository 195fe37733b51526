// Shows the preview of a drag that the model server works on.
#pragma once

#include <cstdint>

#include "kiosk/render/renderer.h"
#include "kiosk/tools/model_link.h"
#include "kiosk/tools/trace.h"

namespace prismesh::kiosk::tools::shaping {

class PullPreview {
 public:
  PullPreview(ModelLink& link, render::Renderer& renderer, Trace trace) : link_(link), renderer_(renderer), trace_(trace) {}

  /// Gives the renderer the newest frame of the drag, or ends the preview where there is no drag. Errors: no graphics memory.
  Result<void> follow();

 private:
  ModelLink& link_;
  render::Renderer& renderer_;
  Trace trace_;
  bool shown_ = false;
  std::uint64_t sequence_ = 0;  ///< of the frame that is shown; 0: none
};

}  // namespace prismesh::kiosk::tools::shaping
