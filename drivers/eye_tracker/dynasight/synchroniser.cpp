#include "drivers/eye_tracker/dynasight/synchroniser.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

constexpr std::int32_t kMaxStepUnits = static_cast<std::int32_t>(kMaxStepMm / kUnitMm);
// A coordinate whose high byte looks like a marker is at least this large, whatever the exponent: 1433.6 mm. Nobody who looks at the
// display is there, and this is what tells a stream cut one byte early from the right one: there x begins with the second marker.
constexpr std::int32_t kMarkerUnits = 0x7000;
constexpr std::int32_t kFarthestUnits = static_cast<std::int32_t>(5000 / kUnitMm);

bool in_range(const Record& record) {
  for (const std::int16_t number : record.numbers)
    if (is_marker(static_cast<std::byte>(static_cast<std::uint16_t>(number) >> 8))) return false;
  if (!record.sees_head()) return true;
  return std::abs(record.units(0)) < kMarkerUnits && std::abs(record.units(1)) < kMarkerUnits && record.units(2) > 0 &&
         record.units(2) < kFarthestUnits;
}

bool continues(const Record& before, const Record& after) {
  if (before.target != after.target) return false;
  if (!before.sees_head() || !after.sees_head()) return true;  // a search's coordinates mean nothing
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::abs(after.units(axis) - before.units(axis)) > kMaxStepUnits) return false;
  return true;
}

}  // namespace

RecordBytes Synchroniser::window() const {
  RecordBytes bytes{};
  for (std::size_t i = 0; i < kRecordBytes; ++i) bytes[i] = ring_[(at_ + i) % kRecordBytes];
  return bytes;
}

void Synchroniser::follow(Cut& cut, const std::optional<Record>& record) {
  if (!record) {
    cut = {};
    return;
  }
  cut.markers = std::min(cut.markers + 1, kAgreeingRecordsRivalled);
  if (!in_range(*record))
    cut.agreeing = 0;
  else
    cut.agreeing = continues(cut.last, *record) ? std::min(cut.agreeing + 1, kAgreeingRecordsRivalled) : 1;
  cut.last = *record;
}

bool Synchroniser::convincing(std::size_t at) const {
  const std::optional<Record>& head = locked_ ? trusted_ : remembered_;
  if (head && cuts_[at].last.sees_head() && continues(*head, cuts_[at].last)) return cuts_[at].agreeing >= kAgreeingRecordsToRegain;
  int needed = kAgreeingRecords;
  for (std::size_t other = 0; other < kRecordBytes; ++other)
    if (other != at && cuts_[other].markers >= kAgreeingRecords - 1) needed = kAgreeingRecordsRivalled;
  return cuts_[at].agreeing >= needed;
}

std::optional<Heard> Synchroniser::take(std::byte byte) {
  ring_[at_] = byte;
  at_ = (at_ + 1) % kRecordBytes;
  ++unclaimed_;
  if (remembered_ && ++since_loss_ > kRegainBytes) remembered_.reset();
  const std::size_t cut = at_;  // named by where in the ring its records end
  const std::optional<Record> record = decode(window());
  follow(cuts_[cut], record);
  if (locked_ == cut) return take_record(record);

  if (locked_ && cuts_[*locked_].agreeing == 0 && convincing(cut)) lose();
  if (locked_) return std::nullopt;
  if (convincing(cut)) {
    const bool whole = unclaimed_ >= kRecordBytes;
    skipped_ += whole ? unclaimed_ - kRecordBytes : unclaimed_;
    unclaimed_ = 0;
    lock(cut, *record);
    if (whole) return Heard{*record, false};
  } else if (unclaimed_ > kRecordBytes) {
    ++skipped_;
    --unclaimed_;
  }
  return std::nullopt;
}

std::optional<Heard> Synchroniser::take_record(const std::optional<Record>& record) {
  if (record) {
    bad_ = 0;
    unclaimed_ = 0;
    return Heard{*record, believe(*record)};
  }
  skipped_ += unclaimed_;
  unclaimed_ = 0;
  if (++bad_ >= kBadRecordsToLoss) lose();
  return std::nullopt;
}

bool Synchroniser::believe(const Record& record) {
  if (!record.sees_head()) {
    trusted_.reset();
    candidate_.reset();
    return false;
  }
  if (!in_range(record)) return false;
  const bool follows = (trusted_ && continues(*trusted_, record)) || (candidate_ && continues(*candidate_, record));
  if (follows) {
    trusted_ = record;
    candidate_.reset();
  } else {
    candidate_ = record;
  }
  return follows;
}

void Synchroniser::lock(std::size_t at, const Record& record) {
  locked_ = at;
  bad_ = 0;
  trusted_ = std::exchange(remembered_, std::nullopt);
  candidate_.reset();
  if (record.sees_head()) candidate_ = record;
}

void Synchroniser::lose() {
  locked_.reset();
  bad_ = 0;
  remembered_ = std::exchange(trusted_, std::nullopt);
  since_loss_ = 0;
  candidate_.reset();
  ++losses_;
}

void Synchroniser::reset() {
  skipped_ += unclaimed_;
  unclaimed_ = 0;
  if (locked_) lose();
  remembered_.reset();
  cuts_ = {};
  ring_ = {};
}

}  // namespace prismesh::drivers::eye_tracker::dynasight
