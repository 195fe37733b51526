// `prismesh-kiosk --render`: draws a snapshot into a file, without a screen. `prismesh render` runs it.
#pragma once

#include <span>
#include <string>

namespace prismesh::kiosk {

/// Arguments after the program's name: --render PNG --snapshot-fds TABLE,SEGMENT.. [--size WxH] [--profile NAME|FILE] [--eye X,Y,Z]
/// [--mask MM] [--view NAME] [--colour MODE] [--samples 1|4]. Returns the exit status (0 done, 1 the picture could not be made, 2 wrong
/// usage); reasons go to standard error.
int render_main(std::span<const std::string> arguments);

}  // namespace prismesh::kiosk
