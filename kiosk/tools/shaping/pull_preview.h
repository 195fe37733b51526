// Shows the preview of a drag that the model server works on.
#pragma once

#include <cstdint>

#include "kiosk/link/remote_drag.h"
#include "kiosk/notices/trace.h"
#include "kiosk/render/renderer.h"

namespace prismesh::kiosk::tools::shaping {

class PullPreview {
 public:
  PullPreview(const link::RemoteDrag& drag, render::Renderer& renderer, notices::Trace trace)
      : drag_(drag), renderer_(renderer), trace_(trace) {}

  /// Gives the renderer the newest frame of the drag, or ends the preview where there is no drag. Errors: no graphics memory.
  Result<void> follow();

 private:
  const link::RemoteDrag& drag_;
  render::Renderer& renderer_;
  notices::Trace trace_;
  bool shown_ = false;
  std::uint64_t sequence_ = 0;  ///< of the frame that is shown; 0: none
};

}  // namespace prismesh::kiosk::tools::shaping
