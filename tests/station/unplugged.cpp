#include "tests/station/unplugged.h"

#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>

namespace prismesh::test {

bool switch_outputs_off(const std::string& display) {
  Display* const server = XOpenDisplay(display.c_str());
  if (server == nullptr) return false;
  XRRScreenResources* const resources = XRRGetScreenResources(server, DefaultRootWindow(server));
  bool off = resources != nullptr && resources->ncrtc > 0;
  for (int i = 0; off && i < resources->ncrtc; ++i)
    off = XRRSetCrtcConfig(server, resources, resources->crtcs[i], CurrentTime, 0, 0, None, RR_Rotate_0, nullptr, 0) == RRSetConfigSuccess;
  if (resources != nullptr) XRRFreeScreenResources(resources);
  XCloseDisplay(server);
  return off;
}

}  // namespace prismesh::test
