// A whole station for tests: an X server of its own, the model server and the kiosk, and simulated pointer and keyboard input.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/station/process.h"
#include "tests/station/sheet_deck.h"

namespace prismesh::test {

/// Programs that a station needs and that are missing on this machine; empty: none.
std::string missing_programs();

/// A PIN's hash: `openssl passwd -6 -salt saltsalt 4711`
inline constexpr const char* kHashOf4711 =
    "$6$saltsalt$FMJn4/2F8fwlOAepBqo55eJQliVblvlAkyYrm7ZgY2hOG.THZlaAgT9HsBp.0WJ9xljSPF4I6D1oS.F1QFWKI.";

/// An X server without a screen, with a window manager that gives windows the keyboard.
class VirtualDisplay {
 public:
  VirtualDisplay(const std::filesystem::path& home, int width, int height);
  const std::string& name() const { return name_; }
  Process& server() { return *server_; }

 private:
  std::string name_;
  std::unique_ptr<Process> server_;
  std::unique_ptr<Process> window_manager_;
};

class Station {
 public:
  /// Starts display and model server in a new folder that goes with the station; deck() is written.
  Station();
  ~Station();

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path deck() const { return folder_ / "sheet.k"; }

  void start_model_server();
  /// Kills it, as a crash would.
  void kill_model_server();
  Process& model_server() { return *model_server_; }
  /// With these settings (text of a prismesh.toml).
  void start_device_daemon(const std::string& settings);
  void kill_device_daemon();
  Process& device_daemon() { return *device_daemon_; }
  /// Of the kiosk's next window. Small ones are drawn fast without a graphics card.
  void set_picture_size(int width, int height) { width_ = width, height_ = height; }
  /// Opens the deck in a kiosk and waits until its picture is on the screen.
  void start_kiosk(const std::vector<std::string>& more_arguments = {});
  /// A kiosk that asks for no deck, on a server that has none open.
  void start_empty_kiosk();
  /// Ends the kiosk and starts one that asks for another deck; it needn't get it.
  void open_in_another_kiosk(const std::filesystem::path& deck);
  /// A kiosk that calibrates its display, in a window, with the daemon's settings file; waits for its first page.
  void start_calibration(const std::vector<std::string>& more_arguments = {});
  /// A kiosk with these settings, of an exhibition; waits until its deck is shown.
  void start_exhibition(const std::filesystem::path& settings);
  /// Listens for the kiosk's set-up as systemd does on a station, and writes beneath `root`.
  void start_setup_service(const std::filesystem::path& root);
  /// A kiosk that leads through the set-up; waits for its first page.
  void start_setup(const std::vector<std::string>& more_arguments = {});
  Process& kiosk() { return *kiosk_; }
  VirtualDisplay& display() { return *display_; }

  // --- simulated input; in pixels of the kiosk's picture ---
  void move(double x, double y);
  void press(int button = 1);
  void release(int button = 1);
  void click(double x, double y, int button = 1);
  void double_click(double x, double y);
  void drag(double from_x, double from_y, double to_x, double to_y, int button = 1);
  /// The same with the left button as a rectangle that selects.
  void drag_rectangle(double from_x, double from_y, double to_x, double to_y);
  void key(const std::string& keys);
  void destroy_window();  ///< as a client that doesn't ask
  void resize_window(int width, int height);
  void type(const std::string& text);
  void input(const std::vector<std::string>& xdotool_arguments) { xdotool(xdotool_arguments); }

  // --- the kiosk's output ---
  /// A thing on the screen, as a line beginning with "item " says it: where, and its state. Empty: it isn't there.
  struct Item {
    double x = 0, y = 0, width = 0, height = 0;
    std::string state;
    std::array<double, 2> middle() const { return {x + width / 2, y + height / 2}; }
  };
  std::optional<Item> item(const std::string& name);
  /// Clicks in its middle; fails if it isn't there.
  void click_item(const std::string& name);

  /// How a deck point comes to a pixel, as a line beginning with "aim " says it: column-major, deck to clip space.
  struct Aim {
    double width = 0, height = 0;
    std::array<double, 16> m{};
    std::array<double, 2> pixel_of(const Point& point) const;
    /// Change of the distance from the eye along the line of sight by a displacement: zero in the plane of the screen.
    double depth_of(const Point& by) const { return m[3] * by[0] + m[7] * by[1] + m[11] * by[2]; }
  };
  static Aim aim_from(const std::string& line);
  Aim aim();
  /// The same once the kiosk has done all that pointer and buttons were made to do, and its view has come to rest.
  Aim settled_aim();
  /// Where a deck point is on the picture.
  std::array<double, 2> pixel_of(const Point& point) { return aim().pixel_of(point); }
  /// Waits until `selected` nodes are selected in the newest generation and the handle for them is on the picture.
  bool wait_for_selection(std::size_t selected);
  struct Handle {
    double foot_x = 0, foot_y = 0, tip_x = 0, tip_y = 0;
  };
  std::optional<Handle> handle();
  /// Saves a copy by keyboard, waits for it, and gives back what was written.
  std::string save_copy(const std::string& name);
  /// Selects the nodes of the sheet's middle with a rectangle; their ids.
  std::vector<std::int64_t> select_middle();
  /// Takes the arrow at its tip and moves the pointer along it; the button stays down and a preview is seen.
  void pull_arrow(double pixels);
  void screenshot(const std::filesystem::path& file);
  /// A picture NAME.png of the screen for people, in the folder that $PRISMESH_STATION_PICTURES names; none where it names none.
  void show_people(const std::string& name);
  /// What the kiosk's window shows: rows of red, green and blue bytes from the upper left.
  struct Pixels {
    int width = 0, height = 0;
    std::string rgb;
  };
  Pixels window_pixels();

 private:
  void xdotool(const std::vector<std::string>& arguments);
  void run_kiosk(const std::vector<std::string>& arguments);
  void find_window();

  std::filesystem::path folder_;
  std::unique_ptr<VirtualDisplay> display_;
  std::unique_ptr<Process> model_server_;
  std::unique_ptr<Process> device_daemon_;
  std::unique_ptr<Process> setup_service_;
  std::unique_ptr<Process> kiosk_;
  int width_ = 1280, height_ = 800;
  bool rectangles_ = false;         ///< what the kiosk draws; a new one draws lassos
  int presses_ = 0, releases_ = 0;  ///< of buttons, since the kiosk was started
  std::string pointer_;             ///< where it was moved to last, as the kiosk says it
  std::string window_;
};

}  // namespace prismesh::test
