// Views that several kiosks share: tells the others where this one looks from, and follows them.
#pragma once

#include <optional>

#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::tools::view {

class SharedView {
 public:
  explicit SharedView(toolkit::ToolContext& context) : context_(context) {}

  /// Tells the other kiosks the view, if it has changed.
  void share();
  /// Takes the view that another kiosk has told. False: none has.
  bool take();

 private:
  toolkit::ToolContext& context_;
  std::optional<ipc::Camera> shared_;  ///< told or heard last
};

}  // namespace prismesh::kiosk::tools::view
