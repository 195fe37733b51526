// The frames of a drag in shared memory: positions of the nodes that move, and states of the shells they touch. One writer (modeld) and
// any number of readers; none waits for another (ipc/wire/seqlock.h).
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
  std::size_t frame_words() const;                 ///< 8-byte words of a frame
  std::size_t frame_at(std::uint64_t turn) const;  ///< bytes from the start
  std::size_t total() const;
};

class PreviewWriter {
 public:
  static Result<PreviewWriter> create(std::uint64_t drag, std::uint64_t base_generation, std::span<const mesh::NodeIndex> nodes,
                                      std::span<const mesh::ShellIndex> shells);
  void publish(std::uint64_t sequence, std::span<const mesh::Vec3> positions, std::span<const mesh::quality::ShellState> states,
               const mesh::quality::Counts& counts);
  const Descriptor& descriptor() const { return descriptor_; }

 private:
  Descriptor descriptor_;
  Mapping mapping_;
  PreviewLayout layout_;
  std::vector<std::uint64_t> frame_;  ///< the next frame, in the layout of the memory
};

/// A reader's copy of a whole frame.
struct PreviewFrame {
  std::uint64_t sequence = 0;
  std::vector<mesh::Vec3> positions;              ///< of PreviewReader::nodes()
  std::vector<mesh::quality::ShellState> states;  ///< of PreviewReader::shells()
  mesh::quality::Counts counts;
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
