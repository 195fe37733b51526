#include "kiosk/item_trace.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace prismesh::kiosk {

void ItemTrace::tell(const notices::Trace& trace, std::vector<panels::ScreenItem> items) {
  if (!trace.on()) return;
  std::ranges::sort(items, {}, &panels::ScreenItem::name);
  for (const panels::ScreenItem& item : items)
    if (!std::ranges::binary_search(told_, item.name, {}, &panels::ScreenItem::name) ||
        *std::ranges::lower_bound(told_, item.name, {}, &panels::ScreenItem::name) != item)
      trace.line(fmt::format("item \"{}\" {:.0f} {:.0f} {:.0f} {:.0f} {}", item.name, item.place.x, item.place.y, item.place.width,
                             item.place.height, item.state));
  for (const panels::ScreenItem& item : told_)
    if (!std::ranges::binary_search(items, item.name, {}, &panels::ScreenItem::name))
      trace.line(fmt::format("item \"{}\" gone", item.name));
  told_ = std::move(items);
}

}  // namespace prismesh::kiosk
