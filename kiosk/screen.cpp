#include "kiosk/screen.h"

#include <utility>

namespace prismesh::kiosk {

Screen::Screen(panels::Gui gui, std::vector<input::MouseBinding> mouse, Editor& editor)
    : gui_(std::move(gui)), mouse_(std::move(mouse)), editor_(editor), laid_out_ns_(editor.context().clock.now_ns()) {}

void Screen::set_size(display::PixelSize size) {
  size_ = size;
  editor_.set_picture_size(size);
}

Result<void> Screen::lay_out() {
  if (Result<void> type = gui_.set_type(editor_.profile().stereo() ? panels::kStereoType : panels::kFlatType); !type) return type;
  const std::int64_t now = editor_.context().clock.now_ns();
  panels::PanelLayout layout{size_, [this](const input::Command& command) { editor_.panel_command(command); }};
  gui_.layout(size_, static_cast<double>(now - std::exchange(laid_out_ns_, now)) * 1e-9, [&] {
    panels_.build(editor_.context(), mouse_, layout);
    if (pointer_) panels::draw_pointer(pointer_->x(), pointer_->y());
  });
  editor_.set_covered_width(panels_.covered_width());
  for (const std::function<void()>& action : layout.actions) editor_.panel_action(action);
  return {};
}

Result<void> Screen::draw(unsigned framebuffer, const std::optional<input::Pixel>& pointer, bool moving) {
  pointer_ = pointer;
  // Panels that fit their content have their size after the second time.
  for (int round = 0; round < 2; ++round)
    if (Result<void> laid_out = lay_out(); !laid_out) return laid_out;
  render::Picture picture = editor_.picture();
  picture.moving = moving;
  picture.overlay = [&](const render::EyeImage& image) { gui_.draw({image.width, image.height}, image.from_picture); };
  const Result<render::DrawReport> report = editor_.context().renderer.draw(picture, framebuffer, size_.width, size_.height);
  if (!report) return fail(report.error());
  editor_.set_report(*report);
  return {};
}

}  // namespace prismesh::kiosk
