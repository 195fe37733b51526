#include "kiosk/render/model_source.h"

#include <utility>

#include "base/hash.h"

namespace prismesh::kiosk::render {

namespace {

class SnapshotSource final : public ModelSource {
 public:
  SnapshotSource(std::shared_ptr<const ipc::SnapshotView> view, std::vector<std::uint8_t> hidden)
      : view_(std::move(view)), hidden_(std::move(hidden)), document_(hash64(std::as_bytes(std::span(view_->info().document)))) {}

  std::size_t size(ipc::SnapshotArray array) const override { return view_->size(array); }
  std::uint64_t chunk_version(ipc::SnapshotArray array, std::size_t chunk) const override { return view_->chunk_version(array, chunk); }
  std::span<const std::byte> chunk_bytes(ipc::SnapshotArray array, std::size_t chunk) const override {
    return view_->chunk_bytes(array, chunk);
  }
  std::size_t part_count() const override { return view_->info().parts.size(); }
  bool part_hidden(std::size_t part) const override {
    return part < hidden_.size() ? hidden_[part] != 0 : view_->info().parts[part].hidden;
  }
  std::array<float, 2> part_thickness(std::size_t part) const override {
    const ipc::SnapshotPart& its = view_->info().parts[part];
    return {its.thinnest, its.thickest};
  }
  std::uint64_t document_key() const override { return document_; }

 private:
  std::shared_ptr<const ipc::SnapshotView> view_;
  std::vector<std::uint8_t> hidden_;
  std::uint64_t document_;
};

}  // namespace

std::shared_ptr<const ModelSource> snapshot_source(std::shared_ptr<const ipc::SnapshotView> view, std::vector<std::uint8_t> hidden) {
  return std::make_shared<SnapshotSource>(std::move(view), std::move(hidden));
}

}  // namespace prismesh::kiosk::render
