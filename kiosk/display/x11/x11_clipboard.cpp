#include "kiosk/display/x11/x11_clipboard.h"

#include <poll.h>

#include <array>
#include <chrono>

#include <X11/Xatom.h>

namespace prismesh::kiosk::display::x11 {
namespace {

constexpr std::chrono::milliseconds kPatience{200};
constexpr long kMaxBytes = 65536;

}  // namespace

X11Clipboard::X11Clipboard(Display* display, ::Window window)
    : display_(display),
      window_(window),
      clipboard_(XInternAtom(display, "CLIPBOARD", False)),
      utf8_(XInternAtom(display, "UTF8_STRING", False)),
      targets_(XInternAtom(display, "TARGETS", False)),
      property_(XInternAtom(display, "PRISMESH_PASTED", False)) {}

std::optional<std::string> X11Clipboard::read() {
  if (display_ == nullptr) return std::nullopt;
  if (offered_) return offered_;
  if (XGetSelectionOwner(display_, clipboard_) == None) return std::nullopt;
  XConvertSelection(display_, clipboard_, utf8_, property_, window_, CurrentTime);
  XFlush(display_);
  XEvent event;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (XCheckTypedWindowEvent(display_, window_, SelectionNotify, &event) == False) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return std::nullopt;
    pollfd connection{ConnectionNumber(display_), POLLIN, 0};
    ::poll(&connection, 1, static_cast<int>(left.count()));
  }
  if (event.xselection.property == None) return std::nullopt;
  Atom type = None;
  int bits = 0;
  unsigned long count = 0, more = 0;
  unsigned char* bytes = nullptr;
  const int got =
      XGetWindowProperty(display_, window_, property_, 0, kMaxBytes / 4, True, AnyPropertyType, &type, &bits, &count, &more, &bytes);
  std::optional<std::string> text;
  if (got == Success && type == utf8_ && bits == 8 && more == 0) text.emplace(reinterpret_cast<const char*>(bytes), count);
  if (bytes != nullptr) XFree(bytes);
  return text;
}

void X11Clipboard::offer(const std::string& text) {
  if (display_ == nullptr) return;
  offered_ = text;
  XSetSelectionOwner(display_, clipboard_, window_, CurrentTime);
  XFlush(display_);
}

bool X11Clipboard::handle(const XEvent& event) {
  if (display_ == nullptr) return false;
  if (event.type == SelectionRequest) {
    answer(event.xselectionrequest);
    return true;
  }
  if (event.type != SelectionClear) return false;
  offered_.reset();
  return true;
}

void X11Clipboard::answer(const XSelectionRequestEvent& request) const {
  XEvent reply{};
  reply.xselection.type = SelectionNotify;
  reply.xselection.requestor = request.requestor;
  reply.xselection.selection = request.selection;
  reply.xselection.target = request.target;
  reply.xselection.time = request.time;
  reply.xselection.property = None;
  const Atom property = request.property != None ? request.property : request.target;
  if (offered_ && request.target == utf8_) {
    XChangeProperty(display_, request.requestor, property, utf8_, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(offered_->data()), static_cast<int>(offered_->size()));
    reply.xselection.property = property;
  } else if (offered_ && request.target == targets_) {
    const std::array<Atom, 2> offers{targets_, utf8_};
    XChangeProperty(display_, request.requestor, property, XA_ATOM, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(offers.data()), static_cast<int>(offers.size()));
    reply.xselection.property = property;
  }
  XSendEvent(display_, request.requestor, False, NoEventMask, &reply);
  XFlush(display_);
}

}  // namespace prismesh::kiosk::display::x11
