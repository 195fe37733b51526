// A question to answer before unsaved edits or files would be lost. Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::panels {

enum class Reply : std::uint8_t { cancel, save, keep, discard, write };

struct Question {
  /// Files or folders that something would happen to.
  struct List {
    std::string heading;
    std::vector<std::string> paths;
  };
  /// A button and its key.
  struct Choice {
    Reply reply = Reply::cancel;
    std::string label;
    display::Key key = display::Key::none;
    std::string key_name;
  };

  std::string title;
  std::string text;  ///< a sentence or two; may be empty
  std::vector<List> lists;
  std::vector<Choice> choices;  ///< the last one does nothing
};

}  // namespace prismesh::kiosk::panels
