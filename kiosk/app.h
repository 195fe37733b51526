// Runs the kiosk as a program: in a window, or headless with pictures in a folder.
#pragma once

#include "kiosk/app_options.h"

namespace prismesh::kiosk {

/// Runs until the window is closed or the pictures are written. Returns the exit status: 0 done, 1 failed; reasons go to standard error.
int run_app(const AppOptions& options);

}  // namespace prismesh::kiosk
