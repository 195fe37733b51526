// The frames of a drag in shared memory: positions of the nodes that move, states of the shells they touch, and which of these come to
// touch others. One writer (modeld) and any number of readers; none waits for another (ipc/wire/seqlock.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/error.h"
#include "ipc/wire/descriptor.h"
#include "mesh/model/model.h"
#include "mesh/quality/report.h"

namespace prismesh::ipc {

/// The layout of a preview's memory, which writer and reader compute from the two counts.
struct PreviewLayout {
  std::size_t nodes = 0;
  std::size_t shells = 0;

  std::size_t nodes_at() const;                    ///< bytes from the start
  std::size_t shells_at() const;                   ///< bytes from the start
  std::size_t states_word() const;                 ///< of a frame
  std::size_t touches_word() const;                ///< of a frame
  std::size_t frame_words() const;                 ///< 8-byte words of a frame
  std::size_t frame_at(std::uint64_t turn) const;  ///< bytes from the start
  std::size_t total() const;
};

/// The moved shells that cross others or are too close to them, and didn't before the drag (mesh/contact/moved_shells.h).
struct PreviewTouches {
  std::vector<std::uint64_t> moved;      ///< bit i of word i / 64: PreviewReader::shells()[i]; may be shorter: the rest is 0
  std::vector<mesh::ShellIndex> others;  ///< max kMaxTouchedOthers, ascending; in a reader indices that aren't checked
  std::uint64_t parts = 0;               ///< that take part; 0: nothing touches
  mesh::PartIndex part_a, part_b;        ///< of the worst pair
  bool cross = false;                    ///< that pair crosses
  double depth = 0;                      ///< of that pair, if it doesn't cross; deck's length unit
  bool watched = true;                   ///< false: too many shells move, nothing was looked for

  bool touches(std::size_t shell) const { return shell / 64 < moved.size() && (moved[shell / 64] >> (shell % 64) & 1) != 0; }
};
inline constexpr std::size_t kMaxTouchedOthers = 256;

class PreviewWriter {
 public:
  static Result<PreviewWriter> create(std::uint64_t drag, std::uint64_t base_generation, std::span<const mesh::NodeIndex> nodes,
                                      std::span<const mesh::ShellIndex> shells);
  void publish(std::uint64_t sequence, std::span<const mesh::Vec3> positions, std::span<const mesh::quality::ShellState> states,
               const mesh::quality::Counts& counts, const PreviewTouches& touches = {});
  const Descriptor& descriptor() const { return descriptor_; }

 private:
  Descriptor descriptor_;
  Mapping mapping_;
  PreviewLayout layout_;
  void write_touches(const PreviewTouches& touches);
  std::vector<std::uint64_t> frame_;  ///< the next frame, in the layout of the memory
};

/// A reader's copy of a whole frame.
struct PreviewFrame {
  std::uint64_t sequence = 0;
  std::vector<mesh::Vec3> positions;              ///< of PreviewReader::nodes()
  std::vector<mesh::quality::ShellState> states;  ///< of PreviewReader::shells()
  mesh::quality::Counts counts;
  PreviewTouches touches;
};

class PreviewReader {
 public:
  static Result<PreviewReader> map(const Descriptor& descriptor);
  std::uint64_t drag() const;
  std::uint64_t base_generation() const;
  /// The indices aren't checked: compare one with the model's counts before using it.
  std::span<const mesh::NodeIndex> nodes() const;
  std::span<const mesh::ShellIndex> shells() const;
  /// Copies the newest frame if it is newer than frame.sequence; false if there is none, or if the writer overwrote it meanwhile (try
  /// again for the next picture).
  bool latest(PreviewFrame& frame) const;

 private:
  Mapping mapping_;
  PreviewLayout layout_;
  std::uint64_t drag_ = 0;
  std::uint64_t base_generation_ = 0;
};

}  // namespace prismesh::ipc
