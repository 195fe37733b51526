// The haptic field in shared memory: modeld writes it, the pen's process reads it. A new page for each process of the writer.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/haptic_field.h"
#include "ipc/wire/sealed_page.h"
#include "ipc/wire/seqlock.h"

namespace prismesh::ipc {

/// Field n is in slot n % 3. A slot is written again only after two newer fields were published, so a reader has that long to copy it. A
/// writer that dies while it writes leaves the newest whole field.
struct HapticFieldPageLayout {
  static constexpr const char* kName = "prismesh-haptic-field";
  static constexpr std::uint64_t kMagic = 0x3144'4C45'4946'5048;  // "HPFIELD1"
  static constexpr std::uint64_t kVersion = 1;
  static constexpr std::size_t kSlots = 3;
  std::uint64_t magic = 0;
  std::uint64_t version = 0;
  alignas(64) TurnCount newest;  ///< fields that were published
  std::array<HapticField, kSlots> slots;
  SeqlockSlot<HapticGuides> guides;
  SeqlockSlot<HapticResistance> resistance;
};

/// One thread writes.
class HapticFieldPage {
 public:
  static Result<HapticFieldPage> create() {
    return SealedPage<HapticFieldPageLayout>::create().map([](auto page) { return HapticFieldPage(std::move(page)); });
  }
  /// Copies the parts that are in use, and sets the field's `number`.
  void publish(const HapticField& field);
  void set_guides(const HapticGuides& guides) { page_->guides.write(guides); }
  void set_resistance(const HapticResistance& resistance) { page_->resistance.write(resistance); }
  const Descriptor& descriptor() const { return page_.descriptor(); }

 private:
  explicit HapticFieldPage(SealedPage<HapticFieldPageLayout> page) : page_(std::move(page)) {}
  SealedPage<HapticFieldPageLayout> page_;
};

class HapticFieldPageReader {
 public:
  /// Errors: as SealedPageReader::map.
  static Result<HapticFieldPageReader> map(const Descriptor& descriptor) {
    return SealedPageReader<HapticFieldPageLayout>::map(descriptor).map([](auto page) { return HapticFieldPageReader(std::move(page)); });
  }
  /// The number of the newest field; 0: none yet.
  std::uint64_t newest() const { return page_->newest.load(); }
  /// Copies the newest field's parts that are in use; what is copied never changes again, whatever the writer does. False if there is none,
  /// or if the writer was faster in each of several attempts; then `to` holds no field.
  bool read(HapticField& to) const;
  std::optional<HapticGuides> guides() const { return page_->guides.read(); }
  std::optional<HapticResistance> resistance() const { return page_->resistance.read(); }

 private:
  explicit HapticFieldPageReader(SealedPageReader<HapticFieldPageLayout> page) : page_(std::move(page)) {}
  SealedPageReader<HapticFieldPageLayout> page_;
};

}  // namespace prismesh::ipc
