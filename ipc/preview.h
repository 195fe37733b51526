// What a drag changes, frame by frame, in shared memory: positions of the nodes that move, states of the shells they touch.
// One writer (modeld), any number of readers; neither waits for the other (ipc/seqlock.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/error.h"
#include "ipc/descriptor.h"
#include "mesh/model/model.h"
#include "mesh/quality/report.h"

namespace prismesh::ipc {

/// Where things lie in a preview's memory; worked out from the two counts by writer and reader alike.
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
  std::vector<std::uint64_t> frame_;  ///< the next frame, laid out as it lies in memory
};

/// A frame as a reader copied it out whole.
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
  /// The indices are the writer's word: whoever follows one compares it with the model's counts.
  std::span<const mesh::NodeIndex> nodes() const;
  std::span<const mesh::ShellIndex> shells() const;
  /// Copies the newest frame if it is newer than frame.sequence; false if there is none or the writer was faster (try at the
  /// next picture).
  bool latest(PreviewFrame& frame) const;

 private:
  Mapping mapping_;
  PreviewLayout layout_;
  std::uint64_t drag_ = 0;
  std::uint64_t base_generation_ = 0;
};

}  // namespace prismesh::ipc
