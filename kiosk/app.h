// The kiosk as a program: a window (or pictures in a folder), the loop that waits for the hand and the model server, and drawing
// when something changed.
#pragma once

#include "kiosk/app_options.h"

namespace prismesh::kiosk {

/// Runs until the window is closed or the pictures are written. Returns the exit status: 0 done, 1 it couldn't be done;
/// reasons go to standard error.
int run_app(const AppOptions& options);

}  // namespace prismesh::kiosk
