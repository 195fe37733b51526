// Makes the display profiles of drivers/display available in the kiosk's namespace.
#pragma once

#include "drivers/display/profile.h"

namespace prismesh::kiosk::stereo {

using drivers::display::built_in_profiles;
using drivers::display::find_profile;
using drivers::display::Profile;
using drivers::display::screen_size_mm;
using drivers::display::Subpixels;
using drivers::display::Weave;

}  // namespace prismesh::kiosk::stereo
