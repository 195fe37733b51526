// What is asked before something of the user's would be lost or replaced. Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::tools {

enum class Reply : std::uint8_t { cancel, save, discard, write };

struct Question {
  /// What would happen to files or folders.
  struct List {
    std::string heading;
    std::vector<std::string> paths;
  };
  /// A button, and the key that does the same.
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

}  // namespace prismesh::kiosk::tools
