#include "kiosk/tools/shaping/typed_number.h"

#include <vector>

#include "kiosk/input/typed_numbers.h"
#include "kiosk/tools/shaping/falloff_direction.h"

namespace prismesh::kiosk::tools::shaping {

using input::Under;

Result<Pull> typed_displacement(Under handle, std::string_view text, const Pull& pulled) {
  const Result<std::vector<double>> numbers = input::parse_numbers(text);
  if (!numbers) return fail(numbers.error());
  const std::vector<double>& n = *numbers;
  Pull pull;
  if (handle == Under::slide_handle || handle == Under::move_handle) {
    if (n.size() == 3)
      pull.by = {n[0], n[1], n[2]};
    else if (n.size() != 1)
      return fail("", "type three numbers, x y z, or one: how far");
    else if (!(pulled.by.norm() > 0))
      return fail("", "one number says how far, not where to: pull a little first, or type x y z");
    else
      pull.by = pulled.by.normalized() * n[0];
    return pull;
  }
  if (n.size() != 1)
    return fail("", handle == Under::turn_handle ? "type one number: the angle in degrees" : "type one number: the distance");
  (handle == Under::turn_handle ? pull.degrees : pull.distance) = n[0];
  return pull;
}

std::string typed_hint(Under handle, const std::optional<Vec3>& along) {
  const std::string way = along ? components_text(*along) : std::string();
  switch (handle) {
    case Under::turn_handle: return "degrees about " + way;
    case Under::slide_handle:
    case Under::move_handle: return along ? "x y z, or how far along " + way : "x y z in the deck's axes";
    default: return along ? "distance along the arrow, " + way : "distance, each node along its own normal";
  }
}

}  // namespace prismesh::kiosk::tools::shaping
