#include "drivers/eye_tracker/dynasight/synchroniser.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

constexpr std::int32_t kMaxStepUnits = static_cast<std::int32_t>(kMaxStepMm / kUnitMm);
// Min. magnitude of a coordinate whose high byte looks like a marker: 1433.6 mm, with any exponent. No viewer is that far aside. This
// distinguishes a stream that is read one byte early, where x begins with the second marker.
constexpr std::int32_t kMarkerUnits = 0x7000;
constexpr std::int32_t kMaxDepthUnits = static_cast<std::int32_t>(5000 / kUnitMm);

bool in_range(const Record& record) {
  for (const std::int16_t number : record.numbers)
    if (is_marker(static_cast<std::byte>(static_cast<std::uint16_t>(number) >> 8))) return false;
  if (!record.sees_head()) return true;
  return std::abs(record.units(0)) < kMarkerUnits && std::abs(record.units(1)) < kMarkerUnits && record.units(2) > 0 &&
         record.units(2) < kMaxDepthUnits;
}

bool continues(const Record& before, const Record& after) {
  if (before.target != after.target) return false;
  if (!before.sees_head() || !after.sees_head()) return true;  // in a search, the coordinates are meaningless
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

void Synchroniser::update(Alignment& alignment, const std::optional<Record>& record) {
  if (!record) {
    alignment = {};
    return;
  }
  alignment.markers = std::min(alignment.markers + 1, kAgreeingRecordsAmbiguous);
  if (!in_range(*record))
    alignment.agreeing = 0;
  else
    alignment.agreeing = continues(alignment.last, *record) ? std::min(alignment.agreeing + 1, kAgreeingRecordsAmbiguous) : 1;
  alignment.last = *record;
}

bool Synchroniser::confirmed(std::size_t at) const {
  const std::optional<Record>& head = locked_ ? last_plausible_ : remembered_;
  if (head && alignments_[at].last.sees_head() && continues(*head, alignments_[at].last))
    return alignments_[at].agreeing >= kAgreeingRecordsToResync;
  int needed = kAgreeingRecords;
  for (std::size_t other = 0; other < kRecordBytes; ++other)
    if (other != at && alignments_[other].markers >= kAgreeingRecords - 1) needed = kAgreeingRecordsAmbiguous;
  return alignments_[at].agreeing >= needed;
}

std::optional<SynchronisedRecord> Synchroniser::take(std::byte byte) {
  ring_[at_] = byte;
  at_ = (at_ + 1) % kRecordBytes;
  ++pending_;
  if (remembered_ && ++since_loss_ > kMaxResyncBytes) remembered_.reset();
  const std::size_t alignment = at_;  // an alignment's index is the ring position where its records end
  const std::optional<Record> record = decode(window());
  update(alignments_[alignment], record);
  if (locked_ == alignment) return take_record(record);

  if (locked_ && alignments_[*locked_].agreeing == 0 && confirmed(alignment)) lose_lock();
  if (locked_) return std::nullopt;
  if (confirmed(alignment)) {
    const bool whole = pending_ >= kRecordBytes;
    skipped_ += whole ? pending_ - kRecordBytes : pending_;
    pending_ = 0;
    lock(alignment, *record);
    if (whole) return SynchronisedRecord{*record, false};
  } else if (pending_ > kRecordBytes) {
    ++skipped_;
    --pending_;
  }
  return std::nullopt;
}

std::optional<SynchronisedRecord> Synchroniser::take_record(const std::optional<Record>& record) {
  if (record) {
    bad_ = 0;
    pending_ = 0;
    return SynchronisedRecord{*record, check_plausible(*record)};
  }
  skipped_ += pending_;
  pending_ = 0;
  if (++bad_ >= kMaxBadRecords) lose_lock();
  return std::nullopt;
}

bool Synchroniser::check_plausible(const Record& record) {
  if (!record.sees_head()) {
    last_plausible_.reset();
    candidate_.reset();
    return false;
  }
  if (!in_range(record)) return false;
  const bool follows = (last_plausible_ && continues(*last_plausible_, record)) || (candidate_ && continues(*candidate_, record));
  if (follows) {
    last_plausible_ = record;
    candidate_.reset();
  } else {
    candidate_ = record;
  }
  return follows;
}

void Synchroniser::lock(std::size_t at, const Record& record) {
  locked_ = at;
  bad_ = 0;
  last_plausible_ = std::exchange(remembered_, std::nullopt);
  candidate_.reset();
  if (record.sees_head()) candidate_ = record;
}

void Synchroniser::lose_lock() {
  locked_.reset();
  bad_ = 0;
  remembered_ = std::exchange(last_plausible_, std::nullopt);
  since_loss_ = 0;
  candidate_.reset();
  ++losses_;
}

void Synchroniser::reset() {
  skipped_ += pending_;
  pending_ = 0;
  if (locked_) lose_lock();
  remembered_.reset();
  alignments_ = {};
  ring_ = {};
}

}  // namespace prismesh::drivers::eye_tracker::dynasight
