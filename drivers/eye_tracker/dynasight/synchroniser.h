// Finds the records in a stream of bytes that can be joined anywhere, and notices when the thread is lost.
//
// Two bytes 0x8x in a row begin a record, but a low byte of z in that range makes three of them, and a reader that takes the first pair is
// one byte early for as long as the head keeps still. So nothing is believed from one record: each of the eight ways to cut the stream is
// followed at once, and one is taken when several records in a row agree in markers, range, target and continuity. Where another cut has
// had its markers right all along as well, more agreement is asked for, so that the two may part; after a byte got lost, less.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/eye_tracker/dynasight/record.h"

namespace prismesh::drivers::eye_tracker::dynasight {

// Records in a row that agree before a way to cut the stream is taken:
inline constexpr int kAgreeingRecords = 4;
inline constexpr int kAgreeingRecordsRivalled = 16;  ///< when another way has its markers right too
inline constexpr int kAgreeingRecordsToRegain = 2;   ///< when they go on from where the head was just before a byte got lost
inline constexpr int kBadRecordsToLoss = 3;          ///< in a row, before synchronisation counts as lost
inline constexpr std::size_t kRegainBytes = 480;     ///< what is remembered of the head after a loss, counted in bytes since: a second's
inline constexpr double kMaxStepMm = 40;             ///< between two records, along each axis: 2.4 m/s at 60 Hz

/// What a byte completed.
struct Heard {
  Record record;
  /// The record speaks of a head, at a place a viewer can be (range, and it continues the one before). A jump is believed from its second
  /// record on, so that no single damaged record becomes a sample.
  bool believed = false;
};

class Synchroniser {
 public:
  /// Takes the next byte; gives the record it completes, once synchronised.
  std::optional<Heard> take(std::byte byte);
  bool synchronised() const { return locked_.has_value(); }
  /// Forgets what came before: the stream begins anew. Counts stay.
  void reset();

  std::uint64_t bytes_skipped() const { return skipped_; }
  std::uint64_t losses() const { return losses_; }

 private:
  /// One of the eight ways to cut the stream.
  struct Cut {
    int markers = 0;   ///< records in a row with both markers
    int agreeing = 0;  ///< of these, the last so many agree in everything
    Record last;
  };

  RecordBytes window() const;
  void follow(Cut& cut, const std::optional<Record>& record);
  bool convincing(std::size_t at) const;
  std::optional<Heard> take_record(const std::optional<Record>& record);
  bool believe(const Record& record);
  void lock(std::size_t at, const Record& record);
  void lose();

  std::array<std::byte, kRecordBytes> ring_{};  ///< the newest bytes; ring_[at_] is the oldest once filled
  std::size_t at_ = 0;
  std::array<Cut, kRecordBytes> cuts_{};
  std::optional<std::size_t> locked_;
  int bad_ = 0;
  std::size_t unclaimed_ = 0;         ///< bytes that neither a record nor `skipped_` accounts for yet
  std::optional<Record> trusted_;     ///< the last believed one
  std::optional<Record> candidate_;   ///< a jump that the next record may confirm
  std::optional<Record> remembered_;  ///< the last believed one before a loss
  std::size_t since_loss_ = 0;        ///< bytes
  std::uint64_t skipped_ = 0;
  std::uint64_t losses_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::dynasight
