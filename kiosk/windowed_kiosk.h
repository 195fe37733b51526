// Runs a kiosk in a window: waits for input, daemons and eyes, and draws when something has changed, at most once per refresh of the
// display.
#pragma once

#include "kiosk/display/window.h"
#include "kiosk/input/gestures.h"
#include "kiosk/picture_watch.h"
#include "kiosk/station.h"

namespace prismesh::kiosk {

class WindowedKiosk {
 public:
  WindowedKiosk(display::Window& window, Station& station);

  /// Runs until the window is closed. Errors: the display is gone; a model too large for the GPU.
  Result<void> run();

 private:
  Result<void> take(const display::WindowEvent& event);
  bool is_fresh(const display::WindowEvent& event);
  Result<void> take_button(const display::ButtonChanged& event);
  Result<void> take_key(const display::KeyChanged& event);
  Result<void> take_text(const display::TextTyped& event);
  Result<void> give_field_the_keyboard();
  void do_command(const input::Command& command);
  void do_command(const input::Command& command, const std::optional<input::Pixel>& pointer);
  Result<bool> take_letter(const display::KeyChanged& event, const input::KeyBinding& binding);
  Result<void> fire_held();
  Result<void> settle();
  void point();
  bool shows_large() const;
  void offer_copied();
  void find_place() { station_.place(window_.monitor(), window_.position()); }
  /// The display's own pointer isn't woven, and some displays have none.
  bool draws_pointer() const { return station_.editor.profile().stereo() || !window_.has_pointer(); }
  /// The view or something in it is about to change again.
  bool moving() const { return gestures_.dragging() || station_.clock.now_ns() < wheel_rest_ns_; }
  /// The view moves to another by itself.
  bool gliding() const {
    return station_.editor.context().view.depth.moving() || station_.editor.context().view.glide.moving() ||
           station_.editor.context().view.steered;
  }
  /// The picture on the display is out of date.
  bool stale() const { return dirty_ || station_.editor.changes() != shown_changes_ || (shown_moving_ && !moving()) || gliding(); }
  Result<bool> beat();
  Result<bool> draw();
  Result<void> show(Screen::Pace pace);
  void trace_picture();
  void trace_rest();
  void looks();
  void wait();
  std::int64_t patience_ns() const;
  std::optional<input::Pixel> pointer_on_picture() const;
  void gestures(const std::vector<input::Gesture>& made) {
    for (const input::Gesture& gesture : made) station_.editor.gesture(gesture);
  }

  display::Window& window_;
  Station& station_;
  input::Gestures gestures_;
  std::optional<input::Pixel> moved_from_;  ///< where the pointer was when a move of it counted last
  bool swallow_text_ = false;               ///< the text of the key that opened a field is dropped
  /// A plain letter that edits: it waits whether another one makes a word of it, which is typed beside a field.
  struct HeldLetter {
    const input::KeyBinding* binding = nullptr;
    std::optional<input::Pixel> pointer;
    std::int64_t fires_ns = 0;
  };
  std::optional<HeldLetter> held_;
  std::string word_;  ///< the plain letters that came one soon after the other
  std::int64_t last_letter_ns_ = 0;
  bool edge_fed_ = false;  ///< the panels haven't handled a press or release yet
  bool dirty_ = true;
  bool fullscreen_ = false;
  bool shown_moving_ = false;  ///< the last picture was drawn for speed, or waits for one at rest
  bool put_off_ = false;       ///< a picture, as the last turn was long
  bool piece_drawn_ = false;   ///< in the last turn, of a picture at rest
  std::int64_t wheel_rest_ns_ = 0;
  std::optional<std::int64_t> rests_ns_;  ///< when the pointer will have rested; nothing: it has been looked at
  std::int64_t looked_ns_ = 0;            ///< when the input was last looked at, or waited for; 0: not yet
  std::int64_t longest_ns_ = 0;           ///< between two looks, since it was last told
  std::uint64_t shown_changes_ = 0;
  std::uint64_t pictures_ = 0;
  std::size_t traced_scenes_ = 0;             ///< pictures for which the model was drawn
  std::uint64_t presses_ = 0, releases_ = 0;  ///< of buttons; a step of the wheel is a press
  bool rest_traced_ = false;                  ///< no event and no picture since
  PictureWatch watch_{reports_to_supervisor()};
};

}  // namespace prismesh::kiosk
