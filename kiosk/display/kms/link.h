// The settings of a graphics card on which it depends whether each pixel of the picture reaches its pixel of the panel with its own colour:
// no scaling, no colour correction, no dithering, the full range of RGB. Sets them, and reads back what the driver made of them.
#pragma once

#include <string>
#include <vector>

#include "kiosk/display/kms/card.h"
#include "kiosk/display/kms/output.h"
#include "kiosk/display/monitor.h"

namespace prismesh::kiosk::display::kms {

/// A setting that shall have this value.
struct LinkWish {
  std::string what;      ///< "colour range"
  std::string property;  ///< the driver's name of it: "Broadcast RGB"
  Setting setting;
  std::string value_text;  ///< "Full"
};

/// The wishes that this driver has properties for.
std::vector<LinkWish> link_wishes(const CardState& card, const Output& output);

/// What became of the settings.
struct LinkFacts {
  std::vector<std::string> differ;    ///< sentences: what has another value than wanted
  std::vector<std::string> not_told;  ///< "colour range": what the driver has no property for
  bool scaled = false;                ///< the card scales
  bool turned = false;                ///< the card turns or mirrors the picture
  LinkColour colour = LinkColour::unknown;
};

/// Compares a card's state with the wishes of an output.
LinkFacts read_link(const CardState& card, const Output& output);

/// The output as the rest of the kiosk knows monitors.
Monitor monitor_of(const Output& output, const LinkFacts& facts);

}  // namespace prismesh::kiosk::display::kms
