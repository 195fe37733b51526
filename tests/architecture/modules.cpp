#include "tests/architecture/modules.h"

#include <algorithm>
#include <map>
#include <set>

#include "tests/architecture/cycles.h"

namespace prismesh::architecture {

const std::vector<Module>& modules() {
  static const std::vector<Module> kModules{
      {"base", {}},
      {"base/json", {"base"}},

      {"mesh/model", {"base"}},
      {"mesh/deck/text", {"base"}},
      {"mesh/deck/data", {"mesh/model"}},
      {"mesh/deck/assembly", {"mesh/deck/data", "mesh/deck/text"}},
      {"mesh/deck/writing", {"mesh/deck/data"}},
      {"mesh/deck/lsdyna", {"mesh/deck/assembly", "mesh/deck/writing"}},
      {"mesh/deck/nastran", {"mesh/deck/assembly", "mesh/deck/writing"}},
      {"mesh/deck/radioss", {"mesh/deck/assembly", "mesh/deck/writing"}},
      {"mesh/deck/abaqus", {"mesh/deck/assembly", "mesh/deck/writing"}},
      {"mesh/deck/formats", {"mesh/deck/lsdyna", "mesh/deck/nastran", "mesh/deck/radioss", "mesh/deck/abaqus"}},
      {"mesh/deck/editing", {"mesh/deck/formats"}},
      {"mesh/deck/sample", {"mesh/model"}},
      {"mesh/deck", {"mesh/deck/editing", "mesh/deck/sample"}},
      {"mesh/spatial", {"mesh/model"}},
      {"mesh/field", {"mesh/spatial"}},
      {"mesh/lod", {"mesh/spatial"}},
      {"mesh/measure", {"mesh/spatial"}},
      {"mesh/quality", {"mesh/model"}},
      {"mesh/connections", {"mesh/quality", "mesh/spatial"}},
      {"mesh/contact", {"mesh/connections"}},
      {"mesh/select", {"mesh/connections"}},
      {"mesh/shape", {"mesh/connections"}},
      {"mesh/relax", {"mesh/quality", "mesh/spatial"}},
      {"mesh/repair", {"mesh/relax"}},
      {"mesh/document", {"base/json", "mesh/contact", "mesh/deck", "mesh/repair", "mesh/select", "mesh/shape"}},
      {"mesh/report", {"mesh/document"}},
      {"mesh/batch", {"base/json", "mesh/report"}},

      {"drivers/settings", {"drivers/haptic_pen"}},
      {"drivers/port", {"base"}},
      {"drivers/display", {"base"}},
      {"drivers/eye_tracker", {"drivers/port"}},
      {"drivers/eye_tracker/dynasight", {"drivers/eye_tracker", "drivers/settings"}},
      {"drivers/eye_tracker/opentrack", {"drivers/eye_tracker", "drivers/settings"}},
      {"drivers/eye_tracker/configured", {"drivers/eye_tracker/dynasight", "drivers/eye_tracker/opentrack"}},
      {"drivers/prism_servo", {"drivers/display", "drivers/eye_tracker"}},
      {"drivers/prism_servo/dynamixel", {"drivers/prism_servo", "drivers/settings"}},
      {"drivers/haptic_pen", {"base"}},
      {"drivers/haptic_pen/framed", {"drivers/haptic_pen", "drivers/port"}},
      {"drivers/haptic_pen/falcon", {"drivers/haptic_pen", "drivers/port"}},
      {"drivers/haptic_pen/inverse3", {"base/json", "drivers/haptic_pen", "drivers/port"}},
      {"drivers/haptics", {"drivers/haptic_pen"}},
      {"drivers/space_mouse", {"drivers/port"}},

      {"ipc/wire", {"base/json"}},
      {"ipc/device", {"ipc/wire", "drivers/prism_servo"}},
      {"ipc/pen", {"ipc/wire", "drivers/haptics"}},
      {"ipc/import", {"ipc/wire", "mesh/deck"}},
      {"ipc/model", {"ipc/wire", "mesh/document"}},
      {"ipc/store", {"ipc/wire"}},
      {"ipc/intake", {"ipc/wire"}},
      {"ipc/setup", {"ipc/wire", "drivers/display"}},
      {"ipc/remote", {"ipc/intake", "ipc/store"}},
      {"ipc/vault", {"ipc/store"}},

      {"daemon/common", {"ipc/wire"}},
      {"daemon/import", {"ipc/import", "daemon/common"}},
      {"daemon/setup", {"ipc/setup", "daemon/common", "drivers/settings"}},
      {"daemon/intake/store", {"ipc/store"}},
      {"daemon/intake/access", {"daemon/intake/store", "ipc/intake"}},
      {"daemon/intake/http", {"daemon/intake/access"}},
      {"daemon/intake/api", {"daemon/intake/http"}},
      {"daemon/intake/tls", {"daemon/intake/api"}},
      {"daemon/intake", {"daemon/intake/tls", "daemon/common", "drivers/settings"}},
      {"daemon/modeld",
       {"ipc/import", "ipc/intake", "ipc/store", "ipc/model", "ipc/pen", "mesh/field", "daemon/common", "drivers/settings"}},
      {"daemon/deviced/realtime", {"base"}},
      {"daemon/deviced/pen",
       {"ipc/pen", "daemon/common", "daemon/deviced/realtime", "drivers/haptic_pen/falcon", "drivers/haptic_pen/framed",
        "drivers/haptic_pen/inverse3", "drivers/settings"}},
      {"daemon/deviced",
       {"ipc/device", "daemon/common", "daemon/deviced/pen", "drivers/eye_tracker/configured", "drivers/prism_servo/dynamixel"}},

      {"kiosk/display", {"drivers/display"}},
      {"kiosk/display/kms", {"kiosk/display", "drivers/settings"}},
      {"kiosk/display/x11", {"kiosk/display"}},
      {"kiosk/stereo", {"ipc/device", "ipc/model"}},
      {"kiosk/render", {"kiosk/stereo", "mesh/lod"}},
      {"kiosk/input", {"kiosk/display", "mesh/document"}},
      {"kiosk/notices", {"mesh/deck/data"}},
      {"kiosk/panels", {"kiosk/input", "kiosk/notices"}},
      {"kiosk/link", {"kiosk/notices", "ipc/model", "ipc/pen"}},
      {"kiosk/toolkit", {"kiosk/link", "kiosk/panels", "kiosk/render", "drivers/space_mouse"}},
      {"kiosk/tools/files", {"kiosk/toolkit", "ipc/intake", "ipc/store"}},
      {"kiosk/tools/find", {"kiosk/toolkit"}},
      {"kiosk/tools/comparison", {"kiosk/toolkit"}},
      {"kiosk/tools/contact", {"kiosk/toolkit"}},
      {"kiosk/tools/cutting", {"kiosk/toolkit", "mesh/measure"}},
      {"kiosk/tools/tour", {"kiosk/toolkit"}},
      {"kiosk/tools/exhibition", {"kiosk/toolkit"}},
      {"kiosk/tools/welding", {"kiosk/toolkit"}},
      {"kiosk/tools/measuring", {"kiosk/toolkit", "mesh/measure"}},
      {"kiosk/tools/selection", {"kiosk/toolkit"}},
      {"kiosk/tools/shaping", {"kiosk/toolkit"}},
      {"kiosk/tools/pen", {"kiosk/toolkit", "mesh/field"}},
      {"kiosk/tools/space_mouse", {"kiosk/toolkit"}},
      {"kiosk/tools/quality", {"kiosk/toolkit"}},
      {"kiosk/tools/mesh_operations", {"kiosk/toolkit"}},
      {"kiosk/tools/parts", {"kiosk/toolkit"}},
      {"kiosk/tools/history", {"kiosk/toolkit"}},
      {"kiosk/tools/view", {"kiosk/toolkit"}},
      {"kiosk/calibration", {"kiosk/display", "kiosk/render"}},
      {"kiosk/setup", {"kiosk/panels", "ipc/setup"}},
      {"kiosk",
       {"kiosk/tools/files",     "kiosk/tools/find",    "kiosk/tools/comparison", "kiosk/tools/contact",    "kiosk/tools/selection",
        "kiosk/tools/cutting",   "kiosk/tools/welding", "kiosk/tools/tour",       "kiosk/tools/exhibition", "kiosk/tools/space_mouse",
        "kiosk/tools/measuring", "kiosk/tools/shaping", "kiosk/tools/pen",        "kiosk/tools/quality",    "kiosk/tools/mesh_operations",
        "kiosk/tools/parts",     "kiosk/tools/history", "kiosk/tools/view",       "kiosk/calibration",      "kiosk/display/kms",
        "kiosk/display/x11",     "kiosk/setup",         "drivers/settings"}},

      {"cli",
       {"ipc/device", "ipc/import", "ipc/model", "ipc/pen", "ipc/remote", "ipc/vault", "mesh/batch", "mesh/measure", "drivers/settings"}},
      {"python", {"mesh/report"}},
  };
  return kModules;
}

std::vector<std::string> table_faults(const std::vector<Module>& table, const std::vector<std::string>& folders) {
  std::vector<std::string> faults;
  std::set<std::string> named;
  for (const Module& module : table) {
    if (!named.insert(module.folder).second) faults.push_back(module.folder + " is named twice");
    if (std::find(folders.begin(), folders.end(), module.folder) == folders.end())
      faults.push_back(module.folder + " is a module without sources");
  }
  for (const std::string& folder : folders)
    if (!named.contains(folder)) faults.push_back(folder + " holds sources and is missing in the table of modules");
  Graph graph;
  for (const Module& module : table)
    for (const std::string& used : module.uses) {
      if (!named.contains(used)) faults.push_back(module.folder + " uses " + used + ", which is no module");
      graph[module.folder].insert(used);
    }
  for (const std::string& cycle : cycles(graph)) faults.push_back("modules use each other: " + cycle);
  return faults;
}

}  // namespace prismesh::architecture
