#include "kiosk/tools/view/shared_view.h"

#include <utility>

namespace prismesh::kiosk::tools::view {
namespace {

/// What is told to other kiosks doesn't depend on the number of views here.
double size_of(const toolkit::PictureView& view) { return view.two_views ? toolkit::kTwoViewsSize : 1; }

}  // namespace

void SharedView::share() {
  if (!context_.options.follows_others || !context_.shown.snapshot) return;
  const stereo::View& view = context_.view.view;
  ipc::Camera camera;
  camera.pivot = {view.pivot.x(), view.pivot.y(), view.pivot.z()};
  camera.rotation = {view.rotation.w(), view.rotation.x(), view.rotation.y(), view.rotation.z()};
  const double size = size_of(context_.view);
  camera.mm_per_unit = view.mm_per_unit / size;
  camera.stands_mm = {view.pan_mm.x() / size, view.pan_mm.y() / size, view.before_mm};
  if (shared_ == camera) return;
  // The first view of a kiosk that has just started doesn't move the others.
  if (std::exchange(shared_, camera)) context_.link.cameras.share(camera);
}

bool SharedView::take() {
  const std::optional<ipc::Camera> heard = context_.link.cameras.take();
  if (!heard || !context_.options.follows_others || heard->rotation.size() != 4 || !(heard->mm_per_unit > 0)) return false;
  const Eigen::Quaterniond rotation(heard->rotation[0], heard->rotation[1], heard->rotation[2], heard->rotation[3]);
  if (!(rotation.norm() > 0.5 && rotation.norm() < 2)) return false;
  stereo::View& view = context_.view.view;
  view.pivot = {heard->pivot[0], heard->pivot[1], heard->pivot[2]};
  view.rotation = rotation.normalized();
  const double size = size_of(context_.view);
  view.mm_per_unit = size * heard->mm_per_unit;
  view.pan_mm = size * Eigen::Vector2d(heard->stands_mm[0], heard->stands_mm[1]);
  view.before_mm = heard->stands_mm[2];
  shared_ = heard;
  shared_->rotation = {view.rotation.w(), view.rotation.x(), view.rotation.y(), view.rotation.z()};
  return true;
}

}  // namespace prismesh::kiosk::tools::view
