// Synchronises to the records in a byte stream that may be joined at any byte, and detects the loss of synchronisation.
//
// A record begins with two marker bytes 0x8x. If the low byte of z is in that range too, three such bytes follow each other, and a reader
// that takes the first pair stays one byte early while the head doesn't move. One record is therefore never enough: all eight alignments of
// the stream are tracked at once, and one is selected when several consecutive records agree in markers, range, target and continuity. If
// another alignment has had correct markers as well, more agreeing records are required, so that the two can differ; after a lost byte,
// fewer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/eye_tracker/dynasight/record.h"

namespace prismesh::drivers::eye_tracker::dynasight {

// Numbers of consecutive agreeing records that select an alignment:
inline constexpr int kAgreeingRecords = 4;
inline constexpr int kAgreeingRecordsAmbiguous = 16;  ///< if another alignment has correct markers too
inline constexpr int kAgreeingRecordsToResync = 2;    ///< after a lost byte, if the records continue from the last head position
inline constexpr int kMaxBadRecords = 3;              ///< consecutive bad records before synchronisation counts as lost
inline constexpr std::size_t kMaxResyncBytes = 480;   ///< after a loss, the last head position stays valid for so many bytes (one second)
inline constexpr double kMaxStepMm = 40;              ///< between two records, along each axis: 2.4 m/s at 60 Hz

/// A completed record.
struct SynchronisedRecord {
  Record record;
  /// The record has a head at a position where a viewer can be (in range, and continuing from the previous record). After a jump, only the
  /// second record is plausible, so that a single damaged record never becomes a sample.
  bool plausible = false;
};

class Synchroniser {
 public:
  /// Takes the next byte. Returns the record that it completes, if synchronised.
  std::optional<SynchronisedRecord> take(std::byte byte);
  bool synchronised() const { return locked_.has_value(); }
  /// Restarts with an empty stream. Keeps the counts.
  void reset();

  std::uint64_t bytes_skipped() const { return skipped_; }
  std::uint64_t losses() const { return losses_; }

 private:
  /// One of the eight alignments of records in the stream.
  struct Alignment {
    int markers = 0;   ///< consecutive records with both markers
    int agreeing = 0;  ///< the newest of these that agree in everything
    Record last;
  };

  RecordBytes window() const;
  void update(Alignment& alignment, const std::optional<Record>& record);
  bool confirmed(std::size_t at) const;
  std::optional<SynchronisedRecord> take_record(const std::optional<Record>& record);
  bool check_plausible(const Record& record);
  void lock(std::size_t at, const Record& record);
  void lose_lock();

  std::array<std::byte, kRecordBytes> ring_{};  ///< the newest bytes; once filled, ring_[at_] is the oldest
  std::size_t at_ = 0;
  std::array<Alignment, kRecordBytes> alignments_{};
  std::optional<std::size_t> locked_;
  int bad_ = 0;
  std::size_t pending_ = 0;               ///< bytes not yet counted as part of a record or in `skipped_`
  std::optional<Record> last_plausible_;  ///< the last plausible record
  std::optional<Record> candidate_;       ///< a jump that the next record may confirm
  std::optional<Record> remembered_;      ///< the last plausible record before a loss
  std::size_t since_loss_ = 0;            ///< bytes
  std::uint64_t skipped_ = 0;
  std::uint64_t losses_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::dynasight
