// The clipboard that programs of an X11 display share: the selection CLIPBOARD (ICCCM 2.0, section 2).
#pragma once

#include <optional>
#include <string>

#include <X11/Xlib.h>

namespace prismesh::kiosk::display::x11 {

class X11Clipboard {
 public:
  X11Clipboard() = default;
  X11Clipboard(Display* display, ::Window window);

  /// What another program, or this one, has put there; UTF-8. Waits at most 0.2 s for its owner. Texts over 64 KiB and texts that come in
  /// pieces count as none.
  std::optional<std::string> read();
  void offer(const std::string& text);
  /// Answers programs that ask for what was offered. False: the event isn't about the clipboard.
  bool handle(const XEvent& event);

 private:
  void answer(const XSelectionRequestEvent& request) const;

  Display* display_ = nullptr;
  ::Window window_ = 0;
  Atom clipboard_ = 0, utf8_ = 0, targets_ = 0, property_ = 0;
  std::optional<std::string> offered_;
};

}  // namespace prismesh::kiosk::display::x11
