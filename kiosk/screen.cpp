#include "kiosk/screen.h"

#include <utility>

namespace prismesh::kiosk {

Screen::Screen(panels::Gui gui, std::vector<input::MouseBinding> mouse, KeptArrangement arrangement, Editor& editor)
    : gui_(std::move(gui)),
      mouse_(std::move(mouse)),
      panels_(std::move(arrangement)),
      editor_(editor),
      laid_out_ns_(editor.context().clock.now_ns()) {}

void Screen::set_size(display::PixelSize size) {
  size_ = size;
  editor_.set_picture_size(size);
}

Result<void> Screen::lay_out() {
  panels::TypeSizes sizes = panels::type_for(size_, editor_.profile().stereo());
  if (editor_.context().options.exhibition) sizes = panels::for_fingers(sizes, editor_.profile().optics.pixel_pitch_mm);
  if (Result<void> type = gui_.set_type(sizes); !type) return type;
  const std::int64_t now = editor_.context().clock.now_ns();
  panels::PanelLayout layout{size_, [this](const input::Command& command) { editor_.panel_command(command); }};
  layout.run_command_at = [this](const input::Command& command, double x, double y) { editor_.panel_command(command, input::Pixel(x, y)); };
  gui_.layout(size_, static_cast<double>(now - std::exchange(laid_out_ns_, now)) * 1e-9, [&] {
    panels_.build(editor_.context(), mouse_, layout);
    if (pointer_) panels::draw_pointer(pointer_->x(), pointer_->y());
  });
  const panels::Place room = layout.view();
  editor_.set_room({room.x, room.y, room.right(), room.bottom()});
  for (const std::function<void()>& action : layout.actions) editor_.panel_action(action);
  items_.tell(editor_.context().trace, std::move(layout.items));
  return {};
}

Result<void> Screen::draw(unsigned framebuffer, const std::optional<input::Pixel>& pointer, Pace pace) {
  pointer_ = pointer;
  // Panels that fit their content have their size after the second time.
  for (int round = 0; round < 2; ++round)
    if (Result<void> laid_out = lay_out(); !laid_out) return laid_out;
  render::Picture picture = editor_.picture();
  picture.moving = pace == Pace::moving;
  picture.waiting = pace == Pace::waiting;
  picture.overlay = [&](const render::EyeImage& image) { gui_.draw({image.width, image.height}, image.from_picture); };
  const Result<render::DrawReport> report = editor_.context().renderer.draw(picture, framebuffer, size_.width, size_.height);
  if (!report) return fail(report.error());
  editor_.set_report(*report);
  return {};
}

Result<bool> Screen::draw_piece(std::int64_t budget_ns) {
  toolkit::ToolContext& context = editor_.context();
  return context.renderer.draw_piece(editor_.picture(), size_.width, size_.height, context.clock, budget_ns);
}

}  // namespace prismesh::kiosk
