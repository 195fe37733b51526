#include "kiosk/toolkit/words_on_thickness.h"

#include "base/counted.h"

namespace prismesh::kiosk::toolkit {

std::string words_on_thickness(std::span<const ipc::SnapshotPart> parts) {
  std::size_t without = 0, uneven = 0;
  for (const ipc::SnapshotPart& part : parts) {
    if (part.shells == 0) continue;
    if (!(part.thinnest > 0)) ++without;
    if (part.thinnest > 0 && part.thickest > part.thinnest) ++uneven;
  }
  std::string words;
  if (without > 0)
    words = counted(without, "part") + " with shells without thickness " + (without == 1 ? "is" : "are") + " drawn as surfaces";
  if (uneven > 0)
    words += (words.empty() ? "" : "; ") + counted(uneven, "part") + " with shells of different thickness " +
             (uneven == 1 ? "has" : "have") + " the mean of the thinnest and the thickest";
  return words;
}

}  // namespace prismesh::kiosk::toolkit
