#include "ipc/model/preview.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "ipc/wire/seqlock.h"

namespace prismesh::ipc {

namespace {

constexpr std::uint64_t kPreviewMagic = 0x3257'4956'4552'5250;  // "PRREVIW2"
constexpr std::size_t kMaxItems = std::size_t{1} << 31;

struct Header {
  std::uint64_t magic = kPreviewMagic;
  std::uint64_t drag = 0;
  std::uint64_t base_generation = 0;
  std::uint64_t nodes = 0;
  std::uint64_t shells = 0;
  TurnCount turns;
};
// A frame: its head, the positions, the states, the bits of the shells that touch.
constexpr std::size_t kFrameHeadWords = 10 + kMaxTouchedOthers / 2;
enum HeadWord : std::size_t {
  kSequence,
  kOk,
  kWarn,
  kFail,
  kTouchFlags,
  kTouchParts,
  kTouchPair,
  kTouchDepth,
  kOtherCount,
  kSpare,
  kOthers
};
constexpr std::uint64_t kCross = 1, kUnwatched = 2;
static_assert(kOthers == 10 && kMaxTouchedOthers % 2 == 0);
static_assert(sizeof(mesh::Vec3) == 24 && sizeof(mesh::quality::ShellState) == 4);

std::size_t to_line(std::size_t bytes) { return (bytes + 63) / 64 * 64; }

}  // namespace

std::size_t PreviewLayout::nodes_at() const { return to_line(sizeof(Header)); }
std::size_t PreviewLayout::shells_at() const { return to_line(nodes_at() + nodes * sizeof(mesh::NodeIndex)); }
std::size_t PreviewLayout::states_word() const { return kFrameHeadWords + nodes * 3; }
std::size_t PreviewLayout::touches_word() const { return states_word() + (shells + 1) / 2; }
std::size_t PreviewLayout::frame_words() const { return touches_word() + (shells + 63) / 64; }
std::size_t PreviewLayout::frame_at(std::uint64_t turn) const {
  const std::size_t first = to_line(shells_at() + shells * sizeof(mesh::ShellIndex));
  return first + (turn % 2) * to_line(frame_words() * 8);
}
std::size_t PreviewLayout::total() const { return frame_at(1) + to_line(frame_words() * 8); }

Result<PreviewWriter> PreviewWriter::create(std::uint64_t drag, std::uint64_t base_generation, std::span<const mesh::NodeIndex> nodes,
                                            std::span<const mesh::ShellIndex> shells) {
  PreviewWriter writer;
  writer.layout_ = {nodes.size(), shells.size()};
  Result<Descriptor> memory = make_shared_memory("prismesh-preview", writer.layout_.total());
  if (!memory) return fail(std::move(memory.error()));
  if (Result<void> backed = reserve(*memory, 0, writer.layout_.total()); !backed) return fail(std::move(backed.error()));
  Result<Mapping> mapping = Mapping::map(*memory, true);
  if (!mapping) return fail(std::move(mapping.error()));
  if (Result<void> sealed = seal_for_readers(*memory); !sealed) return fail(std::move(sealed.error()));
  writer.descriptor_ = std::move(*memory);
  writer.mapping_ = std::move(*mapping);
  std::byte* data = writer.mapping_.writable_bytes().data();
  new (data) Header{kPreviewMagic, drag, base_generation, nodes.size(), shells.size(), {}};
  if (!nodes.empty()) std::memcpy(data + writer.layout_.nodes_at(), nodes.data(), nodes.size_bytes());
  if (!shells.empty()) std::memcpy(data + writer.layout_.shells_at(), shells.data(), shells.size_bytes());
  writer.frame_.resize(writer.layout_.frame_words());
  return writer;
}

void PreviewWriter::publish(std::uint64_t sequence, std::span<const mesh::Vec3> positions,
                            std::span<const mesh::quality::ShellState> states, const mesh::quality::Counts& counts,
                            const PreviewTouches& touches) {
  frame_[kSequence] = sequence;
  frame_[kOk] = counts.ok;
  frame_[kWarn] = counts.warn;
  frame_[kFail] = counts.fail;
  write_touches(touches);
  // A drag gives one position a node and one state a shell; a shorter list would leave the rest of the frame as it was.
  const std::size_t moved = std::min(positions.size(), layout_.nodes);
  const std::size_t judged = std::min(states.size(), layout_.shells);
  if (moved > 0) std::memcpy(&frame_[kFrameHeadWords], static_cast<const void*>(positions.data()), moved * sizeof(mesh::Vec3));
  if (judged > 0) std::memcpy(&frame_[layout_.states_word()], states.data(), judged * sizeof(mesh::quality::ShellState));
  std::byte* data = mapping_.writable_bytes().data();
  TurnCount& turns = std::launder(reinterpret_cast<Header*>(data))->turns;
  const std::uint64_t next = turns.load() + 1;
  store_words(reinterpret_cast<std::uint64_t*>(data + layout_.frame_at(next)), frame_.data(), frame_.size());
  turns.store(next);
}

void PreviewWriter::write_touches(const PreviewTouches& touches) {
  frame_[kTouchFlags] = (touches.cross ? kCross : 0) | (touches.watched ? 0 : kUnwatched);
  frame_[kTouchParts] = touches.parts;
  frame_[kTouchPair] = touches.part_a.value | std::uint64_t{touches.part_b.value} << 32;
  std::memcpy(&frame_[kTouchDepth], &touches.depth, sizeof touches.depth);
  const std::size_t others = std::min(touches.others.size(), kMaxTouchedOthers);
  frame_[kOtherCount] = others;
  if (others > 0) std::memcpy(&frame_[kOthers], touches.others.data(), others * sizeof(mesh::ShellIndex));
  const auto bits = frame_.begin() + static_cast<std::ptrdiff_t>(layout_.touches_word());
  std::fill(bits, frame_.end(), 0);
  std::copy_n(touches.moved.begin(), std::min(touches.moved.size(), layout_.frame_words() - layout_.touches_word()), bits);
}

Result<PreviewReader> PreviewReader::map(const Descriptor& descriptor) {
  Result<Mapping> mapping = Mapping::map(descriptor, false);
  if (!mapping) return fail(std::move(mapping.error()));
  PreviewReader reader;
  reader.mapping_ = std::move(*mapping);
  const std::span<const std::byte> bytes = reader.mapping_.bytes();
  if (bytes.size() < sizeof(Header)) return fail("preview", "it is too short");
  Header header;
  std::memcpy(static_cast<void*>(&header), bytes.data(), sizeof header);
  if (header.magic != kPreviewMagic) return fail("preview", "it doesn't begin as one");
  if (header.nodes > kMaxItems || header.shells > kMaxItems) return fail("preview", "its counts are absurd");
  reader.layout_ = {static_cast<std::size_t>(header.nodes), static_cast<std::size_t>(header.shells)};
  if (reader.layout_.total() > bytes.size()) return fail("preview", "it is too short for what it holds");
  reader.drag_ = header.drag;
  reader.base_generation_ = header.base_generation;
  return reader;
}

std::uint64_t PreviewReader::drag() const { return drag_; }
std::uint64_t PreviewReader::base_generation() const { return base_generation_; }

std::span<const mesh::NodeIndex> PreviewReader::nodes() const {
  return {reinterpret_cast<const mesh::NodeIndex*>(mapping_.bytes().data() + layout_.nodes_at()), layout_.nodes};
}

std::span<const mesh::ShellIndex> PreviewReader::shells() const {
  return {reinterpret_cast<const mesh::ShellIndex*>(mapping_.bytes().data() + layout_.shells_at()), layout_.shells};
}

bool PreviewReader::latest(PreviewFrame& frame) const {
  const std::byte* data = mapping_.bytes().data();
  const TurnCount& turns = reinterpret_cast<const Header*>(data)->turns;
  std::vector<std::uint64_t> words(layout_.frame_words());
  for (int attempt = 0; attempt < 2; ++attempt) {
    const std::uint64_t turn = turns.load();
    if (turn == 0) return false;
    const auto* from = reinterpret_cast<const std::uint64_t*>(data + layout_.frame_at(turn));
    load_words(words.data(), from, 1);
    // Before the first frame `positions` is empty, and the numbers aren't compared.
    if (!frame.positions.empty() && words[kSequence] <= frame.sequence) return false;
    load_words(words.data(), from, words.size());
    if (turns.load() != turn) continue;
    frame.sequence = words[kSequence];
    frame.counts = {words[kOk], words[kWarn], words[kFail]};
    frame.positions.resize(layout_.nodes);
    frame.states.resize(layout_.shells);
    const auto take = [&](auto& values, std::size_t first_word) {
      if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), &words[first_word], values.size() * sizeof(values[0]));
    };
    take(frame.positions, kFrameHeadWords);
    take(frame.states, layout_.states_word());
    PreviewTouches& touches = frame.touches;
    touches.cross = (words[kTouchFlags] & kCross) != 0;
    touches.watched = (words[kTouchFlags] & kUnwatched) == 0;
    touches.parts = words[kTouchParts];
    touches.part_a.value = static_cast<std::uint32_t>(words[kTouchPair]);
    touches.part_b.value = static_cast<std::uint32_t>(words[kTouchPair] >> 32);
    std::memcpy(&touches.depth, &words[kTouchDepth], sizeof touches.depth);
    touches.others.resize(std::min<std::uint64_t>(words[kOtherCount], kMaxTouchedOthers));
    take(touches.others, kOthers);
    touches.moved.resize(layout_.frame_words() - layout_.touches_word());
    take(touches.moved, layout_.touches_word());
    return true;
  }
  return false;
}

}  // namespace prismesh::ipc
