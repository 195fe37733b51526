#include "ipc/pen/haptic_field_page.h"

#include <algorithm>
#include <cstddef>

namespace prismesh::ipc {
namespace {

/// Bytes of a field; both are multiples of 8.
struct Part {
  std::size_t begin = 0, size = 0;
};

std::size_t whole_words(std::size_t bytes) { return (bytes + 7) / 8 * 8; }

std::size_t nodes(const HapticBrick& brick) {
  std::size_t all = 1;
  for (const std::int32_t count : brick.count) all *= static_cast<std::size_t>(std::clamp(count, 0, kMaxBrickSide));
  return all;
}

constexpr std::size_t kFine = offsetof(HapticField, fine), kCoarse = offsetof(HapticField, coarse);
constexpr std::size_t kBrickHead = offsetof(HapticBrick, distance_mm);
constexpr std::size_t kMotion = offsetof(HapticField, max_moved_mm), kMoved = offsetof(HapticField, moved);
constexpr std::size_t kIndex = offsetof(HapticField, bucket_begin), kEntries = offsetof(HapticField, bucket_entry);
static_assert(kFine % 8 == 0 && kCoarse % 8 == 0 && kBrickHead % 8 == 0 && kMotion % 8 == 0 && kMoved % 8 == 0 && kIndex % 8 == 0 &&
              sizeof(HapticField) % 8 == 0 && offsetof(HapticBrick, still_mm) % 8 == 0 && offsetof(HapticBrick, nearest) % 8 == 0);

/// What says how much of the rest is in use.
constexpr std::array<Part, 4> kHeads{Part{0, kFine}, Part{kFine, kBrickHead}, Part{kCoarse, kBrickHead}, Part{kMotion, kMoved - kMotion}};

/// The rest that is in use, by the heads of a copy.
std::array<Part, 8> parts_in_use(const HapticField& field) {
  const std::size_t fine = whole_words(4 * nodes(field.fine)), coarse = whole_words(4 * nodes(field.coarse));
  const auto moved = static_cast<std::size_t>(std::clamp(field.moved_count, 0, kMaxMovedTriangles));
  return {Part{kFine + kBrickHead, fine},
          Part{kFine + offsetof(HapticBrick, still_mm), fine},
          Part{kFine + offsetof(HapticBrick, nearest), fine},
          Part{kCoarse + kBrickHead, coarse},
          Part{kCoarse + offsetof(HapticBrick, still_mm), coarse},
          Part{kCoarse + offsetof(HapticBrick, nearest), coarse},
          Part{kMoved, moved * sizeof(MovedTriangle)},
          Part{kIndex, moved > 0 ? whole_words(kEntries - kIndex) : 0}};
}
static_assert(sizeof(MovedTriangle) % 8 == 0);

/// The buckets' entries, by their index of a copy. They begin within a word that the index has copied.
Part entries_in_use(const HapticField& field) {
  if (field.moved_count <= 0) return {};
  const std::size_t count = std::min<std::size_t>(field.bucket_begin[kBuckets], kMaxBucketEntries);
  const std::size_t begin = kEntries / 8 * 8;
  return {begin, std::min(whole_words(kEntries - begin + 2 * count), sizeof(HapticField) - begin)};
}

std::uint64_t* words(HapticField& field, const Part& part) {
  return reinterpret_cast<std::uint64_t*>(reinterpret_cast<std::byte*>(&field) + part.begin);
}
const std::uint64_t* words(const HapticField& field, const Part& part) {
  return reinterpret_cast<const std::uint64_t*>(reinterpret_cast<const std::byte*>(&field) + part.begin);
}

}  // namespace

void HapticFieldPage::publish(const HapticField& field) {
  const std::uint64_t next = page_->newest.load() + 1;
  HapticField& slot = page_->slots[next % HapticFieldPageLayout::kSlots];
  const auto copy = [&](const Part& part) { store_words(words(slot, part), words(field, part), part.size / 8); };
  for (const Part& part : kHeads) copy(part);
  for (const Part& part : parts_in_use(field)) copy(part);
  copy(entries_in_use(field));
  static_assert(offsetof(HapticField, number) == 0);
  store_words(words(slot, {0, 8}), &next, 1);
  page_->newest.store(next);
}

bool HapticFieldPageReader::read(HapticField& to) const {
  for (int attempt = 0; attempt < 4; ++attempt) {
    const std::uint64_t number = newest();
    if (number == 0) break;
    const HapticField& slot = page_->slots[number % HapticFieldPageLayout::kSlots];
    const auto copy = [&](const Part& part) { load_words(words(to, part), words(slot, part), part.size / 8); };
    for (const Part& part : kHeads) copy(part);
    for (const Part& part : parts_in_use(to)) copy(part);
    copy(entries_in_use(to));
    // The slot's next field is begun after the one before it was published.
    if (newest() - number < HapticFieldPageLayout::kSlots - 1 && to.number == number) return true;
  }
  to.fine.count[0] = to.coarse.count[0] = to.moved_count = 0;
  to.number = 0;
  return false;
}

}  // namespace prismesh::ipc
